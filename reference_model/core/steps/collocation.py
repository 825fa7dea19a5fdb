"""Radau IIA collocation of order 15 for slip that begins, and for stiff slip.

Hairer and Wanner, Solving Ordinary Differential Equations II, IV.5. A polynomial passes through the start of a step
and solves the equations of motion at eight nodes, the last of them at the end. As functions of time the components of
slip are smooth there, although the direction of slip relaxes fast.
"""

import math

import numpy as np
from numpy.polynomial import legendre
from scipy.special import roots_jacobi

from reference_model.core.forces.law import CENTRE, Law
from reference_model.core.forces.points import turning_of_friction
from reference_model.core.forces.rates import friction, growth, secant, tangent
from reference_model.numerics.parts import part
from reference_model.systems import FloatArray

NODES = 8
POINTS = np.append(roots_jacobi(NODES - 1, 1.0, 0.0)[0], 1.0)
"""Radau nodes in [−1, 1], the last at 1."""

TO_SERIES = np.linalg.inv(legendre.legvander(POINTS, NODES - 1))
"""Matrix from values at the nodes to Legendre coefficients."""

INTEGRAL = 0.5 * legendre.legval(POINTS, legendre.legint(TO_SERIES, lbnd=-1)).T
"""Matrix from values at the nodes to integrals from 0 to the nodes, scaled to [0, 1]."""

FROM_START = np.linalg.inv(legendre.legvander(np.append(-1.0, POINTS), NODES))
"""Matrix from values at the start and the nodes to Legendre coefficients."""

DIFFERENCE = 1e-7
"""Change of the direction of slip for numerical derivatives of friction."""

MOST_ITERATIONS = 14

CONVERGED, NEAR = 1e-7, 1e-9
"""Change in Newton's method, relative for slip and absolute for the rest, that leaves only rounding error."""

RELATIVE = 1e-3
"""Largest error of slip relative to slip, because small slip decides when it ends."""

NOISE = 10.0
"""Change, in these units, that may be noise if it hardly falls."""


ROUNDING = 1e-14
"""Rounding error of the last terms of a series relative to its values."""


@part
def rates_at(values: FloatArray, law: Law) -> FloatArray:
    """Return the rates of x, y, the slip, r and the angle in time at the nodes, shape (NODES, 6)."""
    result = np.empty((NODES, 6))
    for i in range(NODES):
        x, y, vx, vy, r, angle = (
            values[i, 0],
            values[i, 1],
            values[i, 2],
            values[i, 3],
            values[i, 4],
            values[i, 5],
        )
        ax, ay, ar, _, ux, uy = growth(x, y, vx, vy, r, angle, law)
        result[i, 0] = ux - law.omega * y
        result[i, 1] = uy + law.omega * x
        result[i, 2] = ax
        result[i, 3] = ay
        result[i, 4] = ar
        result[i, 5] = law.omega + r / law.gyration
    return result


@part
def friction_derivatives(vx: float, vy: float, r: float, angle: float, law: Law) -> FloatArray:
    """Return the derivatives of the acceleration by friction of the centre and r, shape (3, 4).

    For a ring they are difference quotients. Friction does not change along the slip, so this derivative is removed.
    """
    if len(law.around) > 0:
        return turning_of_friction(vx, vy, r, angle, law)
    result = np.zeros((3, 4))
    if law.friction == 0.0:
        return result
    s = math.sqrt(vx * vx + vy * vy + r * r)
    n = (vx / s, vy / s, r / s)
    at = friction(n[0], n[1], n[2], angle, law)
    for j in range(2 if law.outer == 0.0 else 3):
        h = DIFFERENCE
        moved = friction(
            n[0] + (h if j == 0 else 0.0),
            n[1] + (h if j == 1 else 0.0),
            n[2] + (h if j == 2 else 0.0),
            angle,
            law,
        )
        for i in range(3):
            result[i, j] = (moved[i] - at[i]) / (h * s)
    for i in range(3):
        along = result[i, 0] * n[0] + result[i, 1] * n[1] + result[i, 2] * n[2]
        for j in range(3):
            result[i, j] -= along * n[j]
    return result


