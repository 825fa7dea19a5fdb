"""What is read off the stick phases of a pin: when they begin and end, and by how much release is late by (7)."""

from __future__ import annotations

import math

import numpy as np

from compare.studies.engines.trajectories.parameters import STICK_RESOLUTION
from reference_model.formulas.pin import release_time
from reference_model.systems import FloatArray, PinOnDisc
from reference_model.trajectory import Trajectory


def samples_in_stick(run: Trajectory) -> list[int]:
    """Return the number of the sample in the middle of each stick phase that ends by release."""
    found = []
    for phase in run.stick_phases:
        inside = np.flatnonzero((run.times > phase.start) & (run.times < phase.end))
        if len(inside) > 0 and phase.end < run.times[-1]:
            found.append(int(inside[len(inside) // 2]))
    return found


def stick_times(run: Trajectory) -> FloatArray:
    """Return beginnings and ends in s of stick phases in order, but for those shorter than ``STICK_RESOLUTION``.

    An engine may take a moment to make up its mind: that it sticks once more for 1e-7 s changes no motion.
    """
    lasting = [phase for phase in run.stick_phases if phase.end - phase.start > STICK_RESOLUTION]
    return np.array([time for phase in lasting for time in (phase.start, phase.end)])


def as_many(found: FloatArray, as_in: FloatArray) -> FloatArray:
    """Return ``found``, or no numbers where there are not as many as in ``as_in``."""
    return found if found.shape == as_in.shape else np.full(as_in.shape, math.nan)


def late(run: Trajectory, pin: PinOnDisc, samples: list[int]) -> FloatArray:
    """Return by how many s each phase outlasts (7), asked at a sample in it; not a number if nothing ends there."""
    result = []
    for i in samples:
        time = float(run.times[i])
        phase = next((one for one in run.stick_phases if one.start <= time <= one.end), None)
        if phase is None:
            result.append(math.nan)
        else:
            x, y = run.states[i, :2]
            rest = release_time(pin, math.hypot(x, y), math.atan2(y, x))
            result.append(phase.end - time - rest if math.isfinite(rest) else math.nan)
    return np.array(result)
