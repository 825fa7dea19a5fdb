"""Implicit steps of slip for compiled code: Radau IIA through all nodes of a step at once, as in ``breakaway``.

Slip that creeps draws its direction to that of the pull at the rate g/s, a strong damper draws the velocity to zero
at β/m: an explicit step is limited by these rates long after what they rule has died out. This method is not (Hairer
and Wanner, Solving Ordinary Differential Equations II, IV.5).

Unknowns of Newton's method are the components of slip at the nodes: (u_x, u_y) of a pin, and r besides of a disc. The
place of the centre, which goes by slip alone, is linear in them. Friction is the gradient of a mean slip speed P, so
that its derivative −g·P'' is symmetric and gives nothing along the slip: differences, in which that would be lost in
rounding, are freed of it.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from reference_model.contact.limit_surface import ComplexArray
from reference_model.ensemble.core.jit import inlined, scalar, written_out
from reference_model.ensemble.core.laws import DiscLaw, Friction, points_friction, pull, ring_friction
from reference_model.ensemble.core.stepping.linear import complex_zeros, length_of, solve, zeros
from reference_model.motion.slip.breakaway import MOST_ITERATIONS
from reference_model.numerics import collocation
from reference_model.numerics.collocation import NODES
from reference_model.systems import FloatArray

INTEGRAL, SERIES = np.array(collocation.INTEGRAL), np.array(collocation.TO_SERIES)
LAST_TERM = np.array(collocation.FROM_START[NODES])
PLACES = 0.5 * (np.array(collocation.POINTS) + 1.0)
"""As in :mod:`reference_model.numerics.collocation`, with the places of the nodes in 0..1."""

APART = 1e-7
"""Change of slip, relative to it, by which friction is differentiated."""

SHARE = 1e-3
"""Error of slip, relative to it, that is allowed at most: it must not change its sense."""

ROUNDED = 1e-15
"""Error of slip, in units, that is rounding."""

WORTH = 10.0
"""So many explicit steps, in time, an implicit one must be worth."""

FIRST_SPAN = 0.1
"""Of the first one, in units of time, or twice what it must be worth."""

PATIENCE, MOST_FAILURES = 100.0, 3.0
"""So many more short steps are made where no implicit one was worth it, and twice as many after each failure more,
up to the last."""

GROWTH, CAUTION = 4.0, 0.8
"""By how much the next step may differ from this one at most, and below what the error estimate would allow."""


Collocation = Callable[
    [complex, float, FloatArray, float, DiscLaw, FloatArray, FloatArray, FloatArray], float
]
"""Solves for the slip at the nodes of a step, as :func:`collocate_with` with a friction of its own."""


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

    Also for its rates ``f`` and the mean slip speed ``power`` (NODES,). ``z``, ``angle`` and ``start`` are where the
    step begins, ``law`` is that of a disc, and ``friction`` as ``laws.ring_friction``. Return how fast friction
    draws slip to its direction at the end, or -1 if there is no convergence.

    In one piece, because what is handed a function is written out into its caller, and so each part would have to be.
    """
    d = len(start)
    matrix, change = zeros((NODES * d) ** 2).reshape(NODES * d, NODES * d), zeros(NODES * d)
    linear, rest = matrix.reshape(NODES, d, NODES, d), change.reshape(NODES, d)
    slopes = zeros(NODES * d * d).reshape(NODES, d, d)
    by_place = -law.stiffness - (law.damping + 1j * law.disc_speed) * 1j * law.disc_speed
    by_slip = -(law.damping + 1j * law.disc_speed)
    turns = _turns(law.disc_speed, step)
    reach = _reach(step, by_place, turns)
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
            a = pull(_place(z, w, step, j, turns), complex(ux, uy), law) + law.friction * complex(fx, fy)
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
            _free_of(slopes[j], w[j], s)
            slopes[j, 0, 0] += by_slip.real
            slopes[j, 0, 1] -= by_slip.imag
            slopes[j, 1, 0] += by_slip.imag
            slopes[j, 1, 1] += by_slip.real
            if d == 3:
                slopes[j, 2, 2] -= law.shaft_rate
        _linearise(w, f, slopes, start, step, reach, linear, rest)
        if not solve(matrix, change):
            return -1.0
        if _corrected(w, rest, step):
            return _size_of(slopes[-1])
    return -1.0


@scalar
def _turns(disc_speed: float, step: float) -> ComplexArray:
    """Return how the master disc has turned up to the nodes, e^(iωt)."""
    turns = complex_zeros(NODES)
    for j in range(NODES):
        turn = disc_speed * step * PLACES[j]
        turns[j] = complex(math.cos(turn), math.sin(turn))
    return turns


