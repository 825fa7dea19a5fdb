"""Tables of all recorded settings: how far off, at what cost, how they were set."""

from __future__ import annotations

import functools
import math
from collections.abc import Callable

import numpy as np

from compare.claims.error_estimates import COARSENING
from compare.claims.prose import Table
from compare.foreign.cases import CASES
from compare.foreign.records import ERROR, SECONDS, STEPS, Recording, estimate
from compare.studies.engines.foreign_engines.ladders import recorded
from compare.studies.engines.foreign_engines.parameters import WANTED
from reference_model.systems import FloatArray


def _finest(runs: FloatArray) -> str:
    """Return in words the error in m of the finest of ``runs``, its estimate and, of several runs, the order."""
    steps, error = runs[:, STEPS], runs[:, ERROR]
    if len(runs) == 1 or not np.all(error[-2:] > 0.0):
        return f"{error[-1]:.1g}"
    order = math.log(error[-2] / error[-1]) / math.log(steps[-1] / steps[-2])
    return f"{error[-1]:.2g} ± {estimate(runs):.1g}, order {order:.1f}"


def time_to(wanted: float, runs: FloatArray) -> str:
    """Return in words the processor time in ms that an error of ``wanted`` takes, between runs by powers of it."""
    good = np.nonzero(runs[:, ERROR] <= wanted)[0]
    if not good.size:
        return "not reached"
    i = int(good[0])
    if i == 0:
        return f"≤ {1e3 * runs[0, SECONDS]:.3g}"
    error, seconds = np.log(runs[i - 1 : i + 1, ERROR]), np.log(runs[i - 1 : i + 1, SECONDS])
    return f"{1e3 * math.exp(np.interp(math.log(wanted), error[::-1], seconds[::-1])):.3g}"


def _of_each_case(recording: Recording, words: Callable[[FloatArray], str]) -> list[str]:
    """Return ``words`` about the runs of each case."""
    return [words(recording.runs[case]) if case in recording.runs else "not simulated" for case in CASES]


def tables() -> tuple[Table, ...]:
    """Return how far each setting is off, what it costs, and how it was set."""
    titles = tuple(case.title for case in CASES.values())
    finest = tuple((recording.name, *_of_each_case(recording, _finest)) for recording in recorded())
    cost = tuple(
        (recording.name, *_of_each_case(recording, functools.partial(time_to, WANTED)))
        for recording in recorded()
    )
    how = tuple(
        (recording.name, recording.version, recording.says, f"{recording.recorded}, {recording.platform}")
        for recording in recorded()
    )
    return (
        Table(
            "How far the finest run of each setting is off the exact motion, in m, the largest difference over time, "
            f"± what its last two refinements, to {COARSENING:g} times less tolerance, changed: from these is the "
            "verdict in the matrix. Orders are in the number of steps, from the last refinement.",
            ("Engine, setting", *titles),
            finest,
        ),
        Table(f"Time in ms of one core to an error of {WANTED:g} m.", ("Engine, setting", *titles), cost),
        Table("How they were set and recorded.", ("Engine, setting", "Version", "Setting", "Recorded"), how),
    )
