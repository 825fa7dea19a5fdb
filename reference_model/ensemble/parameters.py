"""Parameters and starts of trajectories in the form of compiled code."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np

from reference_model.systems import FloatArray, System


class Task(NamedTuple):
    """Trajectories to simulate; each array has a row per trajectory, or one for all.

    ``parameters`` (1 or n, parameters) are in the order of the kernel's PARAMETERS, ``starts`` (1 or n, 4 or 6) in SI
    units, ``paces`` (1 or n, 5) those of starts at checkpoints, and ``durations`` (1 or n,) in s.
    """

    parameters: FloatArray
    starts: FloatArray
    paces: FloatArray
    durations: FloatArray


def parameter_table(
    system: System, names: Sequence[str], varied: Mapping[str, FloatArray] | None = None
) -> FloatArray:
    """Return the named parameters, shape (1 or n, parameters); those ``varied``, (n,), have a row per trajectory."""
    columns = [(varied or {}).get(name, getattr(system, name)) for name in names]
    return np.column_stack(np.broadcast_arrays(*(np.atleast_1d(column) for column in columns))).astype(float)
