"""The pieces of work of a sweep, as functions that another process or machine can import."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from compare.run.stamp import stamp
from compare.sweep.compute.plain import end_of, plain_trajectory, twice_as_long, watched_until
from compare.sweep.define.plan import Numbers, Plan
from compare.sweep.define.quantities import RESULTS
from compare.sweep.store.round import Chunks
from reference_model.ensemble import EndState
from reference_model.systems import FloatArray
from reference_model.trajectory import SimulationError

DOUBLINGS = 3
"""How often the plain reference simulates for twice as long where it has not found the end yet."""


class OtherCodeError(RuntimeError):
    """Workers have another version of the code than who made the store; the message says so."""


@dataclass(frozen=True, eq=False)
class Plain:
    """A trajectory of the plain reference: its state at a time that was asked for, and what it ends as.

    NaN and undecided where it gave up at once.
    """

    state: FloatArray
    end: int


def simulate_chunk(
    chunks: Chunks, chunk: int, plan: Plan, numbers: Numbers, threads: int | None, made_by: str
) -> int:
    """Simulate the trajectories of a chunk and write what they come to; return how many there are.

    Raises :class:`OtherCodeError`, and writes nothing, where the code is not that of the stamp ``made_by``.
    """
    if stamp() != made_by:
        raise OtherCodeError("a worker has other code or libraries than this process")
    chunks.write(chunk, compute(plan, numbers, threads))
    return len(numbers)


def compute(plan: Plan, numbers: Numbers, threads: int | None) -> dict[str, NDArray[Any]]:
    """Simulate the trajectories of these numbers on ``threads`` threads, None for all cores.

    Returns arrays of length n by the names of ``RESULTS``.
    """
    from reference_model.ensemble import simulate_ensemble  # the one place where sweeps meet the kernel

    states, parameters = plan.trajectories(numbers)
    found = simulate_ensemble(
        plan.system,
        states,
        duration=plan.duration,
        tolerance=plan.tolerance,
        parameters=parameters,
        threads=threads,
    )
    return {name: np.asarray(getattr(found, name)) for name in RESULTS}


def recompute(plan: Plan, number: int, time: float, end: int) -> Plain:
    """Simulate one trajectory with the plain reference; ``time`` (s) is when its state is asked for.

    It is watched for as long again as the kernel took to be certain of ``end``. Where it does not end like this, it
    is simulated for longer and longer before that counts: what shall be certain from the motion alone takes more
    time than a kernel may need that knows where motions end. What is undecided is simulated up to ``time`` only.
    """
    states, parameters = plan.trajectories(range(number, number + 1))
    changes: dict[str, Any] = {name: float(values[0]) for name, values in parameters.items()}
    system = replace(plan.system, **changes)
    until = time if end == EndState.UNDECIDED else watched_until(system, time, plan.duration)
    state = np.full(system.state_size, np.nan)
    found = EndState.UNDECIDED
    with suppress(SimulationError):
        trajectory = plain_trajectory(system, states[0], time, until, plan.tolerance)
        state = trajectory.states[np.searchsorted(trajectory.times, time)]
        found = end_of(trajectory)
        for _ in range(DOUBLINGS):
            if end in (found, EndState.UNDECIDED):
                break
            trajectory = twice_as_long(trajectory)
            found = end_of(trajectory)
    return Plain(state, int(found))
