"""Surfaces where the rates are continuous but not smooth, so that a step must end there."""

import math

from reference_model.core.explicit import Unknowns, inside
from reference_model.core.forces import Law
from reference_model.core.memory import SIDE_OF_RIM, SIDE_OF_STOP
from reference_model.core.parts import part
from reference_model.systems import FloatArray

PLACES = 16
"""Number of places in a step where a surface is searched for."""

ON_SURFACE = 1e-9
"""Largest value at the start of a step that began on the surface."""


@part
def has_stop(law: Law) -> bool:
    """Return whether the stop begins at some distance."""
    return law.stop > 0.0 and law.gap > 0.0


@part
def has_rim(law: Law) -> bool:
    """Return whether friction has infinite slopes where a point of the rim rests."""
    return law.outer > 0.0 and law.load == 0.0 and law.friction > 0.0


@part
def value_of(which: int, y: Unknowns, law: Law) -> float:
    """Return the deflection beyond the stop, or the lead U − W of the centre over the rim."""
    if which == SIDE_OF_STOP:
        wx = y[0] - law.offset
        return math.sqrt(wx * wx + y[1] * y[1]) - law.gap
    return math.sqrt(y[2] * y[2] + y[3] * y[3]) - law.outer * abs(y[4])


@part
def outward(y: Unknowns, law: Law) -> float:
    """Return the rate of the deflection times the deflection."""
    return (y[0] - law.offset) * (y[2] - law.omega * y[1]) + y[1] * (y[3] + law.omega * y[0])


@part
def sides(y: Unknowns, memory: FloatArray, law: Law) -> None:
    """Store the sides of both surfaces."""
    memory[SIDE_OF_STOP] = math.copysign(1.0, value_of(SIDE_OF_STOP, y, law))
    memory[SIDE_OF_RIM] = math.copysign(1.0, value_of(SIDE_OF_RIM, y, law))


@part
def may_cross(which: int, side: float, y: Unknowns, new: Unknowns, law: Law) -> bool:
    """Return whether a step crosses a surface, or may touch the stop and come back."""
    if side * value_of(which, new, law) < 0.0:
        return True
    return which == SIDE_OF_STOP and side * outward(y, law) < 0.0 < side * outward(new, law)


@part
def crossing(which: int, side: float, y: Unknowns, F: FloatArray, law: Law) -> float:
    """Return the share of a step with the interpolant ``F`` after which a surface is crossed, or 1."""
    before, after, seen = 0.0, 1.0, side * value_of(which, y, law) > ON_SURFACE
    found = False
    for i in range(1, PLACES + 1):
        after = i / PLACES
        beyond = side * value_of(which, inside(F, after), law) <= 0.0
        if beyond and seen:
            found = True
            break
        if not beyond:
            before, seen = after, True
    if not found:
        return 1.0
    while True:
        middle = 0.5 * (before + after)
        if middle <= before or middle >= after:
            return after
        if side * value_of(which, inside(F, middle), law) > 0.0:
            before = middle
        else:
            after = middle
