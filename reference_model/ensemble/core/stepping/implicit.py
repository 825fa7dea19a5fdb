"""Implicit steps of slip for compiled code: Radau IIA, solved for all nodes of a step at once.

The unknowns are the slip at the nodes: (u_x, u_y) of a pin, and also r of a disc. The derivative −g·P'' of friction
is symmetric and zero along the slip, because P is of degree one, so its rounding error along the slip is removed.
"""

import math
from collections.abc import Callable

import numpy as np

from reference_model.core.steps import collocation
from reference_model.core.steps.collocation import NODES
from reference_model.ensemble.core.jit import inlined, scalar, written_out
from reference_model.ensemble.core.laws import DiscLaw, Friction, points_friction, pull, ring_friction
from reference_model.ensemble.core.stepping.linear import complex_zeros, length_of, solve, zeros
from reference_model.systems import ComplexArray, FloatArray

INTEGRAL, SERIES = np.array(collocation.INTEGRAL), np.array(collocation.TO_SERIES)
LAST_TERM = np.array(collocation.FROM_START[NODES])
PLACES = 0.5 * (np.array(collocation.POINTS) + 1.0)
"""Nodes in [0, 1]."""

MOST_ITERATIONS = 12

APART = 1e-7
"""Relative change of slip for the derivative of friction."""

SHARE = 1e-3
"""Largest allowed error of slip, relative to it: slip must not reverse."""

ROUNDED = 1e-15
"""Rounding error of scaled slip."""

WORTH = 10.0
"""Number of explicit steps whose total time an implicit step must exceed."""

FIRST_SPAN = 0.1
"""Scaled first implicit step, or twice the smallest worthwhile step if longer."""

PATIENCE, MOST_FAILURES = 100.0, 3.0
"""Number of short steps before another try after a failure, and largest number of its doublings."""

GROWTH, CAUTION = 4.0, 0.8
"""Largest ratio of successive steps, and safety factor of the error estimate."""


Collocation = Callable[
    [complex, float, FloatArray, float, DiscLaw, FloatArray, FloatArray, FloatArray], float
]
""":func:`collocate_with` with a given friction."""


@written_out
def collocate_with(
    z: complex,
    angle: float,
    start: FloatArray,
    step: float,
    law: DiscLaw,
    w: FloatArray,
    f: FloatArray,
    power: FloatArray,
    friction: Friction,
) -> float:
    """Solve for the slip ``w`` (NODES, 2 or 3) at the nodes of a step, from a guess.

    ``z``, ``angle`` and ``start`` belong to the start of the step. The rates ``f`` and the mean slip speed ``power``
    (NODES,) are results too. Returns the final relaxation rate of the direction of slip, or -1 without convergence.
    """
    d = len(start)
    matrix, change = zeros((NODES * d) ** 2).reshape(NODES * d, NODES * d), zeros(NODES * d)
    linear, rest = matrix.reshape(NODES, d, NODES, d), change.reshape(NODES, d)
    slopes = zeros(NODES * d * d).reshape(NODES, d, d)
    turns = _turns(law.disc_speed, step)
    reach = _reach(step, law, turns)
    for _ in range(MOST_ITERATIONS):
        for j in range(NODES):
            ux, uy = w[j, 0], w[j, 1]
            r = w[j, 2] if d == 3 else 0.0
            turned = angle + law.disc_speed * step * PLACES[j]
            if d == 3:
                for k in range(NODES):
                    turned += law.curling * step * INTEGRAL[j, k] * w[k, 2]
            s = math.sqrt(ux * ux + uy * uy + r * r)
            apart = APART * s
            fx, fy, fr, power[j] = friction(ux, uy, r, turned, law)
            a = pull(_position_at_node(z, w, step, j, turns), complex(ux, uy), law) + law.friction * complex(
                fx, fy
            )
            f[j, 0], f[j, 1] = a.real, a.imag
            if d == 3:
                f[j, 2] = -law.shaft_rate * (r + law.lag) + law.friction * fr
            for k in range(d):
                moved = friction(
                    ux + apart * (k == 0), uy + apart * (k == 1), r + apart * (k == 2), turned, law
                )
                slopes[j, 0, k] = law.friction * (moved[0] - fx) / apart
                slopes[j, 1, k] = law.friction * (moved[1] - fy) / apart
                if d == 3:
                    slopes[j, 2, k] = law.friction * (moved[2] - fr) / apart
            _complete(slopes[j], w[j], s, law)
        _linearise(w, f, slopes, start, step, reach, linear, rest)
        if not solve(matrix, change):
            return -1.0
        if _corrected(w, rest, step):
            return _size_of(slopes[-1])
    return -1.0


