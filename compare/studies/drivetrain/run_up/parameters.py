"""The run-up: how the engine pulls, and how the slip of the clutch is held."""

from __future__ import annotations

from typing import TYPE_CHECKING

from compare.studies.toolkit.drivetrain_bench import RPM

if TYPE_CHECKING:
    from exudyn_models import Drivetrain

IDLE, TOP = 800.0, 6000.0
"""In turns a minute."""

TORQUE, RIPPLE = 100.0, 1.0
"""Mean torque of the engine in N m, and what its firing order adds to it, as a part of the mean."""

SLIP, GAIN = 12.0, 0.05
"""Slip to hold in rad/s, and by which part of itself the load grows with each rad/s too much."""

TOLERANCE = 6.4e-6
"""In the units of the state: the balance of energy is known to 2.5e-7 with it, where 1e-6 is asked."""

LINES_APART = 0.06
"""In orders of the engine: what lies between unbalance and whirl at least, above the onset."""

SAMPLE = 5e-4
"""In s: 20 times in a turn at 6000 turns a minute."""

TURNS, SAMPLES = 36, 16
"""Length of a window of the spectrum in turns of the engine, and samples in each turn."""


def duration(car: Drivetrain, top: float) -> float:
    """Return how many s the mean torque takes to bring engine and vehicle from idle to ``top`` (turns a minute)."""
    inertia = car.engine_inertia + car.disc_inertia + car.vehicle_inertia
    return (top - IDLE) * RPM * inertia / TORQUE


def transmitted(car: Drivetrain) -> float:
    """Return what of the mean torque goes through the clutch, in N m."""
    behind = car.disc_inertia + car.vehicle_inertia
    return TORQUE * behind / (car.engine_inertia + behind)
