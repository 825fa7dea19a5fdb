"""Linearised flow of an engine, its eigenvalues from simulations, and their comparison."""

import functools
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from compare.claims.error_estimates import TIGHTEST, refined
from compare.engines import Engine
from reference_model.systems import ANGLE, DiscOnDisc, FloatArray, System

ComplexArray = NDArray[np.complex128]

DIFFERENCE = 4e-3

FLOW_TOLERANCE = 10.0 * TIGHTEST
"""Tolerance of the simulations, small because of their differences."""


def rotated(states: ArrayLike, angle: ArrayLike) -> FloatArray:
    """Return ``states`` (shape (..., 4) of a pin, (..., 6) of a disc) turned about the axis by ``angle`` (rad)."""
    states, angle = np.asarray(states, dtype=float), np.asarray(angle, dtype=float)
    result = np.array(np.broadcast_to(states, np.broadcast_shapes(states.shape, (*angle.shape, 1))))
    half = result.shape[-1] // 2
    for x, y in ((0, 1), (half, half + 1)):
        z = (result[..., x] + 1j * result[..., y]) * np.exp(1j * angle)
        result[..., x], result[..., y] = z.real, z.imag
    if half == ANGLE + 1:
        result[..., ANGLE] += angle
    return result


def _deviations(system: System, state: FloatArray) -> tuple[list[int], FloatArray]:
    """Return the indices of the components that deviate, and their scales, small compared with the slip."""
    half, omega = len(state) // 2, system.disc_speed
    (x, y), (vx, vy) = state[:2], state[half : half + 2]
    slip = np.hypot(vx + omega * y, vy - omega * x)
    moving = [0, 1, half, half + 1]
    if not isinstance(system, DiscOnDisc):
        return moving, np.array([slip / abs(omega)] * 2 + [slip] * 2)
    slip = np.hypot(slip, system.contact_radius * (omega - state[-1]))
    sizes = [slip / abs(omega)] * 2 + [slip] * 2 + [slip / system.contact_radius]
    return [*moving, len(state) - 1], np.array(sizes)


def measured_eigenvalues(
    engine: Engine, system: System, state: ArrayLike, *, duration: float, frame_speed: float = 0.0
) -> tuple[ComplexArray, float]:
    """Return the eigenvalues in 1/s of small deviations from a steady motion, and their error.

    Central differences of the engine's flow over ``duration`` (s), with |Im λ|·duration < π, give the linearised
    flow, whose eigenvalues are exp(λ·duration). Two steps, h and 2h, are extrapolated to h = 0. The error is the
    change with 2h and 4h, plus the estimate of ``refined``, plus the tolerance. The largest error counts for all
    eigenvalues.

    The motion must slide from ``state``, shape (4,) or (6,), and is steady in axes that turn with ``frame_speed``
    (rad/s). A disc has a continuous ring and five eigenvalues, without the eigenvalue of its angle.
    """
    state = np.asarray(state, dtype=float)
    moving, size = _deviations(system, state)

    @functools.cache
    def differences(tolerance: float, step: float) -> FloatArray:
        shifts = [step * width * np.eye(len(state))[i] for i, width in zip(moving, size, strict=True)]
        runs = engine.simulate_many(
            [(system, state + sign * shift, [0.0, duration]) for shift in shifts for sign in (1.0, -1.0)],
            tolerance=tolerance,
        )
        columns = []
        for width, there, back in zip(size, runs[::2], runs[1::2], strict=True):
            change = rotated(there.at_end - back.at_end, -frame_speed * duration) / (2.0 * (step * width))
            columns.append(change[moving])
        return np.column_stack(columns)

    def eigenvalues(tolerance: float, step: float) -> ComplexArray:
        fine, wide = differences(tolerance, step), differences(tolerance, 2.0 * step)
        multipliers = np.linalg.eigvals(fine + (fine - wide) / 3.0).astype(complex)
        return np.asarray(np.log(multipliers) / duration)

    measured = eigenvalues(FLOW_TOLERANCE, DIFFERENCE)
    bent = np.abs(matched(eigenvalues(FLOW_TOLERANCE, 2.0 * DIFFERENCE), measured) - measured)
    _, error = refined(
        lambda tolerance: real_and_imaginary(matched(eigenvalues(tolerance, DIFFERENCE), measured)),
        FLOW_TOLERANCE,
    )
    smallest = float(np.min(DIFFERENCE * size))
    unseen = _unseen(measured, duration, float(np.max(np.abs(state))) / smallest)
    return measured, float(np.max(bent) + np.max(np.hypot(*error.T)) + unseen)


def _unseen(eigenvalues: ComplexArray, duration: float, size: float) -> float:
    """Return the error in 1/s of deviations within the tolerance; ``size`` is the ratio of state and deviation."""
    smallest = float(np.min(np.abs(np.exp(eigenvalues * duration))))
    return FLOW_TOLERANCE * size / (smallest * duration)


def matched(values: ArrayLike, to: ArrayLike) -> ComplexArray:
    """Return complex ``values`` in the order nearest to ``to``, both of shape (n,)."""
    from scipy.optimize import linear_sum_assignment

    values, to = np.asarray(values, dtype=complex), np.asarray(to, dtype=complex)
    distance = np.abs(to[:, np.newaxis] - values)
    _, order = linear_sum_assignment(np.where(np.isfinite(distance), distance, 1e300))
    return np.asarray(values[order])


def real_and_imaginary(values: Any) -> FloatArray:
    """Return complex ``values`` (shape (...)) as real numbers, shape (..., 2)."""
    values = np.asarray(values, dtype=complex)
    return np.stack((values.real, values.imag), axis=-1)


def eigenvalues_with_rounding(matrices: ArrayLike) -> tuple[ComplexArray, FloatArray]:
    """Return the eigenvalues of ``matrices`` (shape (..., n, n)) and the rounding error of each.

    The error is n·ε·‖A‖, as for a backward stable algorithm, times the product of the norms of the right and left
    eigenvectors.
    """
    matrices = np.asarray(matrices, dtype=float)
    values, right = np.linalg.eig(matrices)
    left = np.linalg.inv(right)
    condition = np.linalg.norm(right, axis=-2) * np.linalg.norm(left, axis=-1)
    size = np.linalg.norm(matrices, axis=(-2, -1))[..., np.newaxis]
    return values.astype(complex), np.asarray(matrices.shape[-1] * np.finfo(float).eps * size * condition)
