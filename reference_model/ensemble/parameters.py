"""The parameters of trajectories as compiled code takes them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from reference_model.systems import FloatArray, System


def parameter_table(
    system: System, names: Sequence[str], varied: Mapping[str, FloatArray] | None = None
) -> FloatArray:
    """Return the parameters of those names, shape (1 or n, parameters): those ``varied``, (n,), differ by row."""
    columns = [(varied or {}).get(name, getattr(system, name)) for name in names]
    return np.column_stack(np.broadcast_arrays(*(np.atleast_1d(column) for column in columns))).astype(float)
