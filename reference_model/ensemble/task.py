"""Trajectories in the form of compiled code, and their distribution to threads."""

from collections.abc import Callable, Mapping
from concurrent.futures import ThreadPoolExecutor
from typing import NamedTuple

import numpy as np

from reference_model.systems import FloatArray, PinOnDisc, System

CHUNK = 512
"""Number of trajectories that a thread takes at a time: lanes are rarely empty, and threads end together."""

LENGTH, RATE, STEP, SHORT, SPAN = range(5)
"""Indices into the pace of a trajectory. A continuation with this pace takes the original's steps.

It contains the unit of length in m, the inverse unit of time in 1/s, the step, the number of recent short steps, and
the length of an implicit step.
"""

PACE_SIZE = SPAN + 1


OF_PIN = ("mass", "stiffness", "damping", "friction_force", "disc_speed", "offset")
OF_DISC = (*OF_PIN, "polar_inertia", "contact_radius", "shaft_damping", "shaft_speed")
"""Parameters in the order of the kernels."""


class Task(NamedTuple):
    """Trajectories to simulate; each array has a row per trajectory, or one for all.

    ``parameters`` are in the order of OF_PIN or OF_DISC, ``starts`` (1 or n, 4 or 6) in SI units, ``durations``
    in s, and ``paces`` (1 or n, 5) those of starts at checkpoints, otherwise zeros.
    """

    parameters: FloatArray
    starts: FloatArray
    durations: FloatArray
    paces: FloatArray = np.zeros((1, PACE_SIZE))

    @property
    def size(self) -> int:
        """Number of trajectories."""
        return max(len(self.parameters), len(self.starts))


def parameter_table(system: System, varied: Mapping[str, FloatArray] | None = None) -> FloatArray:
    """Return the parameters, shape (1 or n, parameters); those ``varied`` (n,) have a row per trajectory."""
    names = OF_PIN if isinstance(system, PinOnDisc) else OF_DISC
    columns = [(varied or {}).get(name, getattr(system, name)) for name in names]
    return np.column_stack(np.broadcast_arrays(*(np.atleast_1d(column) for column in columns))).astype(float)


def in_chunks(run: Callable[[int, int], None], n: int, threads: int) -> None:
    """Call ``run(first, last)``, which must release the interpreter lock, for all of ``n`` trajectories."""
    firsts = range(0, n, CHUNK)
    if threads == 1:
        for first in firsts:
            run(first, min(first + CHUNK, n))
        return
    with ThreadPoolExecutor(min(threads, len(firsts))) as pool:
        for _ in pool.map(lambda first: run(first, min(first + CHUNK, n)), firsts):
            pass  # raises errors of the thread here
