"""Stuck pins, and whirls as periodic orbits of an engine."""

import functools
import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from compare.claims import TRUTH, Measured, Measurement
from compare.engines import Engine, reference
from compare.studies.toolkit.measuring import compared, extremes, followed
from reference_model import Orbit, whirl_orbit
from reference_model.formulas.pin import equilibrium_position
from reference_model.systems import FloatArray, PinOnDisc, System
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


SAMPLES = 128
"""States per revolution."""


def whirl_of(
    engine: Engine, system: System, tolerance: float, guess: Orbit | None = None, **more: Any
) -> Orbit:
    """Return a whirl by shooting with ``engine``; ``more`` are arguments of ``whirl_orbit``."""
    own: dict[str, Any] = {"simulate": engine.simulate, "precision": engine.noise, "samples": SAMPLES}
    return whirl_orbit(system, tolerance=tolerance, guess=guess, **(own | more))


@functools.cache
def exact_whirl(pin: PinOnDisc) -> Orbit:
    """Return a pin's whirl by shooting with the reference at a tolerance of 3e-13."""
    return whirl_of(reference, pin, 3.0 * TRUTH)


def extent(orbit: Orbit) -> Measurement:
    """Return the smallest and largest distance from the axis, and the errors of reading them from samples (m)."""
    return extremes(orbit.trajectory.radius, periodic=True)


SIZES = ("period in s", "smallest radius in m", "largest radius in m")


def sizes_of(orbit: Orbit) -> list[float]:
    """Return the numbers named in ``SIZES``."""
    return [orbit.period, *extent(orbit).value]


BESIDE = 0.005
"""Distance in m of pins from their equilibrium at the start of ``resting``."""


def resting(
    engine: Engine,
    pins: Sequence[PinOnDisc],
    times: FloatArray,
    tolerance: float,
    at: Mapping[str, Sequence[Any]],
    **more: Any,
) -> Measured:
    """Compare pins that start at rest nearby with the equilibrium at ``times`` (s); ``at`` names the pins."""
    places = np.array([equilibrium_position(pin) for pin in pins])
    motions = [
        (pin, (x + BESIDE, y, 0.0, 0.0), [0.0, *times]) for pin, (x, y) in zip(pins, places, strict=True)
    ]
    found = followed(engine, motions, tolerance, np.s_[1:, :2])
    # The slowest deviation decays like exp(−βt/2m).
    left = BESIDE * math.exp(-pins[0].damping / (2.0 * pins[0].mass) * times[0])
    return compared(
        np.repeat(places[:, np.newaxis], len(times), axis=1),
        found,
        error=found.largest + left,
        at={**at, "t in s": times},
        components=("x", "y"),
        **more,
    )
