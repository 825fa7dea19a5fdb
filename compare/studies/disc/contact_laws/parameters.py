"""The discs whose friction is measured, how they move, and the laws that are compared."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from compare.claims.paper_parameters import FIG11

DISC = FIG11

SIX = replace(FIG11, contact_points=6)

SOURCE = "Fig. 11; how the disc moves is ours"

SOURCE_OF_LAWS = "R of Fig. 11; slip and spin are ours"

RATIOS = (0.05, 0.3, 0.6, 0.8, 1.25, 1.7, 3.0, 20.0)
"""U/W of the motions: not too near to U = W, where friction has no derivative."""

SPEED = 0.3
"""√(U² + W²) in m/s, ν̄_r of (22)."""

CENTRE, DIRECTION, ANGLE = 0.05 - 0.02j, 0.4, 0.3
"""Of these motions: where the disc's centre is in m, direction of its slip and angle of the disc in rad."""

STEP = 2e-3
"""In s, between the velocities whose differences give the acceleration at the start."""

DIFFERENCES = (
    (-25.0 / 12.0, 4.0, -3.0, 4.0 / 3.0, -1.0 / 4.0),
    (-11.0 / 6.0, 3.0, -3.0 / 2.0, 1.0 / 3.0, 0.0),
)
"""Weights of the first derivative at the first of five times, of fourth and of third order."""

R = FIG11.contact_radius

COMPARED = (*np.geomspace(1e-3, 1e3, 19).tolist(), 1.0 - 1e-3, 1.0 + 1e-3, 1.0 - 1e-6, 1.0 + 1e-6)
"""U/W at which the closed form is compared with the integral; 1 is among them."""

NUMBERS = (6, 12, 24)
"""Of points on the ring."""

ZOOMS = 30
"""Halvings of the range in which the greatest error of points is searched."""

INNER = 2.0 / 3.0 * R
"""Inner radius of the annulus in m, whose outer one is R."""

RESTING = (INNER, 0.75 * R, R)
"""Radii of the annulus in m where a point is at rest while its convergence is observed."""

RINGS = (8, 9, 10, 11, 12)
"""On either side of that radius: as many as leave the error well above rounding."""

WIDTHS = (0.16, 0.12, 0.08, 0.06, 0.04, 0.03)
"""Of thin annuli, in units of their mean radius."""
