"""A ring thrown on a table at rest: the limits of its motion, beside the integrals of ``toolkit.free_bodies``.

Near to the ratio 1 of c = 1 the slopes of friction grow like a logarithm: Wδ' = −(2/π)·g·δ·L, L = ln(8/|δ|) − 2, and
W = (2/π)·g·t with the remaining time t, so that L = A/t: |δ| = 8·e^(−2)·exp(−A/t), faster than any power.

There is a δ* for 1/2 < c < 2. For c < 1/2 spinning dies away before sliding, W/U ~ t^(1/(2c) − 1) with the remaining
time t, because F → 1 and G → W/(2U); for c > 2 sliding does, U/W ~ t^(c/2 − 1). At the limits themselves the ratio
goes there too, but more slowly than any power.

Symbols and units are those of ``toolkit.free_bodies``.
"""

from __future__ import annotations

import cmath
import functools
import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from compare.claims import WORKING, Data
from compare.claims.parameters import FIG8
from compare.engines import Engine
from compare.studies.toolkit.free_bodies import NEAR, Slowing
from reference_model import Trajectory
from reference_model.systems import DiscOnDisc, FloatArray

# --- A ring thrown on a table: how it is thrown, and when it is looked at.

TABLE = replace(
    FIG8,
    polar_inertia=FIG8.mass * FIG8.contact_radius**2,
    stiffness=0.0,
    damping=0.0,
    shaft_damping=0.0,
    friction_force=0.1,
    disc_speed=0.0,
    shaft_speed=0.0,
    offset=0.0,
)
"""The ring of Fig. 8 without springs, dampers and shaft on a master disc at rest, J = mR²."""

DECELERATION = TABLE.friction_force / TABLE.mass
"""g of a ring that only slides, in m/s²."""

SPEED = 0.3
"""√(U² + W²) at the start in m/s, U of the centre and W of the rim."""

HEADING = 0.7
"""Direction of the throw in rad from the x axis."""


@dataclass(frozen=True)
class Throw:
    """How a ring is thrown.

    Parameters
    ----------
    inertia : float
        c = J/(mR²).
    degrees : float
        atan(W/U) at the start: 0 only slides, 90 only spins; negative is a spin in the other sense.

    """

    inertia: float
    degrees: float

    @property
    def disc(self) -> DiscOnDisc:
        """The parameters."""
        return replace(TABLE, polar_inertia=self.inertia * TABLE.mass * TABLE.contact_radius**2)

    @property
    def sliding(self) -> float:
        """U at the start in m/s."""
        return 0.0 if abs(self.degrees) == 90.0 else SPEED * math.cos(math.radians(self.degrees))

    @property
    def rim(self) -> float:
        """W at the start in m/s, with its sign."""
        return SPEED * math.sin(math.radians(self.degrees))

    @property
    def state(self) -> FloatArray:
        """The state at the start, shape (6,)."""
        velocity = cmath.rect(self.sliding, HEADING)
        return np.array([0.0, 0.0, 0.0, velocity.real, velocity.imag, self.rim / TABLE.contact_radius])

    @property
    def name(self) -> str:
        """Both parameters in words."""
        return f"J/mR² = {self.inertia:g}, atan(W/U) = {self.degrees:g}°"


DEGREES = (8.0, -33.0, 57.0, -70.0)
RINGS = tuple(Throw(1.0, degrees) for degrees in DEGREES)

OTHERS = tuple(Throw(inertia, degrees) for inertia in (0.7, 1.4) for degrees in (15.0, -75.0))
"""Bodies on a ring of contact with a terminal ratio that is another than 1, from both sides of it."""

INTEGRATED = (*RINGS, *OTHERS)

LOPSIDED = tuple(Throw(inertia, degrees) for inertia in (0.3, 3.0) for degrees in (30.0, 60.0))
"""Beyond the limits of 1/2 and 2."""

INTERVALS = 400
"""Of the time to rest, for the heat and the figure."""

REMAINING = np.array([2e-4, 4e-4, 8e-4, 1.6e-3])
"""Remaining times at which the end is looked at, as fractions of the whole."""

NEARNESSES = (7.0, 9.0)
"""A/t at which the approach to the ratio 1 is looked at."""

ENDING = np.geomspace(1e-3, 3e-2, 10)
"""Remaining times of a power law, as fractions of the whole."""

TOLERANCE = WORKING / 10
"""Ratios at the end are of what is left of a motion, down to a thousandth of it."""

