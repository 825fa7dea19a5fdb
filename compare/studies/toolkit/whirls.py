"""The pin's whirl as an engine's own periodic orbit, and what is read off it."""

from __future__ import annotations

import numpy as np

from compare.engines import Engine
from reference_model import Orbit, PinOnDisc, whirl_orbit
from reference_model.systems import FloatArray

SAMPLES = 64
"""States in a turn."""


def whirl_of(engine: Engine, pin: PinOnDisc, tolerance: float, guess: Orbit | None = None) -> Orbit:
    """Return the whirl of ``pin``, found by shooting with ``engine``."""
    return whirl_orbit(
        pin,
        simulate=engine.simulate,
        tolerance=tolerance,
        guess=guess,
        samples=SAMPLES,
        precision=engine.precision,
    )


def extent(orbit: Orbit) -> FloatArray:
    """Return the least and the greatest distance from the axis in m."""
    radius = orbit.trajectory.radius
    return np.array([np.min(radius), np.max(radius)])
