"""An ensemble of discs: from parameters to results.

What compiled code does not follow, points of contact that come to rest, it hands over: the plain reference takes such
a trajectory on until all of them slip, and gives it back.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from reference_model.ensemble.chunks import in_chunks
from reference_model.ensemble.disc_kernel import (
    HANDED_OVER,
    PARAMETERS,
    STUCK,
    UNDECIDED,
    DiscAims,
    DiscTask,
    run_points,
    run_rings,
)
from reference_model.ensemble.disc_regions import REGION, known_regions
from reference_model.ensemble.results import Ensemble, Results
from reference_model.integrate import simulate
from reference_model.systems import DiscOnDisc, FloatArray

LOCAL = 0.1
"""Tolerance of a step over that of the motion. With 1e-9, of 12,000 trajectories of Figs. 8, 9 and 11 none errs by
more than 5e-8 at t = 100; with twice as much, at a tenth fewer steps, one in 2000 errs by 1e-7."""

MOST_POINTS = 24
"""The sum over points is written out, which takes long to compile for more."""

ROUNDED = 1e-12
"""Share of the duration that is rounding of times."""

LEAST_SPAN = 0.1
"""Turns of the master disc, or of the free centre, that the reference takes a trajectory through at least."""


def simulate_discs(
    disc: DiscOnDisc,
    starts: FloatArray,
    duration: float,
    tolerance: float,
    varied: Mapping[str, FloatArray],
    early_end: bool,
    n: int,
    threads: int,
) -> Ensemble:
    """Do as :func:`reference_model.ensemble.simulate_ensemble` with checked arguments, for ``n`` discs."""
    points = disc.contact_points or 0
    if points > MOST_POINTS:
        raise ValueError(
            f"contact_points = {points}: the compiled ensemble takes up to {MOST_POINTS}; so many are close to the "
            "continuous ring, contact_points = None"
        )
    around = tuple(f(2.0 * math.pi * i / points) for i in range(points) for f in (math.cos, math.sin))
    table = np.empty((n if varied else 1, len(PARAMETERS)))
    for column, name in zip(table.T, PARAMETERS, strict=True):
        column[:] = varied.get(name, getattr(disc, name))
    aims = DiscAims(
        LOCAL * tolerance, early_end, around, known_regions(disc) if not varied else np.zeros((0, REGION))
    )

    def run(task: DiscTask, results: Results) -> None:
        kernel = run_points if points else run_rings
        in_chunks(lambda first, last: kernel(task, aims, results, first, last), len(results.ends), threads)

    results = Results.empty(n, disc.state_size)
    run(DiscTask(table, starts, np.full(1, duration)), results)
    handed = np.flatnonzero(results.ends == HANDED_OVER)
    while handed.size:
        for i in handed:
            one = replace(disc, **{name: float(values[i]) for name, values in varied.items()})  # type: ignore[arg-type]
            _take_on(one, results, int(i), duration, tolerance, early_end)
        handed = handed[results.ends[handed] == HANDED_OVER]
        if handed.size:
            again = Results.empty(len(handed), disc.state_size)
            left = duration - results.times[handed]
            run(DiscTask(table[handed] if varied else table, results.states[handed], left), again)
            again.times[:] += results.times[handed]
            again.steps[:] += results.steps[handed]
            results.ends[handed], results.times[handed] = again.ends, again.times
            results.states[handed], results.measures[handed] = again.states, again.measures
            results.steps[handed] = again.steps
            handed = handed[again.ends == HANDED_OVER]
    at_end = results.times > duration * (1.0 - ROUNDED)
    results.times[at_end] = duration
    return results.ensemble(varied.get("friction_force", disc.friction_force))


def _take_on(
    disc: DiscOnDisc, results: Results, i: int, duration: float, tolerance: float, early_end: bool
) -> None:
    """Take a trajectory on with the plain reference to where all slips again, or to its end.

    A disc that sticks for a turn of the master disc is stuck for ever.
    """
    rates = [rate for rate in (disc.natural_frequency, abs(disc.disc_speed)) if rate > 0.0]
    turn = 2.0 * math.pi / min(rates) if rates else duration
    state, t, span = results.states[i], float(results.times[i]), LEAST_SPAN * turn
    while t < duration:
        end = min(t + span, duration)
        motion = simulate(disc, state, [t, end], tolerance=tolerance)
        results.steps[i] += motion.solution.steps
        state, last = motion.at_end, motion.phases[-1]
        t = duration if duration - end <= ROUNDED * duration else end
        if last.kind == "slip":
            break
        if last.kind == "stick" and end - last.start >= turn:
            radius = math.hypot(*state[:2])
            results.ends[i], results.measures[i] = STUCK, (radius, radius, 0.0)
            if early_end:
                break
            span = duration
        elif last.kind == "stick":
            span = LEAST_SPAN * turn + turn
    if t == duration and results.ends[i] == HANDED_OVER:
        results.ends[i], results.measures[i] = UNDECIDED, math.nan
    results.states[i], results.times[i] = state, t