SOURCE = "assumption: the ring of Fig. 8 on a table at rest; friction force and starts are our choice"
CITED = "; Farkas et al. 2003, Weidman and Malhotra 2007"

INERTIAS = (0.1, 0.3, 0.45, 0.499, 0.501, 0.55, 0.7, 1.3, 1.7, 1.9, 1.99, 2.01, 2.2, 3.0, 10.0)
"""J/(mR²) for which it is asked whether there is a terminal ratio."""


def nearness(delta: ArrayLike) -> FloatArray:
    """Return L = ln(8/|δ|) − 2, how near δ has come to zero."""
    with np.errstate(divide="ignore"):  # an engine may reach zero to rounding
        return np.asarray(math.log(8.0) - 2.0 - np.log(np.abs(delta)))


def deviation(nearness: ArrayLike) -> FloatArray:
    """Return |δ| of a ``nearness``."""
    return np.asarray(8.0 * np.exp(-2.0 - np.asarray(nearness)))


def approach_constant(sliding: float, rim: float, near: float = NEAR) -> float:
    """Return A in s of the approach to the ratio 1 for c = 1, from U > 0 and W > 0 in m/s; taken at |δ| = near."""
    return float(Slowing(1.0).stop(sliding, rim, near).left * nearness(near))


@functools.cache
def expected_approach(throw: Throw, near: float = NEAR) -> float:
    """Return A in s."""
    return approach_constant(throw.sliding, abs(throw.rim), near) / DECELERATION


def curves() -> Data:
    """Return the terminal ratio over J/(mR²), between the limits."""
    inertias = 0.5 * 4.0 ** np.linspace(0.002, 0.998, 101)
    ratios = [math.exp(Slowing(float(inertia)).terminal) for inertia in inertias]
    return {"inertia": inertias, "ratio": np.array(ratios)}


# --- The motion of a ring that an engine throws, and what is seen of it.


@functools.cache
def roughly_rest(engine: Engine, throw: Throw) -> float:
    """Return when the ring of ``engine`` rests, in s, which sets the times that the claims sample.

    It is of the claims' own tolerance. A smaller one then moves the rest against these times by about their error,
    so that the change of what a claim measures covers that error.
    """
    longest = 2.0 * max(1.0, throw.inertia) * SPEED / DECELERATION
    found = rest_of(engine.simulate(throw.disc, throw.state, [0.0, longest], tolerance=TOLERANCE))
    return found if math.isfinite(found) else longest


@functools.cache
def thrown(engine: Engine, throw: Throw, tolerance: float) -> Trajectory:
    """Return the motion of a throw, at all times at which it is looked at."""
    rest = roughly_rest(engine, throw)
    times = [
        *uniform_times(engine, throw),
        *(rest * (1.0 - REMAINING)),
        *(rest * (1.0 - ENDING)),
        1.02 * rest,
    ]
    if throw in RINGS:
        times += [*approach_times(engine, throw)]
    return engine.simulate(throw.disc, throw.state, np.unique(times), tolerance=tolerance)


def uniform_times(engine: Engine, throw: Throw) -> FloatArray:
    """Return equally spaced times until the ring rests, in s."""
    return np.linspace(0.0, roughly_rest(engine, throw), INTERVALS + 1)[:-1]


def approach_times(engine: Engine, throw: Throw) -> FloatArray:
    """Return when the remaining time is A over each of the nearnesses, in s."""
    return roughly_rest(engine, throw) - expected_approach(throw) / np.array(NEARNESSES)


def rest_of(trajectory: Trajectory) -> float:
    """Return when the ring comes to rest in s, no number if it does not."""
    return trajectory.phases[-1].start if trajectory.phases[-1].kind == "stick" else math.nan


def speeds_at(trajectory: Trajectory, times: ArrayLike) -> tuple[FloatArray, FloatArray]:
    """Return U and W in m/s at ``times``, which are among those of the trajectory."""
    states = trajectory.states[[int(np.argmin(np.abs(trajectory.times - time))) for time in np.ravel(times)]]
    return np.hypot(states[:, 3], states[:, 4]), TABLE.contact_radius * np.abs(states[:, 5])


def speeds_before_rest(
    engine: Engine, throw: Throw, tolerance: float, left: ArrayLike
) -> tuple[FloatArray, FloatArray]:
    """Return U and W in m/s when fractions ``left`` of the time to rest are left, which are among those looked at."""
    return speeds_at(thrown(engine, throw, tolerance), roughly_rest(engine, throw) * (1.0 - np.asarray(left)))
