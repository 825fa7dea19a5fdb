"""Measurements that several studies make in the same way."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from compare.claims import Measured, Measurement, refined
from compare.engines import Engine
from reference_model.formulas.pin import semicircle_residual
from reference_model.systems import FloatArray, PinOnDisc, System


def compared(predicted: ArrayLike, found: Measurement, **more: Any) -> Measured:
    """Return the numbers of ``found`` for a claim; ``more`` are fields of :class:`Measured`, such as its error."""
    return Measured(predicted=predicted, value=found.value, **{"error": found.error, **more})


def followed(
    engine: Engine, motions: Sequence[tuple[System, ArrayLike, ArrayLike]], tolerance: float, part: Any = ...
) -> Measurement:
    """Return a ``part`` of the states of ``motions`` (system, initial state, times in s) of equal length."""
    return refined(
        lambda asked: [run.states[part] for run in engine.simulate_many(motions, tolerance=asked)], tolerance
    )


def residual_of_4(
    pin: PinOnDisc, places: FloatArray, error: ArrayLike, at: Mapping[str, Sequence[float]]
) -> Measured:
    """Return the residual of (4) at positions of rest, shape (n, 2), with the ``error`` (m) of their distances."""
    x, y = places.T
    # The gradient of (4) is twice the vector from the circle's centre, of length X0 on the circle.
    slope = 2.0 * np.hypot(x - pin.offset / 2.0, y)
    return Measured(
        predicted=np.zeros(len(x)),
        value=semicircle_residual(pin, x, y),
        error=slope * error + np.square(error),
        at=at,
    )
