"""Rest: whether friction holds the body, when it is released, and how slip begins and ends, in closed form."""

import math

import numpy as np

from reference_model.core.forces.contact import resisted
from reference_model.core.forces.law import CENTRE, Law, seen_from
from reference_model.core.forces.points import centre_slip
from reference_model.core.forces.rates import growth, pull, tangent
from reference_model.core.limit import LEAST_SLIP, direction_of_points, spare_of_points
from reference_model.core.memory import speed_of
from reference_model.core.steps.collocation import solve_linear
from reference_model.core.steps.explicit import Unknowns
from reference_model.numerics.parts import part

GRAZING = 1e-8
"""Relative excess of the pull above friction that does not count as a release: it moves the body by about g·δ²/ω²."""

NARROW = 1e-5
"""Smallest angle in rad that the search for the first release resolves."""

ROUNDING = 1e-12
"""Angle in rad within which a body counts as being at the friction limit."""

MOMENT = 1e-6
"""Scaled time for the difference quotient of the pull."""

TURN = 1e-7
"""Change of direction for the difference quotient of friction."""

CREEP = 1e-6
"""Largest distance and slip speed of creep in closed form."""

NOISE = 4e-16
"""Rounding error of the pull as a share of friction."""


@part
def strength(x: float, y: float, law: Law) -> float:
    """Return the pull on the centre at rest."""
    ax, ay = pull(x, y, 0.0, 0.0, law)
    return math.sqrt(ax * ax + ay * ay)


@part
def holds_for(x: float, y: float, angle: float, law: Law) -> float:
    """Return how long friction holds the body at rest at (x, y), 0 if not at all (eq. 6 and 7)."""
    if law.hold < 0.0 or _spare(x, y, angle, 0.0, law) < -NOISE * law.friction:
        return 0.0
    if law.omega == 0.0 or law.offset == 0.0:
        return math.inf
    if law.hardening == 0.0 and law.stop == 0.0 and len(law.around) == 0:
        return _linear_release(x, y, law)
    return _first_release(x, y, angle, law)


@part
def _linear_release(x: float, y: float, law: Law) -> float:
    constant = law.stiffness * law.offset
    ax, ay = pull(x, y, 0.0, 0.0, law)
    ax -= constant
    p, q, g = abs(constant), math.sqrt(ax * ax + ay * ay), law.hold
    if p + q <= g * (1.0 + GRAZING):
        return math.inf
    if constant < 0.0:
        ax, ay = -ax, -ay
    angle = math.atan2(ay, ax) * math.copysign(1.0, law.omega)
    limit = 2.0 * math.atan2(
        math.sqrt((p + q - g) * (p + q + g)), math.sqrt(max((g - p + q) * (g + p - q), 0.0))
    )
    turn = (-limit - angle) % (2.0 * math.pi)
    if 2.0 * math.pi - turn < ROUNDING:
        turn = 0.0
    return turn / abs(law.omega)


@part
def _turned(x: float, y: float, turn: float, law: Law) -> tuple[float, float]:
    c, s = math.cos(turn), math.sin(turn) * math.copysign(1.0, law.omega)
    return c * x - s * y, s * x + c * y


@part
def _spare(x: float, y: float, angle: float, turn: float, law: Law) -> float:
    """Return the friction that is left after a turn; for points a lower bound."""
    px, py = _turned(x, y, turn, law)
    if len(law.around) > 0:
        return spare_of_points(px, py, angle + math.copysign(turn, law.omega), law)
    return law.hold - strength(px, py, law)


@part
def _deflection(x: float, y: float, turn: float, law: Law) -> float:
    px, py = _turned(x, y, turn, law)
    return math.sqrt((px - law.offset) ** 2 + py * py)


@part
def _first_release(x: float, y: float, angle: float, law: Law) -> float:
    """Search for the first release within a turn, by a bound Λ on the change of the margin.

    The margin of points belongs to a force in the frame of the disc, where only the pull of the offset turns.
    """
    g, radius, offset = law.hold, math.sqrt(x * x + y * y), abs(law.offset)
    carried = abs(law.omega) * math.sqrt(law.damping**2 + law.omega**2)
    held = firmly = 0.0
    spare = firm = _spare(x, y, angle, 0.0, law)
    waiting, spares = np.zeros(64), np.zeros(64)
    waiting[0], spares[0], depth = 2.0 * math.pi, spare, 1
    while depth > 0:
        if spare > 0.0:
            firmly, firm = held, spare
        end, ahead = waiting[depth - 1], spares[depth - 1]
        h = end - held
        reach = 0.5 * (_deflection(x, y, held, law) + _deflection(x, y, end, law) + min(offset, radius) * h)
        steepest = tangent(reach, law)
        slope = offset * steepest
        if len(law.around) == 0:
            slope = min(slope, radius * (carried + steepest))
        least = 0.5 * (spare + ahead - slope * h)
        if least < -GRAZING * g and h > NARROW:
            waiting[depth] = 0.5 * (held + end)
            spares[depth] = _spare(x, y, angle, waiting[depth], law)
            depth += 1
        elif least >= -GRAZING * g or ahead >= -GRAZING * g:
            held, spare = end, ahead
            depth -= 1
        else:
            return _last_grip(x, y, angle, firmly, firm, end, ahead, law) / abs(law.omega)
    return math.inf


