"""Measurements that several studies make in the same way."""

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np
from numpy.polynomial import Polynomial
from numpy.typing import ArrayLike

from compare.claims import Measured, Measurement, refined
from compare.engines import Engine
from compare.foreign import Recording
from compare.report.matrix import State
from reference_model.formulas.pin import semicircle_residual
from reference_model.systems import FloatArray, PinOnDisc, System


def recorded_cells(
    recording: Recording, study: str, claims: Sequence[str], words: Callable[[Mapping[str, Any]], str]
) -> tuple[str, ...]:
    """Return the marks of a setting's recorded claims, each with ``words`` about the claim."""
    found = [recording.claims[study].get(f"{study}/{claim}") for claim in claims]
    return tuple(
        f"{State(claim['verdict']).symbol} {words(claim)}" if claim else "not simulated" for claim in found
    )


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


REACH = 4
"""Samples on either side of an extreme in the polynomial that finds it."""


def extremes(values: ArrayLike, *, periodic: bool = False) -> Measurement:
    """Return the smallest and the largest value of a curve between its equidistant samples, and their errors, (2,).

    The curve near an extreme is the polynomial through ``REACH`` samples on either side. The error is the change with
    half as many samples. The first sample of a ``periodic`` curve is also its last sample.
    """
    values = np.asarray(values, dtype=float)
    if periodic:
        values = np.concatenate((values[-2 - REACH : -1], values, values[1 : 2 + REACH]))
    fine, rough = (
        np.array([-_summit(-values, reach), _summit(values, reach)]) for reach in (REACH, REACH // 2)
    )
    return Measurement(fine, np.abs(fine - rough))


def _summit(values: FloatArray, reach: int) -> float:
    """Return the largest value of the polynomials through 2·``reach`` + 1 samples about each maximum."""
    most, rise = np.max(values), np.max(np.abs(np.diff(values, 2)))
    inside = (values >= np.roll(values, 1)) & (values >= np.roll(values, -1))
    inside[[0, -1]] = True
    found = [float(most)]
    # Between samples, a curve rises by about an eighth of its second difference.
    for i in np.flatnonzero(inside & (values >= most - 0.5 * rise)).tolist():
        first = min(max(i - reach, 0), len(values) - 2 * reach - 1)
        places = first - i + np.arange(2 * reach + 1)
        curve = Polynomial.fit(places, values[first : first + len(places)], 2 * reach)
        turning = curve.deriv().roots()
        turning = turning.real[turning.imag == 0.0]
        low, high = max(-1, -i), min(1, len(values) - 1 - i)
        found += curve(turning[(low <= turning) & (turning <= high)]).tolist()
    return max(found)
