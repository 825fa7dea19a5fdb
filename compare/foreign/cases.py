"""The motions by which foreign engines are measured: five of a pin and one of a disc on six points."""

from __future__ import annotations

import functools
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from compare.claims.claim import Kind
from compare.claims.error_estimates import TRUTH
from compare.claims.paper_parameters import FIG5, FIG5_STARTS, FIG11
from reference_model import Trajectory, simulate
from reference_model.formulas.pin import whirl_radius
from reference_model.systems import ANGLE, DiscOnDisc, FloatArray, System

Quantity = NDArray[np.complex128]


@dataclass(frozen=True, eq=False)
class Case:
    """A motion, and what of it is compared.

    Parameters
    ----------
    title : str
        In words.
    sentence : str
        What is claimed of it.
    kind : str
        What ``exact`` is taken from, as in ``compare.claims.claim.KINDS``.
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
    resolution : float
        In m: a tenth of what another law of friction, or a pin that lets go, would change of it.
    equation : str
        Of the paper, where ``exact`` is from there.

    """

    title: str
    sentence: str
    kind: Kind
    system: System
    start: tuple[float, ...]
    times: FloatArray
    quantity: Callable[[Trajectory], Quantity]
    exact: Callable[[], Quantity]
    resolution: float
    equation: str = ""


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
_ON_THE_DISC = (0.05, 0.0, 0.0, 0.05 * _CENTRED.disc_speed)
_UNTIL_RELEASE = (-0.022, 0.033, -0.033 * FIG5.disc_speed, -0.022 * FIG5.disc_speed)
_PIN_TIMES = np.linspace(0.0, 100.0, 101)
_STUCK_TIMES = np.linspace(0.0, 20.0, 21)


def _exact_radius() -> Quantity:
    return np.array([whirl_radius(_CENTRED)], dtype=complex)


def _exact_stuck() -> Quantity:
    """Return where a pin is that turns with the disc: nothing of it depends on a law of slip."""
    return np.asarray(_ON_THE_DISC[0] * np.exp(1j * _CENTRED.disc_speed * _STUCK_TIMES))


CASES = {
    "slip": Case(
        title="a pin that slides",
        sentence="A pin that slides follows Coulomb's law",
        kind="trajectory",
        system=FIG5,
        start=_ON_THE_WHIRL,
        times=_PIN_TIMES,
        quantity=_places,
        exact=functools.partial(_exact_places, "slip"),
        resolution=0.025,
    ),
    "stick-slip": Case(
        title="a pin that sticks nine times on its way to the whirl",
        sentence="A pin that sticks nine times follows Coulomb's law",
        kind="trajectory",
        system=FIG5,
        start=FIG5_STARTS["whirl"],
        times=_PIN_TIMES,
        quantity=_places,
        exact=functools.partial(_exact_places, "stick-slip"),
        resolution=0.08,
    ),
    "whirl": Case(
        title="radius of the whirl without an offset, (11)",
        sentence="The whirl's radius is that of (11)",
        kind="formula",
        system=_CENTRED,
        start=_ON_THE_WHIRL,
        times=_PIN_TIMES,
        quantity=_radius,
        exact=_exact_radius,
        resolution=9e-3,
        equation="(11)",
    ),
    "stuck": Case(
        title="a pin that sticks all the time",
        sentence="A pin that sticks turns with the disc",
        kind="formula",
        system=_CENTRED,
        start=_ON_THE_DISC,
        times=_STUCK_TIMES,
        quantity=_places,
        exact=_exact_stuck,
        resolution=5e-3,
        equation="(6)",
    ),
    "release": Case(
        title="a pin that sticks for 1.5 s and lets go",
        sentence="A pin lets go when Coulomb's law says",
        kind="trajectory",
        system=FIG5,
        start=_UNTIL_RELEASE,
        times=np.linspace(0.0, 4.0, 41),
        quantity=_places,
        exact=functools.partial(_exact_places, "release"),
        resolution=3.5e-3,
    ),
    "disc": Case(
        title="a disc on six points",
        sentence="A disc on six points follows Coulomb's law",
        kind="trajectory",
        system=replace(FIG11, contact_points=6),
        start=(0.05, 0.0, 0.0, 0.0, 0.05, 1.3),
        times=np.linspace(0.0, 50.0, 51),
        quantity=_places,
        exact=functools.partial(_exact_places, "disc"),
        resolution=2.5e-3,
    ),
}
"""Of Fig. 5's parameters, and of Fig. 11's; the starts on the disc and on the whirl are ours."""