@part
def jacobian_at(values: FloatArray, law: Law) -> FloatArray:
    """Return the derivatives of the rates at a node, shape (6, 6)."""
    x, y, vx, vy, r, angle = values[0], values[1], values[2], values[3], values[4], values[5]
    J = np.zeros((6, 6))
    omega, damping = law.omega, law.damping
    wx = x - law.offset
    d = math.sqrt(wx * wx + y * y)
    k = secant(d, law)
    more = (tangent(d, law) - k) / (d * d) if d > 0.0 else 0.0
    # Acceleration of the centre, by x, y and its slip
    J[2, 0] = -k - more * wx * wx + omega * omega
    J[2, 1] = -more * wx * y + damping * omega
    J[3, 0] = -more * wx * y - damping * omega
    J[3, 1] = -k - more * y * y + omega * omega
    J[0, 1], J[1, 0], J[0, 2], J[1, 3], J[5, 4] = -omega, omega, 1.0, 1.0, 1.0 / law.gyration
    J[2, 2] = J[3, 3] = -damping
    J[2, 3], J[3, 2] = omega, -omega
    J[4, 4] = -law.shaft
    bent = friction_derivatives(vx, vy, r, angle, law)
    c, s = math.cos(angle), math.sin(angle)
    ex, ey = c * law.arm_x - s * law.arm_y, s * law.arm_x + c * law.arm_y
    if law.point != CENTRE:
        # The slip of the centre is v − i·r·η.
        for i in range(4):
            by_x, by_y = J[i, 2], J[i, 3]
            J[i, 4] = by_x * ey - by_y * ex
            J[i, 5] = r * (by_x * ex + by_y * ey)
    for i in range(3):
        for j in range(4):
            J[2 + i, 2 + j] += bent[i, j]
    if law.point != CENTRE:
        ar, turn = growth(x, y, vx, vy, r, angle, law)[2], r * (omega + r / law.gyration)
        for j in range(6):
            J[2, j] -= ey * J[4, j]
            J[3, j] += ex * J[4, j]
        more = omega + 2.0 * r / law.gyration
        J[2, 4] -= more * ex
        J[3, 4] -= more * ey
        J[2, 5] += turn * ey - ar * ex
        J[3, 5] -= turn * ex + ar * ey
    return J


@part
def residual_of(values: FloatArray, start: FloatArray, h: float, n: int, law: Law) -> FloatArray:
    """Return the residuals of the first ``n`` unknowns at the nodes, shape (NODES·n,)."""
    rates = rates_at(values, law)
    result = np.empty(NODES * n)
    for i in range(NODES):
        for v in range(n):
            total = 0.0
            for j in range(NODES):
                total += INTEGRAL[i, j] * rates[j, v]
            result[n * i + v] = values[i, v] - start[v] - h * total
    return result


@part
def newton_matrix(values: FloatArray, h: float, n: int, law: Law) -> FloatArray:
    """Return the derivatives of :func:`residual_of`, shape (NODES·n, NODES·n)."""
    matrix = np.zeros((NODES * n, NODES * n))
    for j in range(NODES):
        J = jacobian_at(values[j], law)
        for i in range(NODES):
            factor = -h * INTEGRAL[i, j]
            for v in range(n):
                for w in range(n):
                    matrix[n * i + v, n * j + w] = factor * J[v, w]
        for v in range(n):
            matrix[n * j + v, n * j + v] += 1.0
    return matrix


@part
def solve_linear(matrix: FloatArray, right: FloatArray) -> None:
    """Replace ``right``, shape (n,), by the solution of a system; both are overwritten, and nan if it is singular.

    This is Gauss's elimination with pivots, because rounding by LAPACK differs between libraries.
    """
    n = len(right)
    work = np.empty(n)
    for k in range(n):
        best = k
        for i in range(k + 1, n):
            if abs(matrix[i, k]) > abs(matrix[best, k]):
                best = i
        if best != k:
            for j in range(k, n):
                matrix[k, j], matrix[best, j] = matrix[best, j], matrix[k, j]
            right[k], right[best] = right[best], right[k]
        if matrix[k, k] == 0.0:
            right[:] = math.nan
            return
        for i in range(k + 1, n):
            factor = matrix[i, k] / matrix[k, k]
            if factor != 0.0:
                np.multiply(matrix[k, k + 1 :], factor, work[k + 1 :])
                np.subtract(matrix[i, k + 1 :], work[k + 1 :], matrix[i, k + 1 :])
                right[i] -= factor * right[k]
    for k in range(n - 1, -1, -1):
        total = right[k]
        for j in range(k + 1, n):
            total -= matrix[k, j] * right[j]
        right[k] = total / matrix[k, k]


