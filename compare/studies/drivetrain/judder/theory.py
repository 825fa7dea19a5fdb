"""Small vibrations of the disc: they are linear, since the moment falls by a straight line."""

from __future__ import annotations

import cmath

import numpy as np

from compare.studies.drivetrain.judder.parameters import (
    COEFFICIENT,
    DAMPING,
    INERTIA,
    LOAD,
    PERTURBED,
    RADIUS,
    STIFFNESS,
)
from reference_model.systems import FloatArray

MOMENT = COEFFICIENT * LOAD * RADIUS
"""Of friction in the steady state, in N m."""


def eigenvalue(gradient: float) -> complex:
    """Return that with the positive imaginary part, in 1/s, where the coefficient falls by ``gradient`` in s/m.

    J·φ̈ + (D − N·R²·gradient)·φ̇ + K·φ = μ₀·N·R: a disc that turns with the drive slips less and has more friction.
    """
    half = (DAMPING - LOAD * RADIUS**2 * gradient) / (2.0 * INERTIA)
    return -half + cmath.sqrt(half**2 - STIFFNESS / INERTIA)


def motion(gradient: float, t: FloatArray) -> FloatArray:
    """Return the disc's angle in rad and speed in rad/s at times in s, shape (n, 2), until its slip ends."""
    root = eigenvalue(gradient)
    # φ = φ₀ + Re(c·e^(λt)) with φ(0) = φ₀ and φ̇(0) given
    wave = -1j * PERTURBED / root.imag * np.exp(root * t)
    return np.column_stack((MOMENT / STIFFNESS + wave.real, (root * wave).real))
