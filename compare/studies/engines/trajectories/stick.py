"""Stick phases of a pin: when they begin and end beside the reference's, and release beside (7)."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from compare.claims.claim import Claim, ErrorBudget
from compare.claims.error_estimates import refined
from compare.claims.parameters import parameters_of
from compare.engines import Engine
from compare.studies.engines.trajectories.motions import Motion, by_reference
from reference_model.formulas.pin import release_time
from reference_model.systems import FloatArray, PinOnDisc
from reference_model.trajectory import Trajectory

Run = Callable[[float], Trajectory]
"""Gives the trajectory at ``times_of(motion)`` that an engine finds at a tolerance."""

RESOLUTION = 5e-4
"""In s, so that a millisecond is seen. A law that only approximates stick lets go late, at 1e-9 by some 1e-5 s."""

PHASES = "It sticks and lets go when the reference does: {}"
RELEASE = "What sticks half way through a stick phase is let go when (7) says so: {}"


def stick_claims(engine: Engine, name: str, motion: Motion, run: Run) -> tuple[Claim, ...]:
    """Compare beginnings and ends of all stick phases, and ends with (7) where the reference finds any release."""
    pin, exact = motion.system, by_reference(motion)
    if not isinstance(pin, PinOnDisc):
        return ()
    middles = samples_in_stick(exact)

    def claim(
        sentence: str, trajectory: bool, predicted: FloatArray, found: Callable[[Trajectory], FloatArray]
    ) -> Claim:
        measured, error = refined(lambda tolerance: found(run(tolerance)), motion.tolerance)
        # An error of the state may make the first number of two right by chance; one of the tolerance is in all.
        worst = float(np.max(error)) + motion.tolerance * motion.until
        return Claim(
            sentence.format(name),
            equation="" if trajectory else "(7)",
            kind="trajectory" if trajectory else "formula",
            engine=engine.name,
            predicted=predicted,
            measured=measured,
            budget=ErrorBudget(worst, resolution=RESOLUTION),
            parameters=parameters_of(pin),
            source=motion.source,
            unit="s",
            note=f"Times of all stick phases longer than {RESOLUTION:g} s, beside those of the reference."
            if trajectory
            else "End of each stick phase, less what (7) says for the place in the middle of it.",
        )

    times = stick_times(exact)
    phases = claim(PHASES, True, times, lambda found: _as_many(stick_times(found), times))
    if not middles:
        return (phases,)
    zeros = np.zeros(len(middles))
    return phases, claim(RELEASE, False, zeros, lambda found: late(found, pin, middles))


def samples_in_stick(run: Trajectory) -> list[int]:
    """Return the number of the sample in the middle of each stick phase that ends by release."""
    found = []
    for phase in run.stick_phases:
        inside = np.flatnonzero((run.times > phase.start) & (run.times < phase.end))
        if len(inside) > 0 and phase.end < run.times[-1]:
            found.append(int(inside[len(inside) // 2]))
    return found


def stick_times(run: Trajectory) -> FloatArray:
    """Return beginnings and ends in s of stick phases in their order, but for those shorter than ``RESOLUTION``.

    An engine may take a moment to make up its mind: that it sticks once more for 1e-7 s changes no motion.
    """
    lasting = [phase for phase in run.stick_phases if phase.end - phase.start > RESOLUTION]
    return np.array([time for phase in lasting for time in (phase.start, phase.end)])


def _as_many(found: FloatArray, as_in: FloatArray) -> FloatArray:
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
