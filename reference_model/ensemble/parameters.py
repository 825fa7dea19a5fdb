"""Parameters of trajectories in the form of compiled code."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from reference_model.systems import FloatArray, System


def parameter_table(
    system: System, names: Sequence[str], varied: Mapping[str, FloatArray] | None = None
) -> FloatArray:
    """Return the named parameters, shape (1 or n, parameters); those ``varied``, (n,), have a row per trajectory."""
    columns = [(varied or {}).get(name, getattr(system, name)) for name in names]
    return np.column_stack(np.broadcast_arrays(*(np.atleast_1d(column) for column in columns))).astype(float)
