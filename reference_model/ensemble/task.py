"""Trajectories in the form of compiled code, and their distribution to threads."""

from collections.abc import Callable, Mapping
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from reference_model.numerics.threads import Threads
from reference_model.systems import FloatArray, PinOnDisc, System

CHUNK = 512
"""Number of trajectories that a thread takes at a time: lanes are rarely empty, and threads end together."""

OF_PIN = ("mass", "stiffness", "damping", "friction_force", "disc_speed", "offset")
OF_DISC = (*OF_PIN, "polar_inertia", "contact_radius", "shaft_damping", "shaft_speed")
"""Parameters in the order of the kernels."""

OF_SUPPORT = ("hardening", "stop_gap", "stop_stiffness")
"""Parameters that follow where the support is not linear."""


class Task(NamedTuple):
    """Trajectories to simulate; each array has a row per trajectory, or one for all.

    ``parameters`` are in the order of OF_PIN or OF_DISC, ``starts`` (1 or n, 4 or 6) in SI units, and ``durations``
    in s. Runs end early if another thread sets ``stop`` (1,).
    """

    parameters: FloatArray
    starts: FloatArray
    durations: FloatArray
    stop: NDArray[np.bool_] = np.zeros(1, np.bool_)

    @property
    def size(self) -> int:
        """Number of trajectories."""
        return max(len(self.parameters), len(self.starts))


def parameter_table(
    system: System, varied: Mapping[str, FloatArray] | None = None, more: tuple[str, ...] = ()
) -> FloatArray:
    """Return the parameters, then ``more``, shape (1 or n, parameters); ``varied`` (n,) differ by trajectory."""
    names = (*(OF_PIN if isinstance(system, PinOnDisc) else OF_DISC), *more)
    columns = [(varied or {}).get(name, getattr(system, name)) for name in names]
    return np.column_stack(np.broadcast_arrays(*(np.atleast_1d(column) for column in columns))).astype(float)


def in_chunks(run: Callable[..., None], task: Task, threads: int) -> None:
    """Call ``run(task, first, last)``, which must release the interpreter lock, for all trajectories of ``task``.

    An exception such as ``KeyboardInterrupt`` stops all threads.
    """
    task = task._replace(stop=np.zeros(1, np.bool_))
    firsts = range(0, task.size, CHUNK)
    with Threads(min(threads, len(firsts))) as pool:
        try:
            running = [pool.submit(run, task, first, min(first + CHUNK, task.size)) for first in firsts]
            for one in running:
                pool.result(one)
        except BaseException:
            task.stop[0] = True
            raise