@part
def _last_grip(
    x: float, y: float, angle: float, firmly: float, firm: float, end: float, lacking: float, law: Law
) -> float:
    """Return the last turn before ``end`` where friction holds, by the Illinois method."""
    if not firm > 0.0:
        return firmly
    low, high, side = firm, lacking, 0
    for i in range(200):
        middle = firmly + (end - firmly) * low / (low - high) if i % 8 < 7 else 0.5 * (firmly + end)
        if middle <= firmly or middle >= end:
            middle = 0.5 * (firmly + end)
            if middle <= firmly or middle >= end:
                break
        value = _spare(x, y, angle, middle, law)
        if value == 0.0:
            return middle
        if value > 0.0:
            firmly, low = middle, value
            high = 0.5 * high if side > 0 else high
            side = 1
        else:
            end, high = middle, value
            low = 0.5 * low if side < 0 else low
            side = -1
    return firmly


@part
def _growth_at(strong: float, turning: float, beta: float, law: Law) -> tuple[float, float]:
    c, s = math.cos(beta), math.sin(beta)
    resistance, twist = resisted(abs(c), abs(s), law)
    force = strong - law.friction * math.copysign(resistance, c)
    moment = turning - law.friction * math.copysign(twist, s)
    return force * c + moment * s, moment * c - force * s


@part
def direction(x: float, y: float, angle: float, law: Law) -> tuple[float, float, float]:
    """Return the unit vector of the slip that begins at rest: the direction of fastest growth."""
    if len(law.around) > 0:
        return direction_of_points(x, y, angle, law)
    ax, ay = pull(x, y, 0.0, 0.0, law)
    strong, turning = math.sqrt(ax * ax + ay * ay), -law.shaft * law.lag
    beta = 0.0
    if law.outer > 0.0:
        spacing, most, best = math.pi / 64.0, -math.inf, 0
        for i in range(65):
            value = _growth_at(strong, turning, -0.5 * math.pi + i * spacing, law)[0]
            if value > most:
                most, best = value, i
        beta = -0.5 * math.pi + best * spacing
        low, high = beta - (spacing if best > 0 else 0.0), beta + (spacing if best < 64 else 0.0)
        if _growth_at(strong, turning, low, law)[1] > 0.0 > _growth_at(strong, turning, high, law)[1]:
            while True:
                beta = 0.5 * (low + high)
                if beta <= low or beta >= high:
                    break
                if _growth_at(strong, turning, beta, law)[1] > 0.0:
                    low = beta
                else:
                    high = beta
    c = math.cos(beta)
    if strong > 0.0:
        return c * ax / strong, c * ay / strong, math.sin(beta)
    return c, 0.0, math.sin(beta)


@part
def drift(y: Unknowns, law: Law) -> tuple[float, float, float, float]:
    """Return the rates of x, y, r and the angle while the slip is zero."""
    ux, uy = centre_slip(0.0, 0.0, y[4], y[5], law)
    ar = 0.0
    if law.point != CENTRE:
        about = seen_from(law.point, math.copysign(1.0, y[4]), law)
        ar = growth(y[0], y[1], 0.0, 0.0, y[4], y[5], about)[2]
    return ux - law.omega * y[1], uy + law.omega * y[0], ar, law.omega + y[4] / law.gyration


