"""Compiled linear algebra for a few unknowns, because NumPy's takes long to compile."""

import math

import numpy as np

from reference_model.ensemble.core.jit import scalar
from reference_model.ensemble.core.stepping.runge_kutta import Tuple
from reference_model.systems import ComplexArray, FloatArray

SQUARINGS = 40
VANISHED, GROWN = 1e-6, 1e6
"""Entries of a power below which it has vanished, and above which it has grown."""


# Array creation for each shape would be compiled separately.


@scalar
def zeros(n: int) -> FloatArray:
    return np.zeros(n)


@scalar
def complex_zeros(n: int) -> ComplexArray:
    return np.zeros(n, dtype=np.complex128)


@scalar
def length_of(vector: FloatArray) -> float:
    total = 0.0
    for value in vector:
        total += value * value
    return math.sqrt(total)


@scalar
def quadratic_form(upper: FloatArray | Tuple, x: Tuple) -> float:
    """Return xᵀAx for a symmetric matrix A, given its upper half row by row."""
    total, k = 0.0, 0
    for i in range(len(x)):
        own, others = upper[k], 0.0
        k += 1
        for j in range(i + 1, len(x)):
            others += upper[k] * x[j]
            k += 1
        total += x[i] * (own * x[i] + 2.0 * others)
    return total


@scalar
def solve(matrix: FloatArray, right: FloatArray) -> bool:
    n = len(right)
    for k in range(n):
        pivot = k
        for i in range(k + 1, n):
            if abs(matrix[i, k]) > abs(matrix[pivot, k]):
                pivot = i
        if not 0.0 < abs(matrix[pivot, k]) < math.inf:
            return False
        for j in range(k, n):
            matrix[k, j], matrix[pivot, j] = matrix[pivot, j], matrix[k, j]
        right[k], right[pivot] = right[pivot], right[k]
        for i in range(k + 1, n):
            factor = matrix[i, k] / matrix[k, k]
            for j in range(k + 1, n):
                matrix[i, j] -= factor * matrix[k, j]
            right[i] -= factor * right[k]
    for k in range(n - 1, -1, -1):
        for j in range(k + 1, n):
            right[k] -= matrix[k, j] * right[j]
        right[k] /= matrix[k, k]
    return True


@scalar
def powers_vanish(matrix: FloatArray) -> bool:
    """Return whether all eigenvalues of a square matrix have a modulus below 1."""
    n = len(matrix)
    power, square = matrix.copy(), zeros(n * n).reshape(n, n)
    for _ in range(SQUARINGS):
        largest = 0.0
        for i in range(n):
            for j in range(n):
                total = 0.0
                for k in range(n):
                    total += power[i, k] * power[k, j]
                square[i, j] = total
                largest = max(largest, abs(total))
        power, square = square, power
        if not VANISHED < largest < GROWN:
            return largest <= VANISHED
    return False
