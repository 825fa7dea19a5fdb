"""Remaining transients and eigenvalues of small deviations from a steady motion."""

from collections.abc import Callable, Iterable, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from compare.claims import Measured, answers_of, refined
from compare.claims.linearised_flow import ComplexArray, matched, measured_eigenvalues, real_and_imaginary
from compare.engines import Engine
from reference_model.systems import FloatArray, System

PARTS = ("real part", "imaginary part")


def remaining_transient(earlier: ArrayLike, end: ArrayLike, rate: float, delay: float) -> FloatArray:
    """Return the distance of ``end``, shape (...), from the steady state.

    A final deviation a has changed by a·(exp(r·delay) − 1) in the last ``delay`` s, with the decay ``rate`` r (1/s)
    of the slowest mode. The largest change since ``earlier``, shape (n, ...), which covers one oscillation,
    determines a.
    """
    change = np.max(np.abs(np.asarray(earlier) - np.asarray(end)), axis=0)
    return np.asarray(change / np.expm1(rate * delay))


class Settled(NamedTuple):
    """Final value of a long simulation, its largest numerical error over time and its ``remaining_transient``."""

    value: FloatArray
    error: FloatArray
    left: FloatArray


def settled(
    track: Callable[[list[float], float], ArrayLike],
    *,
    duration: float,
    delay: float,
    period: float,
    rate: float,
    tolerance: float,
) -> Settled:
    """Return the final value of ``track(times, tolerance)``, shape (n, ...), in a simulation of ``duration`` s.

    ``period`` (s) is the period of the transient; ``remaining_transient`` explains ``delay`` and ``rate``.
    """
    times = [0.0, *np.linspace(duration - delay - period, duration - delay, 13), duration]
    found = refined(lambda asked: track(times, asked), tolerance)
    end = found.value[-1]
    return Settled(end, np.max(found.error, axis=0), remaining_transient(found.value[:-1], end, rate, delay))


class Rates(NamedTuple):
    """Eigenvalues (1/s), shape (n, m), of small deviations from n steady motions; the error has the shape (n,)."""

    measured: ComplexArray
    predicted: ComplexArray
    error: FloatArray

    def compared(self, at: dict[str, Any], **more: Any) -> Measured:
        """Return all real and imaginary parts for a claim; ``at`` names the motions."""
        numbers = real_and_imaginary(self.measured)
        return Measured(
            predicted=real_and_imaginary(self.predicted),
            value=numbers,
            error=np.broadcast_to(self.error[:, np.newaxis, np.newaxis], numbers.shape),
            at=at | {"eigenvalue no.": range(1, numbers.shape[1] + 1)},
            components=PARTS,
            **more,
        )

    def decaying(self, but: int = 0, **more: Any) -> Measured:
        """Return whether each deviation decays, except the ``but`` slowest of each motion."""
        real = np.sort(self.measured.real, axis=1)[:, : self.measured.shape[1] - but]
        return answers_of(-real, self.error[:, np.newaxis], **more)


def measured_rates(
    engine: Engine,
    motions: Sequence[tuple[System, ArrayLike]],
    predicted: Iterable[ArrayLike],
    *,
    duration: float,
    frame_speed: float = 0.0,
) -> Rates:
    """Return the rates of ``motions``, systems with states of steady motions; see ``measured_eigenvalues``."""
    found = [
        measured_eigenvalues(engine, system, state, duration=duration, frame_speed=frame_speed)
        for system, state in motions
    ]
    fitting = [matched(values, to=own) for values, (own, _) in zip(predicted, found, strict=True)]
    measured, errors = zip(*found, strict=True)
    return Rates(np.array(measured), np.array(fitting), np.array(errors))