@scalar
def _reach(step: float, by_place: complex, turns: ComplexArray) -> ComplexArray:
    """Return the derivative of step times the pull at a node by slip at another, through the place."""
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
    """Put by how much the slip at the nodes misses its equations into ``rest`` (NODES, d).

    And the derivative of this by all slip into ``linear`` (NODES, d, NODES, d).
    """
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
    """Take the change (NODES, d) of Newton's method off the slip; tell whether it was no more than rounding."""
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
    """Return what ``laws.ring_friction`` does, of a pin, which does not spin."""
    s = math.sqrt(ux * ux + uy * uy)
    return -ux / s, -uy / s, 0.0, s


@written_out
def collocate_pin(
    z: complex,
    angle: float,
    start: FloatArray,
    step: float,
    law: DiscLaw,
    w: FloatArray,
    f: FloatArray,
    power: FloatArray,
) -> float:
    """Do as :func:`collocate_with` of a pin."""
    return float(collocate_with(z, angle, start, step, law, w, f, power, pin_friction))


@scalar
def collocate_ring(
    z: complex,
    angle: float,
    start: FloatArray,
    step: float,
    law: DiscLaw,
    w: FloatArray,
    f: FloatArray,
    power: FloatArray,
) -> float:
    """Do as :func:`collocate_with` of a disc on a ring."""
    return float(collocate_with(z, angle, start, step, law, w, f, power, ring_friction))


@written_out
def collocate_points(
    z: complex,
    angle: float,
    start: FloatArray,
    step: float,
    law: DiscLaw,
    w: FloatArray,
    f: FloatArray,
    power: FloatArray,
) -> float:
    """Do as :func:`collocate_with` of a disc on points."""
    return float(collocate_with(z, angle, start, step, law, w, f, power, points_friction))


@written_out
def stride_with(
    z: complex, angle: float, start: FloatArray, guess: FloatArray, span: float, least: float, tolerance: float,
    law: DiscLaw, collocate: Collocation,
) -> tuple[complex, float, float, float, float, float, float, float]:  # fmt: skip
    """Make an implicit step of ``span``, or shorter where its error asks for that, but not shorter than ``least``.

    ``start`` (2 or 3,) is the slip at its beginning, and ``guess`` what it may soon be.
    Return place, the components of slip, angle, how long the step was, the way slipped and how long the next may be.
    Of no length: not worth it.
    """
    d = len(start)
    w, f = zeros(NODES * d).reshape(NODES, d), zeros(NODES * d).reshape(NODES, d)
    power = zeros(NODES)
    s = length_of(start)
    while span >= least:
        carried = (
            law.disc_speed if law.friction * span > s else 0.0
        )  # slow slip turns with the pull, and that does
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
        there = place_after(z, w, span, law)
        return there, last[0], last[1], r, turned, span, way, span * min(factor, GROWTH)
    return z, 0.0, 0.0, 0.0, angle, 0.0, 0.0, span


@inlined
def first_try(planned: float, least: float, left: float) -> float:
    """Return how long a step is tried, if ``planned``, how long it may be, is known: > 0."""
    return min(planned if planned > 0.0 else max(FIRST_SPAN, 2.0 * least), left)


@inlined
def failed(planned: float) -> float:
    """Return what stands for ``planned`` after a failure: minus the number of those in a row."""
    return max(min(planned, 0.0) - 1.0, -MOST_FAILURES)


@inlined
def patience(planned: float) -> float:
    """Return how many more short steps are made after failures."""
    steps: float = PATIENCE * 2.0**-planned
    return steps


@scalar
def place_after(z: complex, w: FloatArray, step: float, law: DiscLaw) -> complex:
    """Return where the centre is at the end of a step: in the frame of the master disc it goes by the slip alone."""
    return _place(z, w, step, NODES - 1, _turns(law.disc_speed, step))


@inlined
def _place(z: complex, w: FloatArray, step: float, node: int, turns: ComplexArray) -> complex:
    """Return where the centre is at a node; ``turns`` are those of the master disc up to the nodes, e^(iωt)."""
    way = 0j
    for j in range(NODES):
        way += INTEGRAL[node, j] * turns[j].conjugate() * complex(w[j, 0], w[j, 1])
    place: complex = turns[node] * (z + step * way)
    return place


@inlined
def _free_of(matrix: FloatArray, along: FloatArray, size: float) -> None:
    """Take the direction ``along`` out of a symmetric matrix, from both sides; ``size`` is the length of that."""
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
    """Return the Frobenius norm."""
    total = 0.0
    for row in matrix:
        for value in row:
            total += value * value
    return math.sqrt(total)


@scalar
def _turns_back(start: FloatArray, w: FloatArray) -> bool:
    """Tell whether slip turns by more than a right angle before a node: then it came to rest on the way."""
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
    """Return the largest of the last coefficients of the polynomials through the slip at the start and the nodes.

    Those through the nodes alone would not see what happens before the first of them.
    """
    largest = 0.0
    for k in range(len(start)):
        term = LAST_TERM[0] * start[k]
        for j in range(NODES):
            term += LAST_TERM[j + 1] * w[j, k]
        largest = max(largest, abs(term))
    return largest
