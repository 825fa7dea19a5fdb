"""Runs a sweep: rounds of chunks, a check by the plain reference, labelled arrays."""

import itertools
from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress

import numpy as np
import xarray as xr

from compare.sweep.arrays import Group, Round
from compare.sweep.compute.executors import Executor, InProcess, Task
from compare.sweep.compute.results import (
    Labelled,
    blocks_of,
    branches_of,
    curves_of,
    label,
    labels_of,
    large_of,
    parts_of,
)
from compare.sweep.compute.work import Plain, recompute, simulate_chunk
from compare.sweep.plan import Continuation, Map, Plan
from compare.sweep.quantities import components
from compare.sweep.refinement import Grid
from compare.sweep.store import SweepStore, flags

CHECKED = 20  # trajectories that the plain reference repeats

CHECK, RESULT, CURVES, BRANCHES = "check", "result", "curves", "branches"

Progress = Callable[[str, int, int], None]  # takes the name of the work, the amount done and the total


def run(store: SweepStore, executor: Executor, progress: Progress) -> None:
    """Compute the parts that ``store`` lacks."""
    rounds, grid = simulated(store, executor, progress)
    if store.get(CHECK) is None:
        store.put(CHECK, _checked(store, rounds, executor, progress))
    for name, dataset in theory_of(store.plan).items():
        if store.get(name) is None:
            store.put(name, dataset())
    if store.get(RESULT) is None:
        _label(store, rounds, grid, executor, progress)


def theory_of(plan: Plan) -> dict[str, Callable[[], xr.Dataset]]:
    """Return the functions that compute the theory of a plan, by the group that stores it."""
    if isinstance(plan, Map):
        return {CURVES: lambda: curves_of(plan)}
    return {BRANCHES: lambda: branches_of(plan)} if isinstance(plan, Continuation) else {}


def finished(store: SweepStore) -> bool:
    """Return whether the sweep is complete; add damaged parts to ``store.broken``."""
    groups = (CHECK, RESULT, *theory_of(store.plan))
    missing = [name for name in groups if store.get(name) is None]
    plan, ends = store.plan.rounds(), None
    with suppress(StopIteration):
        for i in itertools.count():
            found = store.look(i, plan.send(ends))  # type: ignore[arg-type]  # None starts it
            if found is None:
                return False
            _check_chunks(store, i, found, InProcess())
            if not np.all(found.done):
                return False
            ends = found.group.array("end")
    return not missing


def simulated(store: SweepStore, executor: Executor, progress: Progress) -> tuple[list[Round], Grid | None]:
    """Simulate missing trajectories; return all rounds, and the grid of a refined basin."""
    plan = store.plan.rounds()
    rounds: list[Round] = []
    ends = None
    while True:
        try:
            numbers = plan.send(ends)  # type: ignore[arg-type]  # None starts it
        except StopIteration as last:
            return rounds, last.value
        rounds.append(store.round(len(rounds), numbers))
        _check_chunks(store, len(rounds) - 1, rounds[-1], executor)
        _simulate(store, rounds, executor, progress)
        ends = rounds[-1].group.array("end")


def _check_chunks(store: SweepStore, i: int, found: Round, executor: Executor) -> None:
    there = found.there()
    tasks = (Task(chunk, Group.is_whole, (found.group, chunk, found.where(chunk)), True) for chunk in there)
    broken = [chunk for chunk in range(len(found.done)) if chunk not in there] if store.packed else []
    for chunk, whole in executor.run(tasks):
        found.done[chunk] = whole
        if not whole:
            broken.append(chunk)
    store.note_damaged(i, sorted(broken), len(found.done))


def _simulate(store: SweepStore, rounds: Sequence[Round], executor: Executor, progress: Progress) -> None:
    current = rounds[-1]
    what = f"round {len(rounds)}" if len(rounds) > 1 else "trajectories"
    total = len(current.numbers)
    finished = sum(len(current.numbers[current.where(int(chunk))]) for chunk in np.flatnonzero(current.done))
    progress(what, finished, total)

    def tasks() -> Iterator[Task]:
        for chunk in np.flatnonzero(~current.done).tolist():
            where = current.where(chunk)
            numbers = current.numbers[where]
            arguments = (current.group, where, store.plan, numbers, executor.threads, store.stamp)
            yield Task(chunk, simulate_chunk, arguments, True)

    for chunk, count in executor.run(tasks()):
        current.done[chunk] = True
        finished += count
        progress(what, finished, total)


def _label(
    store: SweepStore, rounds: Sequence[Round], grid: Grid | None, executor: Executor, progress: Progress
) -> None:
    plan = store.plan
    group = store.begin(RESULT, large_of(plan))
    blocks = blocks_of(plan)

    def tasks() -> Iterator[Task]:
        for i, block in enumerate(blocks):
            of_grid = None if grid is None else (grid.ends[block.where], grid.simulated[block.where])
            yield Task(i, label, (group, plan, block, parts_of(block, rounds), of_grid), True)

    found: dict[int, Labelled] = {}
    for i, labelled in executor.run(tasks()):
        found[i] = labelled
        progress("labelled results", len(found), len(blocks))
    in_order = [found[i] for i in range(len(blocks))]
    store.end(group, labels_of(plan, in_order, grid))


def _checked(
    store: SweepStore, rounds: Sequence[Round], executor: Executor, progress: Progress
) -> xr.Dataset:
    sizes = [len(one.numbers) for one in rounds]
    count = min(CHECKED, sum(sizes))
    chosen = np.sort(np.random.default_rng(store.plan.seed).choice(sum(sizes), count, replace=False))
    of_round = np.searchsorted(np.cumsum(sizes), chosen, side="right")
    places = chosen - (np.cumsum(sizes) - sizes)[of_round]
    where = [(rounds[i], int(place)) for i, place in zip(of_round, places, strict=True)]
    numbers = [int(one.numbers[place]) for one, place in where]
    time, end, states = (
        [np.asarray(one.group.array(name)[place]) for one, place in where]
        for name in ("time", "end", "states")
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
    meaning = "state at this time minus the state of the plain reference"
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
