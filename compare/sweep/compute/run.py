"""A sweep from its plan to its results: rounds of chunks, a random sample by the plain reference, labelled arrays."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from typing import Any

import numpy as np
import xarray as xr

from compare.sweep.compute.executors import Executor, Task
from compare.sweep.compute.results import curves_of, result_of
from compare.sweep.compute.store import Round, SweepStore, flags
from compare.sweep.compute.work import Chunk, Plain, compute, recompute
from compare.sweep.define.plan import Map
from compare.sweep.define.quantities import components

CHECKED = 20
"""Trajectories of a sweep that the plain reference simulates again."""

CHECK, RESULT, CURVES = "check", "result", "curves"
"""Groups of a store besides its rounds."""

Progress = Callable[[str, int, int], None]
"""Takes what is done, how much of it, and how much there is."""


class OtherCodeError(RuntimeError):
    """Workers have another version of the code than this process; the message says so."""


def run(store: SweepStore, executor: Executor, progress: Progress) -> None:
    """Do whatever of the sweep is not in ``store`` yet."""
    rounds, grid = simulated(store, executor, progress)
    if store.get(CHECK) is None:
        store.put(CHECK, _checked(store, rounds, executor, progress))
    if isinstance(store.plan, Map) and store.get(CURVES) is None:
        store.put(CURVES, curves_of(store.plan))
    if store.get(RESULT) is None:
        store.put(RESULT, result_of(store.plan, rounds, grid))


def finished(store: SweepStore) -> bool:
    """Return whether all of the sweep is there as it was written; what is not is in ``store.broken``."""
    groups = (CHECK, RESULT, *((CURVES,) if isinstance(store.plan, Map) else ()))
    missing = [name for name in groups if store.get(name) is None]
    plan, ends = store.plan.rounds(), None
    with suppress(StopIteration):
        for i in itertools.count():
            found = store.look(i, plan.send(ends))  # type: ignore[arg-type]  # None starts it
            if found is None or not np.all(found.done):
                return False
            ends = found.read("end")
    return not missing


def simulated(store: SweepStore, executor: Executor, progress: Progress) -> tuple[list[Round], Any]:
    """Simulate what is missing; return all rounds, and what the plan returns after the last."""
    plan = store.plan.rounds()
    rounds: list[Round] = []
    ends = None
    while True:
        try:
            numbers = plan.send(ends)  # type: ignore[arg-type]  # None starts it
        except StopIteration as last:
            return rounds, last.value
        rounds.append(store.round(len(rounds), numbers))
        _simulate(store, rounds, executor, progress)
        ends = rounds[-1].read("end")


def _simulate(store: SweepStore, rounds: Sequence[Round], executor: Executor, progress: Progress) -> None:
    """Simulate the missing chunks of the last of ``rounds``."""
    current = rounds[-1]
    what = f"round {len(rounds)}" if len(rounds) > 1 else "trajectories"
    total = len(current.numbers)
    finished = sum(len(current.numbers_of(int(chunk))) for chunk in np.flatnonzero(current.done))
    progress(what, finished, total)

    def tasks() -> Iterator[Task]:
        for chunk in np.flatnonzero(~current.done).tolist():
            yield Task(chunk, compute, (store.plan, current.numbers_of(chunk), executor.threads), True)

    for chunk, found in executor.run(tasks()):
        _require_same_code(store, found)
        current.write(chunk, found.results)
        finished += len(current.numbers_of(chunk))
        progress(what, finished, total)


def _require_same_code(store: SweepStore, found: Chunk) -> None:
    if found.stamp != store.stamp:
        raise OtherCodeError(
            f"a worker has other code or libraries ({found.stamp}) than this process ({store.stamp})"
        )


def _checked(
    store: SweepStore, rounds: Sequence[Round], executor: Executor, progress: Progress
) -> xr.Dataset:
    """Return a random sample of the trajectories beside those of the plain reference."""
    sizes = [len(one.numbers) for one in rounds]
    count = min(CHECKED, sum(sizes))
    chosen = np.sort(np.random.default_rng(store.plan.seed).choice(sum(sizes), count, replace=False))
    of_round = np.searchsorted(np.cumsum(sizes), chosen, side="right")
    places = chosen - (np.cumsum(sizes) - sizes)[of_round]
    where = [(rounds[i], int(place)) for i, place in zip(of_round, places, strict=True)]
    numbers = [int(one.numbers[place]) for one, place in where]
    time, end, states = (
        [one.read(name, place) for one, place in where] for name in ("time", "end", "states")
    )
    tasks = [
        Task(i, recompute, (store.plan, numbers[i], float(time[i]), int(end[i])), False) for i in range(count)
    ]
    plain: dict[int, Plain] = {}
    progress("check by the plain reference", 0, count)
    for i, found in executor.run(tasks):
        plain[i] = found
        progress("check by the plain reference", len(plain), count)
    difference = np.array([states[i] - plain[i].state for i in range(count)])
    meaning = "state at that time minus that of the plain reference"
    return xr.Dataset(
        {
            "time": (("trajectory",), np.array(time), {"units": "s"}),
            "end": (("trajectory",), np.array(end), flags("end")),
            "plain_end": (
                ("trajectory",),
                np.array([plain[i].end for i in range(count)], "u1"),
                flags("end"),
            ),
            "difference": (("trajectory", "component"), difference, {"long_name": meaning}),
        },
        coords={"trajectory": numbers, "component": list(components(store.plan.system))},
    )
