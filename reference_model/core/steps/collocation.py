"""Radau IIA collocation of order 15 for slip that begins, and for stiff slip.

Hairer and Wanner, Solving Ordinary Differential Equations II, IV.5. A polynomial passes through the start of a step
and solves the equations of motion at eight nodes, the last of them at the end. As functions of time the components of
slip are smooth there, although the direction of slip relaxes fast.
"""

import math

import numpy as np
from numpy.polynomial import legendre
from scipy.special import roots_jacobi

from reference_model.core.forces.law import CENTRE, Law, arm
from reference_model.core.forces.points import centre_slip, turning_of_friction
from reference_model.core.forces.rates import friction, growth, secant, tangent
from reference_model.numerics.parts import part
from reference_model.systems import FloatArray

NODES = 8
POINTS = np.append(roots_jacobi(NODES - 1, 1.0, 0.0)[0], 1.0)
"""Radau nodes in [−1, 1], the last at 1."""

SHARES = 0.5 * (POINTS + 1.0)
"""Radau nodes in [0, 1]."""

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
def put_places(values: FloatArray, start: FloatArray, h: float, law: Law) -> None:
    """Replace the positions and angles at the nodes by the integrals of the slip there.

    In the frame of the master disc, the velocity of the centre is its slip.
    """
    carried = np.empty((NODES, 2))
    for i in range(NODES):
        turned = 0.0
        for j in range(NODES):
            turned += INTEGRAL[i, j] * values[j, 4]
        angle = start[5] + h * (law.omega * SHARES[i] + turned / law.gyration)
        ux, uy = centre_slip(values[i, 2], values[i, 3], values[i, 4], angle, law)
        c, s = math.cos(law.omega * h * SHARES[i]), math.sin(law.omega * h * SHARES[i])
        carried[i, 0], carried[i, 1], values[i, 5] = c * ux + s * uy, c * uy - s * ux, angle
    for i in range(NODES):
        x, y = start[0], start[1]
        for j in range(NODES):
            x += h * INTEGRAL[i, j] * carried[j, 0]
            y += h * INTEGRAL[i, j] * carried[j, 1]
        c, s = math.cos(law.omega * h * SHARES[i]), math.sin(law.omega * h * SHARES[i])
        values[i, 0], values[i, 1] = c * x - s * y, s * x + c * y


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
    """Return the derivatives of the growth of slip and of r at a node by all unknowns, shape (3, 6)."""
    x, y, vx, vy, r, angle = values[0], values[1], values[2], values[3], values[4], values[5]
    J = np.zeros((3, 6))
    omega, damping = law.omega, law.damping
    wx = x - law.offset
    d = math.sqrt(wx * wx + y * y)
    k = secant(d, law)
    more = (tangent(d, law) - k) / (d * d) if d > 0.0 else 0.0
    # Acceleration of the centre, by x, y and its slip
    J[0, 0] = -k - more * wx * wx + omega * omega
    J[0, 1] = -more * wx * y + damping * omega
    J[1, 0] = -more * wx * y - damping * omega
    J[1, 1] = -k - more * y * y + omega * omega
    J[0, 2] = J[1, 3] = -damping
    J[0, 3], J[1, 2] = omega, -omega
    J[2, 4] = -law.shaft
    ex, ey = arm(angle, law)
    if law.point != CENTRE:
        # The slip of the centre is v − i·r·η.
        for i in range(2):
            by_x, by_y = J[i, 2], J[i, 3]
            J[i, 4] = by_x * ey - by_y * ex
            J[i, 5] = r * (by_x * ex + by_y * ey)
    bent = friction_derivatives(vx, vy, r, angle, law)
    for i in range(3):
        for j in range(4):
            J[i, 2 + j] += bent[i, j]
    if law.point != CENTRE:
        ar, turn = growth(x, y, vx, vy, r, angle, law)[2], r * (omega + r / law.gyration)
        for j in range(6):
            J[0, j] -= ey * J[2, j]
            J[1, j] += ex * J[2, j]
        more = omega + 2.0 * r / law.gyration
        J[0, 4] -= more * ex
        J[1, 4] -= more * ey
        J[0, 5] += turn * ey - ar * ex
        J[1, 5] -= turn * ex + ar * ey
    return J


