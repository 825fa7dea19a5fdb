"""Friction on a ring of contact as (20) to (22) print it: by quadrature, as a sum of points, by the expansion.

Nothing here uses the closed forms of the reference, so that they can be compared with it. ``slip`` is that of the
disc's centre, u = (ẋ + ωy) + i(ẏ − ωx), and ``rim`` is R·(ω − φ̇), both in m/s. All forces are given as the array
(F_x, F_y, M), the forces per newton of μN and the moment per newton metre of μN·R.
"""

from __future__ import annotations

import functools
import math

import numpy as np
from numpy.typing import ArrayLike

from reference_model.systems import FloatArray

EVEN = 16
"""Angles whose mean is the integral of every trigonometric polynomial up to the order 15."""


def velocities(slip: complex, rim: float, angle: ArrayLike) -> FloatArray:
    """Return ν_rx, ν_ry and ν̃_r of (21) in m/s at the angles φ + χ in rad, shape (3, ...)."""
    s, c = np.sin(angle), np.cos(angle)
    x, y = slip.real + rim * s, slip.imag - rim * c
    return np.stack((x, y, x * s - y * c))


def directions(slip: complex, rim: float, angle: ArrayLike) -> FloatArray:
    """Return −ν_rx/|ν_r|, −ν_ry/|ν_r| and ν̃_r/|ν_r| of (20) at the angles φ + χ in rad, shape (3, ...)."""
    x, y, along = velocities(slip, rim, angle)
    speed = np.hypot(x, y)
    return np.stack((-x, -y, along)) / np.where(speed > 0.0, speed, 1.0)


@functools.cache  # several claims ask for the same ones
def ring_by_quadrature(slip: complex, rim: float) -> tuple[FloatArray, float]:
    """Return the integral (20) by adaptive quadrature, and its error."""
    from scipy.integrate import quad_vec

    # The point that is the nearest to rest is at both ends, so that no range has its kink inside.
    start = math.atan2(slip.imag, slip.real) - math.copysign(0.5 * math.pi, rim)
    value, error = quad_vec(
        lambda angle: directions(slip, rim, angle), start, start + 2.0 * math.pi, epsabs=1e-12, epsrel=0.0
    )
    return np.asarray(value) / (2.0 * math.pi), float(error) / (2.0 * math.pi)


def sum_of_points(slip: complex, rim: float, angle: float, number: int) -> FloatArray:
    """Return the mean over points at φ + 2πi/n in place of the integral (20), φ being ``angle`` in rad."""
    return np.asarray(
        np.mean(directions(slip, rim, angle + 2.0 * math.pi * np.arange(number) / number), axis=1)
    )


def average_of_expansion(slip: complex, rim: float) -> FloatArray:
    """Return the integral (20) with three terms of (22) in place of ν̄_r/|ν_r|, exactly."""
    angle = 2.0 * math.pi * np.arange(EVEN) / EVEN
    x, y, along = velocities(slip, rim, angle)
    mean_square = abs(slip) ** 2 + rim**2
    term = rim * (slip.real * np.sin(angle) - slip.imag * np.cos(angle)) / mean_square
    inverse_speed = (1.0 - term + 1.5 * term**2) / math.sqrt(mean_square)
    return np.asarray(np.mean(inverse_speed * np.stack((-x, -y, along)), axis=1))
