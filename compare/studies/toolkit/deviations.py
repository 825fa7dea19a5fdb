"""Small deviations from a steady motion: what is left of them, and the rates at which they develop."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from compare.claims import Measured, answers_of, refined
from compare.claims.linearised_flow import ComplexArray, matched, measured_eigenvalues, real_and_imaginary
from compare.engines import Engine
from reference_model.systems import FloatArray, System

PARTS = ("real part", "imaginary part")


def remaining_transient(earlier: ArrayLike, end: ArrayLike, rate: float, delay: float) -> FloatArray:
    """Return how far ``end`` can still be from the steady state that it decays to.

    A deviation a·exp(−rt) changes by a·(exp(r·delay) − 1) in the last ``delay`` seconds, a being its size at
    the end. So the change that is seen gives what is left.

    Parameters
    ----------
    earlier : array of shape (n, ...)
        The quantity over a period of its oscillation that ends ``delay`` seconds before the end: the largest
        change from there counts.
    end : array of shape (...)
        The quantity at the end.
    rate : float
        Decay rate r in 1/s of the slowest mode.
    delay : float
        In s.

    """
    change = np.max(np.abs(np.asarray(earlier) - np.asarray(end)), axis=0)
    return np.asarray(change / np.expm1(rate * delay))


class Settled(NamedTuple):
    """A quantity at the end of a long simulation; all of its shape.

    Parameters
    ----------
    value : array of shape (...)
        The quantity.
    error : array of shape (...)
        By the tolerance, see ``refined``; the largest of all instants, since one may be right by chance.
    left : array of shape (...)
        What is left of the transient, see ``remaining_transient``.

    """

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
    """Return what a quantity comes to in a simulation of ``duration`` s.

    Parameters
    ----------
    track : callable
        ``track(times, tolerance)``: the quantity at ``times`` but the first, which is 0, of shape (n, ...).
    duration, delay : float
        Length of the simulation, and how long before its end the remaining transient is inferred, in s.
    period : float
        Of the transient's oscillation, in s.
    rate : float
        Decay rate of the slowest mode, in 1/s.
    tolerance : float
        Of the simulation.

    """
    times = [0.0, *np.linspace(duration - delay - period, duration - delay, 13), duration]
    found = refined(lambda asked: track(times, asked), tolerance)
    end = found.value[-1]
    return Settled(end, np.max(found.error, axis=0), remaining_transient(found.value[:-1], end, rate, delay))


class Rates(NamedTuple):
    """Eigenvalues in 1/s of small deviations from n steady motions, those of one in the same order.

    Parameters
    ----------
    measured, predicted : complex array of shape (n, m)
        By simulations of an engine, and by a linearisation.
    error : array of shape (n,)
        Of the measured ones.

    """

    measured: ComplexArray
    predicted: ComplexArray
    error: FloatArray

    def compared(self, at: dict[str, Any], **more: Any) -> Measured:
        """Return all parts of all eigenvalues as a claim compares them; ``at`` names the motions."""
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
        """Return whether each deviation decays, but for the ``but`` slowest of each motion."""
        real = np.sort(self.measured.real, axis=1)[:, : self.measured.shape[1] - but]
        return answers_of(-real, self.error[:, np.newaxis], **more)


def measured_rates(
    engine: Engine,
    motions: Sequence[tuple[System, ArrayLike]],
    predicted: Sequence[ArrayLike],
    *,
    duration: float,
    frame_speed: float = 0.0,
) -> Rates:
    """Return the eigenvalues that simulations of ``duration`` s give beside ``predicted`` ones, shape (m,) each.

    ``motions`` are systems with states of steady motions; the rest is as in ``measured_eigenvalues``.
    """
    found = [
        measured_eigenvalues(engine, system, state, duration=duration, frame_speed=frame_speed)
        for system, state in motions
    ]
    fitting = [matched(values, to=own) for values, (own, _) in zip(predicted, found, strict=True)]
    return Rates(
        np.array([own for own, _ in found]), np.array(fitting), np.array([error for _, error in found])
    )