@part
def residual_of(values: FloatArray, start: FloatArray, h: float, n: int, law: Law) -> FloatArray:
    """Return the residuals of the ``n`` components of slip at the nodes, shape (NODES·n,)."""
    grown = np.empty((NODES, 3))
    for j in range(NODES):
        x, y, vx, vy, r = values[j, 0], values[j, 1], values[j, 2], values[j, 3], values[j, 4]
        ax, ay, ar, _, _, _ = growth(x, y, vx, vy, r, values[j, 5], law)
        grown[j, 0], grown[j, 1], grown[j, 2] = ax, ay, ar
    result = np.empty(NODES * n)
    for i in range(NODES):
        for v in range(n):
            total = 0.0
            for j in range(NODES):
                total += INTEGRAL[i, j] * grown[j, v]
            result[n * i + v] = values[i, 2 + v] - start[2 + v] - h * total
    return result


@part
def newton_matrix(values: FloatArray, h: float, n: int, law: Law) -> FloatArray:
    """Return the derivatives of :func:`residual_of` by the slip at the nodes, shape (NODES·n, NODES·n).

    The change of a point's arm with the angle, of the order of h³, is neglected.
    """
    by_slip, rows = np.empty((NODES, NODES * n * n)), np.zeros((NODES, NODES * n * n))
    arms = np.empty((NODES, 2))
    for k in range(NODES):
        arms[k, 0], arms[k, 1] = arm(values[k, 5], law)
    for j in range(NODES):
        J = jacobian_at(values[j], law)
        for k in range(NODES):
            weight, turn = h * INTEGRAL[j, k], law.omega * h * (SHARES[j] - SHARES[k])
            c, s = weight * math.cos(turn), weight * math.sin(turn)
            for v in range(n):
                row = (n * k + v) * n
                x, y = c * J[v, 0] + s * J[v, 1], c * J[v, 1] - s * J[v, 0]
                by_slip[j, row], by_slip[j, row + 1] = x, y
                if n > 2:
                    by_slip[j, row + 2] = x * arms[k, 1] - y * arms[k, 0] + weight / law.gyration * J[v, 5]
                if j == k:
                    for w in range(n):
                        by_slip[j, row + w] += J[v, 2 + w]
    matrix = np.empty((NODES * n, NODES * n))
    for i in range(NODES):
        for j in range(NODES):
            rows[i] -= h * INTEGRAL[i, j] * by_slip[j]
        for k in range(NODES):
            for v in range(n):
                row = (n * k + v) * n
                for w in range(n):
                    matrix[n * i + v, n * k + w] = rows[i, row + w]
    for i in range(NODES * n):
        matrix[i, i] += 1.0
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
    """Return whether Newton's method converged, and the unknowns at the nodes, shape (NODES, 6).

    It needs a ``guess`` of the slip and r, in columns 2 to 4.
    """
    values, last = guess.copy(), math.inf
    n = 3 if len(law.around) > 0 or law.outer > 0.0 else 2
    slip = n if law.point == CENTRE else 2
    put_places(values, start, h, law)
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
            for v in range(slip):
                s += values[i, 2 + v] ** 2
                moved += change[n * i + v] ** 2
            s, moved = math.sqrt(s), math.sqrt(moved)
            if not moved < math.inf:
                return False, values
            shrunk = min(1.0, 0.7 * s / moved) if moved > 0.0 else 1.0
            for v in range(n):
                values[i, 2 + v] -= (shrunk if v < slip else 1.0) * change[n * i + v]
                if v >= slip:
                    largest = max(largest, abs(change[n * i + v]) / NEAR)
            largest = max(largest, moved / (CONVERGED * s + 1e-15 * h))
        put_places(values, start, h, law)
        if largest < 1.0 or (largest < NOISE and largest > 0.5 * last):
            return True, values
        last = largest
    return False, values


@part
def series(start: FloatArray, values: FloatArray) -> FloatArray:
    """Return Legendre coefficients of the unknowns over a step, shape (NODES + 1, 6)."""
    samples = np.empty((NODES + 1, 6))
    for v in range(6):
        samples[0, v] = start[v]
        for i in range(NODES):
            samples[1 + i, v] = values[i, v]
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