@scalar
def _complete(slopes: FloatArray, along: FloatArray, size: float, law: DiscLaw) -> None:
    _free_of(slopes, along, size)
    slopes[0, 0] -= law.damping
    slopes[0, 1] += law.disc_speed
    slopes[1, 0] -= law.disc_speed
    slopes[1, 1] -= law.damping
    if len(along) == 3:
        slopes[2, 2] -= law.shaft_rate


@scalar
def _turns(disc_speed: float, step: float) -> ComplexArray:
    turns = complex_zeros(NODES)
    for j in range(NODES):
        turn = disc_speed * step * PLACES[j]
        turns[j] = complex(math.cos(turn), math.sin(turn))
    return turns


@scalar
def _reach(step: float, law: DiscLaw, turns: ComplexArray) -> ComplexArray:
    """Return d(step times the pull at a node)/d(slip at another node), through the position."""
    by_place = -law.stiffness - (law.damping + 1j * law.disc_speed) * 1j * law.disc_speed
    reach = complex_zeros(NODES * NODES).reshape(NODES, NODES)
    for i in range(NODES):
        for k in range(NODES):
            total = 0j
            for j in range(NODES):
                total += INTEGRAL[i, j] * INTEGRAL[j, k] * turns[j]
            reach[i, k] = step * step * by_place * total * turns[k].conjugate()
    return reach


@scalar
def _linearise(
    w: FloatArray, f: FloatArray, slopes: FloatArray, start: FloatArray, step: float, reach: ComplexArray,
    linear: FloatArray, rest: FloatArray,
) -> None:  # fmt: skip
    """Write the residual at the nodes to ``rest`` (NODES, d), its derivative to ``linear`` (NODES, d, NODES, d)."""
    d = len(start)
    for i in range(NODES):
        for a in range(d):
            missed = w[i, a] - start[a]
            for j in range(NODES):
                missed -= step * INTEGRAL[i, j] * f[j, a]
                for b in range(d):
                    same = 1.0 if i == j and a == b else 0.0
                    linear[i, a, j, b] = same - step * INTEGRAL[i, j] * slopes[j, a, b]
            rest[i, a] = missed
        for j in range(NODES):
            linear[i, 0, j, 0] -= reach[i, j].real
            linear[i, 0, j, 1] += reach[i, j].imag
            linear[i, 1, j, 0] -= reach[i, j].imag
            linear[i, 1, j, 1] -= reach[i, j].real


@scalar
def _corrected(w: FloatArray, change: FloatArray, step: float) -> bool:
    """Subtract the Newton correction (NODES, d); return whether it was only rounding."""
    converged = True
    for i in range(NODES):
        size = length_of(change[i])
        for k in range(w.shape[1]):
            w[i, k] -= change[i, k]
        s = length_of(w[i])
        converged = converged and size < 1e-9 * s + 1e-15 * step and size < 1e-13 * (1.0 + s)
    return converged


@inlined
def pin_friction(
    ux: float, uy: float, r: float, angle: float, law: DiscLaw
) -> tuple[float, float, float, float]:
    s = math.sqrt(ux * ux + uy * uy)
    return -ux / s, -uy / s, 0.0, s


def _collocation(friction: Friction, compiled: Callable[[Collocation], Collocation]) -> Collocation:
    """Return :func:`collocate_with` for one kind of friction; the compiler accepts no partial functions."""

    def collocate(
        z: complex, angle: float, start: FloatArray, step: float, law: DiscLaw, w: FloatArray, f: FloatArray,
        power: FloatArray,
    ) -> float:  # fmt: skip
        return float(collocate_with(z, angle, start, step, law, w, f, power, friction))

    return compiled(collocate)


collocate_pin = _collocation(pin_friction, written_out)
collocate_ring = _collocation(ring_friction, scalar)
collocate_points = _collocation(points_friction, written_out)


