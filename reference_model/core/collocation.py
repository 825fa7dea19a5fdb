"""Radau IIA collocation of order 15 for slip that begins, and for stiff slip.

Hairer and Wanner, Solving Ordinary Differential Equations II, IV.5. A polynomial passes through the start of a step
and solves the equations of motion at eight nodes, the last of them at the end. As functions of time the components of
slip are smooth there, although the direction of slip relaxes fast.
"""

import math

import numpy as np

from reference_model.core.forces import Law, friction, pull, secant, tangent
from reference_model.core.parts import part
from reference_model.numerics.collocation import FROM_START, INTEGRAL, NODES, POINTS
from reference_model.systems import FloatArray

DIFFERENCE = 1e-7
"""Change of the direction of slip for numerical derivatives of friction."""

MOST_ITERATIONS = 14

CONVERGED, NEAR = 1e-7, 1e-9
"""Last change of Newton's method, relative in slip and absolute in x and y, after which the next is rounding error."""

NOISE = 10.0
"""Change, in these units, that may be noise if it hardly falls."""


@part
def rates_at(values: FloatArray, law: Law) -> FloatArray:
    """Return the rates of x, y, ux, uy and r in time at the nodes, shape (NODES, 5)."""
    result = np.empty((NODES, 5))
    for i in range(NODES):
        x, y, ux, uy, r = values[i, 0], values[i, 1], values[i, 2], values[i, 3], values[i, 4]
        ax, ay = pull(x, y, ux, uy, law)
        fx, fy, fr = friction(ux, uy, r, law)
        result[i, 0] = ux - law.omega * y
        result[i, 1] = uy + law.omega * x
        result[i, 2] = ax + fx
        result[i, 3] = ay + fy
        result[i, 4] = fr - law.shaft * (r + law.lag)
    return result


@part
def jacobian_at(x: float, y: float, ux: float, uy: float, r: float, law: Law) -> FloatArray:
    """Return the derivatives of the rates, shape (5, 5).

    Those of friction are differences. Friction does not change along the slip, so this derivative is removed.
    """
    J = np.zeros((5, 5))
    omega, damping = law.omega, law.damping
    wx = x - law.offset
    d = math.sqrt(wx * wx + y * y)
    k = secant(d, law)
    more = (tangent(d, law) - k) / (d * d) if d > 0.0 else 0.0
    J[0, 1], J[1, 0], J[0, 2], J[1, 3] = -omega, omega, 1.0, 1.0
    J[2, 0] = -k - more * wx * wx + omega * omega
    J[2, 1] = -more * wx * y + damping * omega
    J[3, 0] = -more * wx * y - damping * omega
    J[3, 1] = -k - more * y * y + omega * omega
    J[2, 2] = J[3, 3] = -damping
    J[2, 3], J[3, 2] = omega, -omega
    J[4, 4] = -law.shaft
    if law.friction > 0.0:
        s = math.sqrt(ux * ux + uy * uy + r * r)
        n = (ux / s, uy / s, r / s)
        at = friction(n[0], n[1], n[2], law)
        found = np.zeros((3, 3))
        for j in range(2 if law.outer == 0.0 else 3):
            h = DIFFERENCE
            moved = friction(
                n[0] + (h if j == 0 else 0.0), n[1] + (h if j == 1 else 0.0), n[2] + (h if j == 2 else 0.0), law
            )
            for i in range(3):
                found[i, j] = (moved[i] - at[i]) / (h * s)
        for i in range(3):
            along = found[i, 0] * n[0] + found[i, 1] * n[1] + found[i, 2] * n[2]
            for j in range(3):
                J[2 + i, 2 + j] += found[i, j] - along * n[j]
    return J


@part
def residual_of(values: FloatArray, start: FloatArray, h: float, n: int, law: Law) -> FloatArray:
    """Return what the first ``n`` unknowns at the nodes lack, shape (NODES·n,)."""
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
        J = jacobian_at(values[j, 0], values[j, 1], values[j, 2], values[j, 3], values[j, 4], law)
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

    By Gauss's elimination with pivots, because LAPACK's rounding differs between libraries.
    """
    n = len(right)
    work = np.empty(n)
    for k in range(n):
        best = k
        for i in range(k + 1, n):
            if abs(matrix[i, k]) > abs(matrix[best, k]):
                best = i
        if best != k:
            work[k:] = matrix[k, k:]
            matrix[k, k:] = matrix[best, k:]
            matrix[best, k:] = work[k:]
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
    """Return whether Newton's method converged, and the unknowns at the nodes, shape (NODES, 5)."""
    values, last = guess.copy(), math.inf
    n = 5 if law.outer > 0.0 else 4
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
            for v in range(2, n):
                s += values[i, v] ** 2
                moved += change[n * i + v] ** 2
            s, moved = math.sqrt(s), math.sqrt(moved)
            if not moved < math.inf:
                return False, values
            shrunk = min(1.0, 0.7 * s / moved) if moved > 0.0 else 1.0
            for v in range(n):
                values[i, v] -= (shrunk if v > 1 else 1.0) * change[n * i + v]
            largest = max(largest, moved / (CONVERGED * s + 1e-15 * h))
            largest = max(largest, abs(change[n * i]) / NEAR, abs(change[n * i + 1]) / NEAR)
        if largest < 1.0 or (largest < NOISE and largest > 0.5 * last):
            return True, values
        last = largest
    return False, values


@part
def series(start: FloatArray, angle: float, h: float, values: FloatArray, law: Law) -> FloatArray:
    """Return Legendre coefficients of x, y, ux, uy, r and the angle over the step, shape (NODES + 1, 6)."""
    samples = np.empty((NODES + 1, 6))
    samples[0, :5], samples[1:, :5] = start, values
    samples[0, 5] = angle
    for i in range(NODES):
        turned = 0.0
        for j in range(NODES):
            turned += INTEGRAL[i, j] * (law.omega + values[j, 4] / law.gyration)
        samples[1 + i, 5] = angle + h * turned
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
    result = coefficients[0] + z * coefficients[1]
    before, now = 1.0, z
    for n in range(1, NODES):
        before, now = now, ((2 * n + 1) * z * now - n * before) / (n + 1)
        result = result + now * coefficients[n + 1]
    return result


@part
def error_of(coefficients: FloatArray, tolerance: float) -> float:
    """Return the size of the last terms in tolerances."""
    end = at(coefficients, 1.0)
    s = math.sqrt(end[2] ** 2 + end[3] ** 2 + end[4] ** 2)
    error = 0.0
    for v in range(5):
        scale = tolerance * (1.0 + abs(end[v])) if v < 2 else min(tolerance, 0.03 * s)
        error = max(error, abs(coefficients[NODES, v]) / scale, 0.1 * abs(coefficients[NODES - 1, v]) / scale)
    return error
