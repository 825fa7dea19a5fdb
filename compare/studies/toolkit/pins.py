"""Stuck pins, and whirls as periodic orbits of an engine."""

from __future__ import annotations

import math

import numpy as np

from compare.engines import Engine
from reference_model import Orbit, whirl_orbit
from reference_model.systems import FloatArray, PinOnDisc
from reference_model.trajectory import Trajectory


def safest_angle(pin: PinOnDisc) -> float:
    """Return the angle (rad) of the smallest holding force (7) on a stuck pin, the phase of (C − mω²) − iβω."""
    return -math.atan2(pin.damping * pin.disc_speed, pin.stiffness - pin.mass * pin.disc_speed**2)


def farthest(pin: PinOnDisc) -> float:
    """Return the largest radius (m) where friction can hold a pin, by (7)."""
    return (pin.friction_force + pin.stiffness * abs(pin.offset)) / abs(
        complex(pin.stiffness - pin.mass * pin.disc_speed**2, pin.damping * pin.disc_speed)
    )


def stuck(pin: PinOnDisc, radius: float, angle: float) -> FloatArray:
    x, y = radius * math.cos(angle), radius * math.sin(angle)
    return np.array([x, y, -pin.disc_speed * y, pin.disc_speed * x])


def first_release(run: Trajectory) -> float:
    """Return the end (s) of the first stick phase: inf if it does not end, NaN if the motion starts with slip."""
    first = run.phases[0]
    if first.kind != "stick":
        return math.nan
    return first.end if len(run.phases) > 1 else math.inf


SAMPLES = 64
"""States per revolution."""


def whirl_of(engine: Engine, pin: PinOnDisc, tolerance: float, guess: Orbit | None = None) -> Orbit:
    return whirl_orbit(
        pin,
        simulate=engine.simulate,
        tolerance=tolerance,
        guess=guess,
        samples=SAMPLES,
        precision=engine.precision,
    )


def extent(orbit: Orbit) -> FloatArray:
    """Return the smallest and largest distance from the axis (m)."""
    radius = orbit.trajectory.radius
    return np.array([np.min(radius), np.max(radius)])
