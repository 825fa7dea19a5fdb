"""Eq. 12 to 16 over speed and damping, and a deviation that obeys (12)."""

from __future__ import annotations

import functools

import numpy as np
from scipy.linalg import expm

from compare.claims.linearised_flow import eigenvalues_with_rounding, real_and_imaginary
from compare.claims.study import Data
from compare.studies.pin.whirl_stability.parameters import (
    DAMPINGS,
    DEVIATION_TIMES,
    PIN,
    RATIOS,
    K,
    pin_at,
)
from reference_model.formulas.pin import variational_matrix
from reference_model.steady.stability import whirl_eigenvalues
from reference_model.systems import FloatArray, PinOnDisc


def curves() -> Data:
    """Return eigenvalues over the speed and on the grid, and the decaying deviation."""
    speeds = K * (1.0 + np.geomspace(0.01, 6.0, 240))
    return {
        "speed": speeds,
        "eigenvalue": real_and_imaginary([whirl_eigenvalues(pin_at(speed))[1:] for speed in speeds]),
        "ratio": RATIOS,
        "damping": DAMPINGS,
        "largest": largest_real_parts()[0].reshape(len(DAMPINGS), len(RATIOS)) / K,
        "deviation_time": DEVIATION_TIMES,
        "deviation": linear_deviation(DEVIATION_TIMES),
    }


def linear_deviation(times: FloatArray) -> FloatArray:
    """Return ξ/a by (12), shape (n,), from the start ξ = a, ξ̇ = ka, η = 0."""
    start = np.array([1.0, K, 0.0])
    step = expm(variational_matrix(PIN) * (times[1] - times[0]))
    states = [start]
    for _ in times[1:]:
        states.append(step @ states[-1])
    return np.array(states)[:, 0]


@functools.cache
def grid() -> tuple[PinOnDisc, ...]:
    """Return the pins of the grid, damping by damping."""
    return tuple(pin_at(K * ratio, PIN.mass * K * damping) for damping in DAMPINGS for ratio in RATIOS)


@functools.cache
def largest_real_parts() -> tuple[FloatArray, FloatArray]:
    """Return the largest real part in 1/s of the roots of (13) at each point of the grid, and its rounding error."""
    values, rounding = eigenvalues_with_rounding([variational_matrix(pin) for pin in grid()])
    worst = np.argmax(values.real, axis=1)[:, np.newaxis]
    largest, error = (np.take_along_axis(each, worst, axis=1)[:, 0] for each in (values.real, rounding))
    return largest, error