@part
def begun(y: Unknowns, n: tuple[float, float, float], law: Law) -> tuple[float, float, float, float, float]:
    """Return the growth of slip from rest to leading order: s = first·t + ½·gain·t² along n + turning·t.

    The last three results are the components of turning.
    """
    at_first = _towards(y, n, 0.0, 0.0, law)
    first = max(at_first[0] * n[0] + at_first[1] * n[1] + at_first[2] * n[2], 0.0)
    later = _towards(y, n, MOMENT, first * MOMENT, law)
    matrix, change = np.zeros((3, 3)), np.zeros(3)
    for i in range(3):
        change[i] = (later[i] - at_first[i]) / MOMENT
        axis = (n[0] + TURN * (i == 0), n[1] + TURN * (i == 1), n[2] + TURN * (i == 2))
        turned = _towards(y, axis, 0.0, 0.0, law)
        for j in range(3):
            matrix[j, i] = (at_first[j] - turned[j]) / TURN
    system = np.zeros((3, 3))
    for i in range(3):
        for j in range(3):
            across = (1.0 if i == j else 0.0) - n[i] * n[j]
            total = 2.0 * first * across + n[i] * n[j]
            for k in range(3):
                total += matrix[i, k] * ((1.0 if k == j else 0.0) - n[k] * n[j])
            system[i, j] = total
    if law.sense != 0.0:
        system[0, 0] = system[1, 1] = 1.0
        system[0, 1] = system[0, 2] = system[1, 0] = system[1, 2] = system[2, 0] = system[2, 1] = 0.0
    elif law.point != CENTRE or (law.outer == 0.0 and len(law.around) == 0):
        system[2, 2] = 1.0
        system[2, 0] = system[2, 1] = system[0, 2] = system[1, 2] = 0.0
        change[2] = 0.0
    solve_linear(system, change)
    solved = change
    gain = float(solved[0] * n[0] + solved[1] * n[1] + solved[2] * n[2])
    return first, gain, solved[0] - gain * n[0], solved[1] - gain * n[1], solved[2] - gain * n[2]


@part
def _towards(
    y: Unknowns, n: tuple[float, float, float], delay: float, speed: float, law: Law
) -> tuple[float, float, float, float, float, float]:
    """Return the rates of the slip with this speed in the direction ``n``, ``delay`` after the body was at rest."""
    x, z, r, angle = drift(y, law)
    r, angle = y[4] + delay * r, y[5] + delay * angle
    slip = max(speed, LEAST_SLIP)
    if law.point == CENTRE or law.sense != 0.0:
        r = slip * n[2]
    return growth(y[0] + delay * x, y[1] + delay * z, slip * n[0], slip * n[1], r, angle, law)


@part
def creep_of(y: Unknowns, law: Law, most: float) -> tuple[float, float, float, float]:
    """Return A, λ, B and Λ of slip s = A·exp(−λt) + B·exp(−Λt) that decays forever and is almost over.

    The excess e of the pull over friction falls by c times the distance, and slip changes at the rate e − b·s, so to
    first order in the distance s'' + b·s' + c·s = 0. A is zero if slip does not creep to rest within ``most``.
    ``law`` describes the centre or a pivot.
    """
    none = (0.0, 0.0, 0.0, 0.0)
    s = speed_of(y, law)
    if not 0.0 < s < CREEP or law.friction == 0.0 or (law.omega != 0.0 and law.offset != 0.0):
        return none
    n = (0.0, 0.0, law.sense) if law.sense != 0.0 else (y[2] / s, y[3] / s, y[4] / s)
    moving = growth(y[0], y[1], y[2], y[3], y[4], y[5], law)
    rate = moving[0] * n[0] + moving[1] * n[1] + moving[2] * n[2]
    excess = _excess(y, n, 0.0, law)
    if not rate < 0.0 < excess:
        return none
    fall = (excess - _excess(y, n, CREEP, law)) / CREEP
    damping = (excess - rate) / s
    discriminant = damping * damping - 4.0 * fall
    if not (fall > 0.0 and damping > 0.0 and discriminant > 0.0):
        return none
    apart = math.sqrt(discriminant)
    fast = 0.5 * (damping + apart)
    slow = fall / fast
    share = (excess - slow * s) / apart
    if not share > 0.0:
        return none
    way = share / slow + (s - share) / fast
    # The rest of the growth at the end of slip; the pull has turned away from n
    a = _grown(y, n, way, law)
    along = a[0] * n[0] + a[1] * n[1] + a[2] * n[2]
    across = a[0] * a[0] + a[1] * a[1] + a[2] * a[2] - along * along
    left = max(abs(along) + 0.5 * across / law.friction - NOISE * law.friction, 0.0)
    if not way < CREEP or left / excess * way > most:
        return none
    return share, slow, s - share, fast


@part
def _excess(y: Unknowns, n: tuple[float, float, float], way: float, law: Law) -> float:
    """Return the growth of negligible slip after a ``way`` along ``n``."""
    a = _grown(y, n, way, law)
    return a[0] * n[0] + a[1] * n[1] + a[2] * n[2]


@part
def _grown(
    y: Unknowns, n: tuple[float, float, float], way: float, law: Law
) -> tuple[float, float, float, float, float, float]:
    ux, uy = centre_slip(n[0], n[1], n[2], y[5], law)
    return growth(
        y[0] + way * ux, y[1] + way * uy, LEAST_SLIP * n[0], LEAST_SLIP * n[1], LEAST_SLIP * n[2],
        y[5] + way * n[2] / law.gyration, law,
    )  # fmt: skip
