"""The pin of Fig. 6 and the friction forces at which it is measured."""

from __future__ import annotations

from dataclasses import replace

from compare.claims.error_estimates import WORKING
from compare.claims.paper_parameters import FIG4
from reference_model import PinOnDisc
from reference_model.formulas.pin import largest_load_with_equilibrium

FIG6 = replace(FIG4, disc_speed=1.2)

SOURCE = "Fig. 6: Fig. 4 with ω = 1.2 rad/s; the friction forces are our choice, the paper prints no range"

LIMIT = largest_load_with_equilibrium(FIG6)

WHIRL_LOADS = (0.08, 0.09, 0.1, 0.12, 0.14, 0.16, 0.18, 0.2)
EQUILIBRIUM_LOADS = (0.02, 0.04, 0.06, 0.08, 0.095)
"""μN in N. The paper does not print the range of its axis; 2·C·X0 shows all that happens."""

CYCLE_LOAD = 0.102
"""Between C·X0 and the friction force at which the stick–slip cycle ends."""

CYCLE_DEVIATION = 0.01
CYCLE_TURNS = 5
"""How far from the cycle pins are started, relative to it, and for how many turns they are followed."""

TOLERANCE = 10.0 * WORKING
"""Of all but the friction force at which the whirl ends, which is to be known to 1e-8 N."""

INNERMOST = 0.012
"""Crossing of the x axis in m down to which the branch is followed towards the axis."""

ON_THE_WAY = 1e-8
"""Tolerance of the branch that is drawn, and that leads to the cycle; its friction forces are right to 1e-10 N."""


def with_load(load: float) -> PinOnDisc:
    """Return the pin under μN = ``load`` in N."""
    return replace(FIG6, friction_force=float(load))