@written_out
def stride_with(
    z: complex, angle: float, start: FloatArray, guess: FloatArray, span: float, least: float, tolerance: float,
    law: DiscLaw, collocate: Collocation,
) -> tuple[complex, float, float, float, float, float, float, float]:  # fmt: skip
    """Make an implicit step of ``span``, or a shorter one of at least ``least`` if its error requires it.

    ``start`` (2 or 3,) is the initial slip, ``guess`` the slip soon after. Returns position, slip, angle, duration
    (zero if the step is not worthwhile), slip distance and the proposed next step.
    """
    d = len(start)
    w, f = zeros(NODES * d).reshape(NODES, d), zeros(NODES * d).reshape(NODES, d)
    power = zeros(NODES)
    s = length_of(start)
    while span >= least:
        carried = (
            law.disc_speed if law.friction * span > s else 0.0
        )  # slow slip turns with the pull, which turns with the disc
        for i in range(NODES):
            turn = carried * span * PLACES[i]
            along = complex(math.cos(turn), math.sin(turn)) * complex(guess[0], guess[1])
            w[i, 0], w[i, 1] = along.real, along.imag
            if d == 3:
                w[i, 2] = guess[2]
        if collocate(z, angle, start, span, law, w, f, power) < 0.0 or _turns_back(start, w):
            span *= 0.25
            continue
        allowed = max(min(tolerance, SHARE * min(s, length_of(w[NODES - 1]))), ROUNDED)
        error = _last_term(start, w)
        factor = CAUTION * (allowed / max(error, 1e-30)) ** (1.0 / NODES)
        if error > allowed:
            span *= max(factor, 0.25)
            continue
        turned, way = angle + law.disc_speed * span, 0.0
        for j in range(NODES):
            way += span * INTEGRAL[NODES - 1, j] * power[j]
            if d == 3:
                turned += law.curling * span * INTEGRAL[NODES - 1, j] * w[j, 2]
        last = w[NODES - 1]
        r = last[2] if d == 3 else 0.0
        there = position_after(z, w, span, law)
        return there, last[0], last[1], r, turned, span, way, span * min(factor, GROWTH)
    return z, 0.0, 0.0, 0.0, angle, 0.0, 0.0, span


@inlined
def first_try(planned: float, least: float, left: float) -> float:
    return min(planned if planned > 0.0 else max(FIRST_SPAN, 2.0 * least), left)


@inlined
def failed(planned: float) -> float:
    """Return ``planned`` after another failure: minus the number of successive failures."""
    return max(min(planned, 0.0) - 1.0, -MOST_FAILURES)


@inlined
def patience(planned: float) -> float:
    steps: float = PATIENCE * 2.0**-planned
    return steps


@scalar
def position_after(z: complex, w: FloatArray, step: float, law: DiscLaw) -> complex:
    return _position_at_node(z, w, step, NODES - 1, _turns(law.disc_speed, step))


@inlined
def _position_at_node(z: complex, w: FloatArray, step: float, node: int, turns: ComplexArray) -> complex:
    """Return the position of the centre, which relative to the master disc depends on slip only."""
    way = 0j
    for j in range(NODES):
        way += INTEGRAL[node, j] * turns[j].conjugate() * complex(w[j, 0], w[j, 1])
    place: complex = turns[node] * (z + step * way)
    return place


@inlined
def _free_of(matrix: FloatArray, along: FloatArray, size: float) -> None:
    d = len(along)
    for i in range(d):
        part = 0.0
        for k in range(d):
            part += matrix[i, k] * along[k]
        for k in range(d):
            matrix[i, k] -= part * along[k] / (size * size)
    for k in range(d):
        part = 0.0
        for i in range(d):
            part += matrix[i, k] * along[i]
        for i in range(d):
            matrix[i, k] -= part * along[i] / (size * size)


@scalar
def _size_of(matrix: FloatArray) -> float:
    total = 0.0
    for row in matrix:
        for value in row:
            total += value * value
    return math.sqrt(total)


@scalar
def _turns_back(start: FloatArray, w: FloatArray) -> bool:
    """Return whether slip turns by more than a right angle: it came to rest on the way."""
    before = start
    for i in range(NODES):
        along = 0.0
        for k in range(len(start)):
            along += w[i, k] * before[k]
        if not along > 0.0:
            return True
        before = w[i]
    return False


@scalar
def _last_term(start: FloatArray, w: FloatArray) -> float:
    """Return the largest last coefficient of the polynomials through the slip."""
    largest = 0.0
    for k in range(len(start)):
        term = LAST_TERM[0] * start[k]
        for j in range(NODES):
            term += LAST_TERM[j + 1] * w[j, k]
        largest = max(largest, abs(term))
    return largest
