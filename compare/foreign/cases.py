"""The motions by which foreign engines are measured: three of a pin and one of a disc on six points."""

from __future__ import annotations

import functools
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from compare.paper import FIG5, FIG5_STARTS, FIG11
from reference_model import Trajectory, simulate
from reference_model.pin_formulas import whirl_radius
from reference_model.systems import ANGLE, DiscOnDisc, FloatArray, System

Quantity = NDArray[np.complex128]

TRUTH = 1e-13
"""Tolerance of the reference where it stands for the exact motion."""


@dataclass(frozen=True, eq=False)
class Case:
    """A motion, and what of it is compared.

    Parameters
    ----------
    title : str
        In words.
    system : PinOnDisc or DiscOnDisc
        The parameters.
    start : tuple of float
        The state at the first of ``times``.
    times : array of shape (n,)
        In s.
    quantity : callable
        Reads what is compared off a trajectory, complex numbers in m.
    exact : callable
        Returns what it should be.

    """

    title: str
    system: System
    start: tuple[float, ...]
    times: FloatArray
    quantity: Callable[[Trajectory], Quantity]
    exact: Callable[[], Quantity]


def _places(trajectory: Trajectory) -> Quantity:
    """Return where the pin is, or the first contact point of a disc, which depends on its angle too."""
    system, states = trajectory.system, trajectory.states
    places = states[:, 0] + 1j * states[:, 1]
    if isinstance(system, DiscOnDisc):
        places = places + system.contact_radius * np.exp(1j * states[:, ANGLE])
    return np.asarray(places)


def _radius(trajectory: Trajectory) -> Quantity:
    """Return the mean distance from the axis in the last fifth of the time."""
    late = trajectory.times >= 0.8 * trajectory.times[-1]
    return np.array([np.mean(np.abs(_places(trajectory)[late]))], dtype=complex)


@functools.cache
def _exact_places(case: str) -> Quantity:
    it = CASES[case]
    return _places(simulate(it.system, it.start, it.times, tolerance=TRUTH))


_CENTRED = replace(FIG5, offset=0.0)
_ON_THE_WHIRL = (0.9, 0.0, 0.0, 0.9)
_PIN_TIMES = np.linspace(0.0, 100.0, 101)


def _exact_radius() -> Quantity:
    return np.array([whirl_radius(_CENTRED)], dtype=complex)


CASES = {
    "slip": Case(
        "a pin that slides",
        FIG5,
        _ON_THE_WHIRL,
        _PIN_TIMES,
        _places,
        functools.partial(_exact_places, "slip"),
    ),
    "stick-slip": Case(
        "a pin that sticks nine times on its way to the whirl",
        FIG5,
        FIG5_STARTS["whirl"],
        _PIN_TIMES,
        _places,
        functools.partial(_exact_places, "stick-slip"),
    ),
    "whirl": Case(
        "radius of the whirl without an offset, (11)",
        _CENTRED,
        _ON_THE_WHIRL,
        _PIN_TIMES,
        _radius,
        _exact_radius,
    ),
    "disc": Case(
        "a disc on six points",
        replace(FIG11, contact_points=6),
        (0.05, 0.0, 0.0, 0.0, 0.05, 1.3),
        np.linspace(0.0, 50.0, 51),
        _places,
        functools.partial(_exact_places, "disc"),
    ),
}
"""Of Fig. 5's parameters, and of Fig. 11's; the sliding starts are ours."""
