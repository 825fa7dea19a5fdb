"""The plane of starts, and how their ends and the boundary between them are looked for."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from compare.claims.paper_parameters import FIG5

PLANE = ((-0.3, 0.5), (-0.4, 0.4))
"""Of x0 in m and vx0 in m/s; the others are zero."""

RECTANGLE = "−0.3 m < x < 0.5 m, |ẋ| < 0.4 m/s, y = ẏ = 0"
"""The same in words."""

FROM_REST = "Fig. 5; starts from rest in y"

SIDE, FINER = 334, 3
"""Starts along each side of the plane, and into how many parts the grid is divided where their ends differ."""

FASTEST = replace(FIG5, disc_speed=3.0)
"""Fig. 5 at twice its speed: there the basin is small."""

WHERE = {FIG5: ((-0.2, 0.4), (-0.35, 0.25)), FASTEST: ((-0.03, 0.07), (-0.16, 0.06))}
"""Where in the plane the boundary of each pin is looked for; that no other part of it lies elsewhere the ends of the
grid say."""

CELLS, ON_BOUNDARY = 8, 1e-5
"""With which resolution and tolerance: splines between the points are 1.2e-3 m off, half a step of the grid."""

ASKED, BARELY = 64, 1e-6
"""How many starts at most are asked by shooting, and by how much in rad they must miss the saddle to be on a side."""

UNTIL = 3000.0
"""In s: long enough for every start to have come to its end."""

SPEEDS = tuple(np.linspace(1.05, FASTEST.disc_speed, 20).tolist())
"""In rad/s."""

STARTS, SEED = 2000, 5
"""Random starts in the plane, the same at every speed."""

RECOMPUTED = 16
"""Starts whose end the plain reference is asked for, half of them next to the boundary."""

SETTLED = 250.0
"""In s: what the plain reference takes to come to one of the two ends from these."""

STEP = 5e-3
"""In rad: by how much other releases are off the saddle's, from which an engine's multiplier is taken."""

PLACES, ASIDE = 4, 5e-3
"""Starts on the boundary that each engine is asked about, and how far to its sides, in m and m/s."""

WITHIN, REACH = (0.05, -0.1), 0.4
"""A start in the basin of the equilibrium, and how far from it all are in that of the whirl."""

AFTER, ASIDE_TOLERANCE = 90.0, 1e-7
"""When the engines' motions have left the saddle for good, in s, and at which tolerance."""
