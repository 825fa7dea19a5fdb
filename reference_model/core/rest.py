"""Rest: whether friction holds the body, when it is released, and how slip begins and ends, in closed form."""

import math

import numpy as np

from reference_model.core.collocation import solve_linear
from reference_model.core.contact import shares
from reference_model.core.forces import Law, growth, pull, tangent
from reference_model.core.parts import part

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

LEAST_SLIP = 1e-100
"""Negligible slip speed that still gives friction a direction."""


@part
def strength(x: float, y: float, law: Law) -> float:
    """Return the pull on the centre at rest."""
    ax, ay = pull(x, y, 0.0, 0.0, law)
    return math.sqrt(ax * ax + ay * ay)


@part
def holds_for(x: float, y: float, law: Law) -> float:
    """Return how long friction holds the body at rest at (x, y), 0 if not at all (eq. 6 and 7)."""
    if law.hold < 0.0 or strength(x, y, law) > law.hold:
        return 0.0
    if law.omega == 0.0 or law.offset == 0.0:
        return math.inf
    if law.hardening == 0.0 and law.stop == 0.0:
        return _linear_release(x, y, law)
    return _first_release(x, y, law)


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
def _spare(x: float, y: float, turn: float, law: Law) -> float:
    px, py = _turned(x, y, turn, law)
    return law.hold - strength(px, py, law)


@part
def _deflection(x: float, y: float, turn: float, law: Law) -> float:
    px, py = _turned(x, y, turn, law)
    return math.sqrt((px - law.offset) ** 2 + py * py)


@part
def _first_release(x: float, y: float, law: Law) -> float:
    """Search for the first release within a turn, by a bound Λ on the change of the margin."""
    g, radius, offset = law.hold, math.sqrt(x * x + y * y), abs(law.offset)
    carried = abs(law.omega) * math.sqrt(law.damping**2 + law.omega**2)
    held = firmly = 0.0
    waiting = np.zeros(64)
    waiting[0], depth = 2.0 * math.pi, 1
    while depth > 0:
        if _spare(x, y, held, law) > 0.0:
            firmly = held
        end = waiting[depth - 1]
        h = end - held
        reach = 0.5 * (_deflection(x, y, held, law) + _deflection(x, y, end, law) + min(offset, radius) * h)
        steepest = tangent(reach, law)
        slope = min(offset * steepest, radius * (carried + steepest))
        least = 0.5 * (_spare(x, y, held, law) + _spare(x, y, end, law) - slope * h)
        if least >= -GRAZING * g:
            held = end
            depth -= 1
        elif h > NARROW:
            waiting[depth] = 0.5 * (held + end)
            depth += 1
        elif _spare(x, y, end, law) >= -GRAZING * g:
            held = end
            depth -= 1
        else:
            if _spare(x, y, firmly, law) > 0.0:
                while True:
                    middle = 0.5 * (firmly + end)
                    if middle <= firmly or middle >= end:
                        break
                    if _spare(x, y, middle, law) > 0.0:
                        firmly = middle
                    else:
                        end = middle
            return float(firmly / abs(law.omega))
    return math.inf


@part
def _growth_at(strong: float, turning: float, beta: float, law: Law) -> tuple[float, float]:
    c, s = math.cos(beta), math.sin(beta)
    resistance, twist = shares(abs(c), abs(s), law.outer, law.inner, law.load)
    force = strong - law.friction * math.copysign(resistance, c)
    moment = turning - law.friction * math.copysign(twist, s)
    return force * c + moment * s, moment * c - force * s


@part
def direction(x: float, y: float, law: Law) -> tuple[float, float, float]:
    """Return the unit vector of the slip that begins at rest: the direction of fastest growth."""
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
def begun(x: float, y: float, n: tuple[float, float, float], law: Law) -> tuple[float, float, float, float, float]:
    """Return the growth of slip from rest to leading order: s = first·t + ½·gain·t² along n + turning·t.

    The last three results are the components of turning.
    """
    at_first = _towards(x, y, n, 0.0, law)
    first = max(at_first[0] * n[0] + at_first[1] * n[1] + at_first[2] * n[2], 0.0)
    later = _towards(x, y, n, MOMENT, law)
    matrix, change = np.zeros((3, 3)), np.zeros(3)
    for i in range(3):
        change[i] = (later[i] - at_first[i]) / MOMENT
        axis = (n[0] + TURN * (i == 0), n[1] + TURN * (i == 1), n[2] + TURN * (i == 2))
        turned = _towards(x, y, axis, 0.0, law)
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
    if law.outer == 0.0:
        system[2, 2] = 1.0
        system[2, 0] = system[2, 1] = system[0, 2] = system[1, 2] = 0.0
    solve_linear(system, change)
    solved = change
    gain = float(solved[0] * n[0] + solved[1] * n[1] + solved[2] * n[2])
    return first, gain, solved[0] - gain * n[0], solved[1] - gain * n[1], solved[2] - gain * n[2]


@part
def _towards(
    x: float, y: float, n: tuple[float, float, float], delay: float, law: Law
) -> tuple[float, float, float]:
    return growth(
        x - delay * law.omega * y, y + delay * law.omega * x,
        LEAST_SLIP * n[0], LEAST_SLIP * n[1], LEAST_SLIP * n[2], law,
    )  # fmt: skip


@part
def creep_of(
    x: float, y: float, ux: float, uy: float, r: float, law: Law, most: float
) -> tuple[float, float, float, float]:
    """Return A, λ, B and Λ of slip s = A·exp(−λt) + B·exp(−Λt) that decays forever and is almost over.

    The excess e of the pull over friction falls by c times the distance, and slip changes at the rate e − b·s, so to
    first order in the distance s'' + b·s' + c·s = 0. A is zero if slip does not creep to rest within ``most``.
    """
    none = (0.0, 0.0, 0.0, 0.0)
    s = math.sqrt(ux * ux + uy * uy + r * r)
    if not 0.0 < s < CREEP or law.friction == 0.0 or (law.omega != 0.0 and law.offset != 0.0):
        return none
    n = (ux / s, uy / s, r / s)
    moving = growth(x, y, ux, uy, r, law)
    rate = moving[0] * n[0] + moving[1] * n[1] + moving[2] * n[2]
    excess = _excess(x, y, n, 0.0, law)
    if not rate < 0.0 < excess:
        return none
    fall = (excess - _excess(x, y, n, CREEP, law)) / CREEP
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
    if not way < CREEP or abs(_excess(x, y, n, way, law) / excess) * way > most:
        return none
    return share, slow, s - share, fast


@part
def _excess(x: float, y: float, n: tuple[float, float, float], way: float, law: Law) -> float:
    a = growth(
        x + way * n[0], y + way * n[1], LEAST_SLIP * n[0], LEAST_SLIP * n[1], LEAST_SLIP * n[2], law
    )
    return a[0] * n[0] + a[1] * n[1] + a[2] * n[2]
