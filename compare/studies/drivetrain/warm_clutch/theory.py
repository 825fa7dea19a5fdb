"""Slip and temperature in closed form, where μ = μ₀·(1 − k·(T − T₀))."""

from __future__ import annotations

import math

import numpy as np

from compare.studies.drivetrain.warm_clutch.parameters import (
    CAPACITY,
    COEFFICIENT,
    CONDUCTANCE,
    FADE,
    INERTIAS,
    LOAD,
    RADIUS,
    SLIP,
    SLOW_SLIP,
    SURROUNDINGS,
)
from reference_model.systems import FloatArray

MOMENT = COEFFICIENT * LOAD * RADIUS
"""Of cold friction in N m."""

REDUCED = INERTIAS[0] * INERTIAS[1] / (INERTIAS[0] + INERTIAS[1])
"""The inertia in kg m² that slip sees."""

HEAT = 0.5 * REDUCED * SLIP**2
"""What becomes of the slip in J."""


def slip(times: FloatArray) -> FloatArray:
    """Return the slip of the engaged clutch in rad/s while it slips.

    Without loss C·(T − T₀) is what has gone of ½·J·S², so that J·dS/dt = −M·(b + c·S²), with c = k·J/(2C) and
    b = 1 − c·S₀²: a tangent solves that.
    """
    c = FADE * REDUCED / (2.0 * CAPACITY)
    b = 1.0 - c * SLIP**2
    phase = math.atan(SLIP * math.sqrt(c / b)) - MOMENT / REDUCED * math.sqrt(b * c) * times
    return math.sqrt(b / c) * np.tan(phase)


def warmed(slip: FloatArray) -> FloatArray:
    """Return the temperature in °C of the engaged clutch at a slip in rad/s."""
    return SURROUNDINGS + (HEAT - 0.5 * REDUCED * slip**2) / CAPACITY


def held(times: FloatArray) -> FloatArray:
    """Return the temperature in °C of the clutch that slips on: exponentially towards where heat and loss agree."""
    power = MOMENT * SLOW_SLIP
    rate = CONDUCTANCE + FADE * power
    return SURROUNDINGS + power / rate * (1.0 - np.exp(-rate / CAPACITY * times))


def slipping_time(end: float, fade: float = FADE) -> float:
    """Return when the slip has come down to ``end`` (rad/s) in s, if friction fades by ``fade`` > 0 in 1/K."""
    c = fade * REDUCED / (2.0 * CAPACITY)
    b = 1.0 - c * SLIP**2
    turned = math.atan(SLIP * math.sqrt(c / b)) - math.atan(end * math.sqrt(c / b))
    return turned * REDUCED / (MOMENT * math.sqrt(b * c))


def cold_slipping_time(end: float) -> float:
    """Return the same of friction that doesn't fade."""
    return (SLIP - end) * REDUCED / MOMENT
