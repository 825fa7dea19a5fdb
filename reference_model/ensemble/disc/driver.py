"""Ensembles of discs; single runs follow points that rest until all slip."""

import math
from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from reference_model.ensemble.core.lanes import row_of
from reference_model.ensemble.core.stepping.runge_kutta import tolerance_of_steps
from reference_model.ensemble.disc.kernel import run_points, run_rings
from reference_model.ensemble.disc.lanes import DiscSettings
from reference_model.ensemble.disc.trapping import no_regions, trapping_regions
from reference_model.ensemble.end_states import HANDED_OVER, STUCK, UNDECIDED, Results
from reference_model.ensemble.task import OF_DISC, Task, in_chunks
from reference_model.simulation import simulate
from reference_model.systems import DiscOnDisc, FloatArray
from reference_model.trajectory import Trajectory

FIRST_SPAN = 0.1
"""Duration of the first single run in turns of the master disc or free centre; the next ones are twice as long."""

ROUNDED = 1e-12
"""Rounding error of times, as a share of the duration."""


def simulate_discs(
    disc: DiscOnDisc, task: Task, tolerance: float, early_end: bool, varied: bool, threads: int
) -> Results:
    settings = _settings(disc, tolerance, early_end, no_regions() if varied else trapping_regions(disc))
    return _run_through(disc, task, settings, tolerance, threads)


def _settings(disc: DiscOnDisc, tolerance: float, early_end: bool, regions: NDArray[Any]) -> DiscSettings:
    points = disc.contact_points or 0
    around = tuple(f(2.0 * math.pi * i / points) for i in range(points) for f in (math.cos, math.sin))
    return DiscSettings(tolerance_of_steps(tolerance), early_end, around, regions)


def _run(task: Task, settings: DiscSettings, threads: int) -> Results:
    kernel = run_points if settings.around else run_rings
    results = Results.empty(task.size, DiscOnDisc.state_size)

    def run(stoppable: Task, first: int, last: int) -> None:
        kernel(stoppable, settings, results, first, last)

    in_chunks(run, task, threads)
    return results


def _run_through(
    disc: DiscOnDisc, task: Task, settings: DiscSettings, tolerance: float, threads: int
) -> Results:
    results = _run(task, settings, threads)
    durations = np.broadcast_to(task.durations, results.times.shape)
    handed = np.flatnonzero(results.ends == HANDED_OVER)
    while handed.size:
        for i in handed.tolist():
            parameters: dict[str, Any] = dict(zip(OF_DISC, row_of(task.parameters, i).tolist(), strict=True))
            one = replace(disc, **parameters)
            _continue_until_slip(one, results, i, float(durations[i]), tolerance, settings.early)
        handed = handed[results.ends[handed] == HANDED_OVER]
        if handed.size:
            table = task.parameters[handed] if len(task.parameters) > 1 else task.parameters
            rest = Task(table, results.states[handed], durations[handed] - results.times[handed])
            again = _run(rest, settings, threads)
            again.times[:] += results.times[handed]
            again.steps[:] += results.steps[handed]
            for name, values in again._asdict().items():
                getattr(results, name)[handed] = values
            handed = handed[again.ends == HANDED_OVER]
    at_end = results.times > durations * (1.0 - ROUNDED)
    results.times[at_end] = durations[at_end]
    return results


def _continue_until_slip(
    disc: DiscOnDisc, results: Results, i: int, duration: float, tolerance: float, early_end: bool
) -> None:
    state, t = results.states[i], float(results.times[i])
    for motion, stuck in _through_rest(disc, state, t, duration, tolerance):
        results.steps[i] += motion.solution.steps
        state, t = motion.at_end, float(motion.times[-1])
        if stuck:
            radius = math.hypot(*state[:2])
            results.ends[i], results.measures[i] = STUCK, (radius, radius, 0.0)
            if early_end:
                break
    if t == duration and results.ends[i] == HANDED_OVER:
        results.ends[i], results.measures[i] = UNDECIDED, math.nan
    results.states[i], results.times[i] = state, t


def _through_rest(
    disc: DiscOnDisc, state: FloatArray, t: float, duration: float, tolerance: float
) -> Iterator[tuple[Trajectory, bool]]:
    """Yield the motion from ``state`` at ``t`` by single runs until one ends in slip, or to the end.

    Each part has a flag: stick for a whole turn, which counts as permanent.
    """
    rates = [rate for rate in (disc.natural_frequency, abs(disc.disc_speed)) if rate > 0.0]
    turn = 2.0 * math.pi / min(rates) if rates else duration
    span = FIRST_SPAN * turn
    while t < duration:
        end = t + span if duration - (t + span) > ROUNDED * duration else duration
        motion = simulate(disc, state, [t, end], tolerance=tolerance)
        t, state, last = float(motion.times[-1]), motion.at_end, motion.phases[-1]
        stuck = last.kind == "stick" and last.end - last.start >= turn
        yield motion, stuck
        if last.kind == "slip":
            break
        span = duration if stuck else 2.0 * span