@part
def solve(start: FloatArray, h: float, guess: FloatArray, law: Law) -> tuple[bool, FloatArray]:
    """Return whether Newton's method converged, and the unknowns at the nodes, shape (NODES, 6)."""
    values, last = guess.copy(), math.inf
    n = 6 if len(law.around) > 0 else (5 if law.outer > 0.0 else 4)
    slip = min(n, 5) if law.point == CENTRE else 4
    for _ in range(MOST_ITERATIONS):
        residual = residual_of(values, start, h, n, law)
        matrix = newton_matrix(values, h, n, law)
        for i in range(NODES * n):
            most = abs(residual[i])
            for j in range(NODES * n):
                most = max(most, abs(matrix[i, j]))
            if not most < math.inf:
                return False, values
            for j in range(NODES * n):
                matrix[i, j] /= most
            residual[i] /= most
        solve_linear(matrix, residual)
        change = residual
        largest = 0.0
        for i in range(NODES):
            s = moved = 0.0
            for v in range(2, slip):
                s += values[i, v] ** 2
                moved += change[n * i + v] ** 2
            s, moved = math.sqrt(s), math.sqrt(moved)
            if not moved < math.inf:
                return False, values
            shrunk = min(1.0, 0.7 * s / moved) if moved > 0.0 else 1.0
            for v in range(n):
                values[i, v] -= (shrunk if 2 <= v < slip else 1.0) * change[n * i + v]
                if not 2 <= v < slip:
                    largest = max(largest, abs(change[n * i + v]) / NEAR)
            largest = max(largest, moved / (CONVERGED * s + 1e-15 * h))
        if largest < 1.0 or (largest < NOISE and largest > 0.5 * last):
            return True, values
        last = largest
    return False, values


@part
def series(start: FloatArray, h: float, values: FloatArray, law: Law) -> FloatArray:
    """Return Legendre coefficients of the unknowns over the step, shape (NODES + 1, 6)."""
    samples = np.empty((NODES + 1, 6))
    for v in range(6):
        samples[0, v] = start[v]
        for i in range(NODES):
            samples[1 + i, v] = values[i, v]
    if len(law.around) == 0:  # the angle follows from r
        for i in range(NODES):
            turned = 0.0
            for j in range(NODES):
                turned += INTEGRAL[i, j] * (law.omega + values[j, 4] / law.gyration)
            samples[1 + i, 5] = start[5] + h * turned
    result = np.zeros((NODES + 1, 6))
    for i in range(NODES + 1):
        for j in range(NODES + 1):
            for v in range(6):
                result[i, v] += FROM_START[i, j] * samples[j, v]
    return result


@part
def at(coefficients: FloatArray, place: float) -> FloatArray:
    """Return the unknowns at ``place``, the share of the step from its start, which may exceed 1."""
    z = 2.0 * place - 1.0
    result: FloatArray = coefficients[0] + z * coefficients[1]
    before, now = 1.0, z
    for n in range(1, NODES):
        before, now = now, ((2 * n + 1) * z * now - n * before) / (n + 1)
        result = result + now * coefficients[n + 1]
    return result


@part
def error_of(coefficients: FloatArray, tolerance: float, law: Law) -> float:
    """Return the size of the last terms in tolerances."""
    end = at(coefficients, 1.0)
    slip = 5 if law.point == CENTRE else 4
    s = 0.0
    for v in range(2, slip):
        s += end[v] ** 2
    s = math.sqrt(s)
    error = 0.0
    for v in range(6 if len(law.around) > 0 else 5):
        scale = tolerance * (1.0 + abs(end[v]) if v < 5 else 1.0) + ROUNDING * abs(end[v])
        if 2 <= v < slip:
            scale = min(tolerance, RELATIVE * s)
        error = max(error, abs(coefficients[NODES, v]) / scale, 0.1 * abs(coefficients[NODES - 1, v]) / scale)
    return error
