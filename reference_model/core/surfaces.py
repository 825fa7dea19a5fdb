"""Surfaces where the rates are continuous but not smooth, so that a step must end there."""

import math

from reference_model.core.forces.law import Law
from reference_model.core.forces.pivot import turning
from reference_model.core.forces.points import centre_slip
from reference_model.core.forces.rates import pull, rates
from reference_model.core.memory import SIDE_OF_GRIP, SIDE_OF_HOLE, SIDE_OF_RIM, SIDE_OF_SPIN, SIDE_OF_STOP
from reference_model.core.steps.explicit import Unknowns, inside
from reference_model.numerics.parts import inlined, part
from reference_model.systems import FloatArray

PLACES = 16
"""Number of places in a step where a surface is searched for."""

MOMENT = 1e-6
"""Scaled time for the difference quotient of the grip."""

ON_SURFACE = 1e-9
"""Largest value at the start of a step that began on the surface."""


@inlined
def exists(which: int, law: Law) -> bool:
    """Return whether a motion can reach a surface: stop, edge of the contact at rest, or the end of a pivot."""
    if which == SIDE_OF_STOP:
        return law.stop > 0.0 and law.gap > 0.0
    if which == SIDE_OF_RIM:
        return law.friction > 0.0 and law.outer > 0.0
    if which == SIDE_OF_HOLE:
        return law.friction > 0.0 and law.load != 0.0 and law.inner > 0.0
    return law.sense != 0.0


@part
def grip(y: Unknowns, law: Law) -> float:
    """Return the friction that a resting point can still exert, in accelerations."""
    ux, uy = centre_slip(0.0, 0.0, y[4], y[5], law)
    ax, ay = pull(y[0], y[1], ux, uy, law)
    _, _, _, hx, hy = turning(ax, ay, y[4], y[5], law)
    return law.friction * law.share - math.sqrt(hx * hx + hy * hy)


@part
def value_of(which: int, y: Unknowns, law: Law) -> float:
    """Return the deflection beyond the stop, the lead U − W of the centre over an edge, the grip, or the spin."""
    if which == SIDE_OF_STOP:
        wx = y[0] - law.offset
        return math.sqrt(wx * wx + y[1] * y[1]) - law.gap
    if which == SIDE_OF_GRIP:
        return grip(y, law)
    if which == SIDE_OF_SPIN:
        return law.sense * y[4]
    radius = law.outer if which == SIDE_OF_RIM else law.inner
    return math.sqrt(y[2] * y[2] + y[3] * y[3]) - radius * abs(y[4])


@part
def trend(which: int, y: Unknowns, law: Law) -> float:
    """Return the sign of the rate of a surface's value, or 0 if a step cannot touch it and come back."""
    if which in (SIDE_OF_RIM, SIDE_OF_HOLE):
        return 0.0
    if which == SIDE_OF_STOP:
        ux, uy = centre_slip(y[2], y[3], y[4], y[5], law)
        return (y[0] - law.offset) * (ux - law.omega * y[1]) + y[1] * (uy + law.omega * y[0])
    f = rates(y[0], y[1], y[2], y[3], y[4], y[5], law)
    if which == SIDE_OF_SPIN:
        return law.sense * f[4]
    h = MOMENT
    moved = (y[0] + h * f[0], y[1] + h * f[1], y[2], y[3], y[4] + h * f[4], y[5] + h * f[5], y[6])
    return grip(moved, law) - grip(y, law)


@part
def sides(y: Unknowns, memory: FloatArray, law: Law) -> None:
    """Store the sides of all surfaces."""
    for which in range(SIDE_OF_STOP, SIDE_OF_HOLE + 1):
        memory[which] = math.copysign(1.0, value_of(which, y, law))
    memory[SIDE_OF_GRIP] = memory[SIDE_OF_SPIN] = 1.0


@part
def crosses_any(values: FloatArray, memory: FloatArray, law: Law) -> bool:
    """Return whether one of ``values``, rows of unknowns without the time, lies beyond a kink of the forces."""
    result = False
    for which in range(SIDE_OF_STOP, SIDE_OF_HOLE + 1):
        if exists(which, law):
            for i in range(len(values)):
                v = values[i]
                y = (v[0], v[1], v[2], v[3], v[4], v[5], 0.0)
                result = result or memory[which] * value_of(which, y, law) < 0.0
    return result


@part
def may_cross(which: int, side: float, y: Unknowns, new: Unknowns, law: Law) -> bool:
    """Return whether a step crosses a surface, or may touch it and come back."""
    if not exists(which, law):
        return False
    if side * value_of(which, new, law) < 0.0:
        return True
    return side * trend(which, y, law) < 0.0 < side * trend(which, new, law)


@part
def crossing(which: int, side: float, y: Unknowns, F: FloatArray, law: Law) -> float:
    """Return the share of a step, with the interpolant ``F``, up to the crossing of a surface, or 1."""
    least = 0.0 if which in (SIDE_OF_GRIP, SIDE_OF_SPIN) else ON_SURFACE
    before, after, seen = 0.0, 1.0, side * value_of(which, y, law) > least
    turn, i, found = turning_back(which, F, law), 0, False
    while i < PLACES and not found:
        after = (i + 1) / PLACES
        if before < turn < after:
            after, turn = turn, 0.0
        else:
            i += 1
        beyond = side * value_of(which, inside(F, after), law) <= 0.0
        found = beyond and seen
        if not beyond:
            before, seen = after, True
    return changes_sign(which, False, before, after, F, law) if found else 1.0


@part
def turning_back(which: int, F: FloatArray, law: Law) -> float:
    """Return the share of a step where the value of a surface turns back, or 0."""
    if not trend(which, inside(F, 0.0), law) * trend(which, inside(F, 1.0), law) < 0.0:
        return 0.0
    return changes_sign(which, True, 0.0, 1.0, F, law)


@part
def changes_sign(which: int, turns: bool, before: float, after: float, F: FloatArray, law: Law) -> float:
    """Return where a value, or its trend if it ``turns``, changes sign between two shares of a step."""
    first = signed(which, turns, inside(F, before), law)
    while True:
        middle = 0.5 * (before + after)
        if middle <= before or middle >= after:
            return after
        if first * signed(which, turns, inside(F, middle), law) > 0.0:
            before = middle
        else:
            after = middle


@part
def signed(which: int, turns: bool, y: Unknowns, law: Law) -> float:
    """Return the value of a surface, or its trend."""
    return trend(which, y, law) if turns else value_of(which, y, law)
