"""The disc of Fig. 8, the friction forces at which it is measured, and the offsets that the paper leaves open."""

from __future__ import annotations

from dataclasses import replace

from compare.claims.error_estimates import WORKING
from compare.claims.paper_parameters import FIG8
from reference_model.contact.contact_law import ThreeTermRing

RING = FIG8
"""Fig. 8 on the continuous ring of (20)."""

SIX = replace(RING, contact_points=6)
"""What the paper simulated."""

PAPER_LAW = ThreeTermRing(FIG8.contact_radius)
"""(23)."""

SOURCE = (
    "Fig. 8; X0 = 0.1 m as in Figs. 4 to 6, which the paper leaves out; the friction forces are our choice"
)

SOURCE_OF_GRID = "Fig. 8; friction forces and X0 are our choice, the paper leaves out X0"

LOADS = (0.01, 0.035, 0.065, 0.095, 0.104)
"""μN in N. The paper prints no range; the equilibrium ends a little above C·X0 = 0.1 N."""

DECAYS = ((0.05, (700.0, 1000.0)), (0.095, (250.0, 400.0)))
"""μN in N, and in s the span in which the decay is measured: late enough for small deviations."""

END_LOADS = (0.1015, 0.1025, 0.1035, 0.1044, 0.1049, 0.1052)
"""μN in N, near to where the equilibrium ends; there the distance from the axis falls to zero linearly."""

STICKING_RATIOS = (0.98, 1.02, 1.05)
"""Friction forces about the last one with an equilibrium, in units of it."""

STICKING_TIME = 80.0
"""In s: in that time friction takes a disc with 95 % of the speed of the master disc along, where it can."""

OFFSETS = (0.02, 0.05, 0.1, 0.2)
"""X0 in m, which the paper leaves out; 0.1 is that of Figs. 4 to 6."""

TOLERANCE = WORKING / 10
"""Of the motions to a rest, of which the claims resolve 1e-9."""

BALANCED = 1e-9
"""Of μN: a force below is rounding, and the bracket of (26) as printed leaves far more."""

RESOLUTION = 1e-9
"""Of places in m and spins in rad/s on the continuous ring."""
