"""Trajectories in the form of compiled code, and their distribution to threads."""

from collections.abc import Callable, Mapping, Sequence
from functools import partial
from typing import NamedTuple, TypeVar

import numpy as np
from numpy.typing import NDArray

from reference_model.numerics.threads import Threads
from reference_model.systems import FloatArray, PinOnDisc, System

Value = TypeVar("Value")

CHUNK = 512
"""Number of trajectories that a thread takes at a time: lanes are rarely empty, and threads end together."""

LENGTH, RATE, STEP, SHORT, SPAN = range(5)
"""Indices into the pace of a trajectory. A continuation with this pace takes the original's steps.

It contains the unit of length in m, the inverse unit of time in 1/s, the step, the number of recent short steps, and
the length of an implicit step.
"""

PACE_SIZE = SPAN + 1

ENDLESS = 2**62
"""More rounds than anybody can wait for."""


OF_PIN = ("mass", "stiffness", "damping", "friction_force", "disc_speed", "offset")
OF_DISC = (*OF_PIN, "polar_inertia", "contact_radius", "shaft_damping", "shaft_speed")
"""Parameters in the order of the kernels."""


class Task(NamedTuple):
    """Trajectories to simulate; each array has a row per trajectory, or one for all.

    ``parameters`` are in the order of OF_PIN or OF_DISC, ``starts`` (1 or n, 4 or 6) in SI units, ``durations``
    in s, and ``paces`` (1 or n, 5) those of starts at checkpoints, otherwise zeros. Runs end after ``most_rounds``
    (1,), steps of all lanes, which another thread may set to 0.
    """

    parameters: FloatArray
    starts: FloatArray
    durations: FloatArray
    paces: FloatArray = np.zeros((1, PACE_SIZE))
    most_rounds: NDArray[np.int64] = np.full(1, ENDLESS)

    @property
    def size(self) -> int:
        """Number of trajectories."""
        return max(len(self.parameters), len(self.starts))


def parameter_table(system: System, varied: Mapping[str, FloatArray] | None = None) -> FloatArray:
    """Return the parameters, shape (1 or n, parameters); those ``varied`` (n,) have a row per trajectory."""
    names = OF_PIN if isinstance(system, PinOnDisc) else OF_DISC
    columns = [(varied or {}).get(name, getattr(system, name)) for name in names]
    return np.column_stack(np.broadcast_arrays(*(np.atleast_1d(column) for column in columns))).astype(float)


def in_chunks(run: Callable[..., None], task: Task, threads: int) -> None:
    """Call ``run(task, first, last)``, which must release the interpreter lock, for all trajectories of ``task``.

    If ``threads`` is 0, call it once, in the thread of the caller.
    """
    if threads == 0:
        run(task, 0, task.size)
        return
    firsts = range(0, task.size, CHUNK)
    calls = [partial(run, first=first, last=min(first + CHUNK, task.size)) for first in firsts]
    in_threads(calls, task, min(threads, len(calls)))


def in_threads(calls: Sequence[Callable[[Task], Value]], task: Task, threads: int) -> list[Value]:
    """Return the result of each call with ``task``; an exception such as ``KeyboardInterrupt`` stops all at once."""
    task = task._replace(most_rounds=np.full(1, ENDLESS))
    with Threads(threads) as pool:
        try:
            return [pool.result(one) for one in [pool.submit(call, task) for call in calls]]
        except BaseException:
            task.most_rounds[0] = 0
            raise
