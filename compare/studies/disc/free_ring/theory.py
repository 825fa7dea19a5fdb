"""Limits of a thrown ring's motion, with the symbols and units of ``toolkit.free_bodies``.

For c = 1, friction's slopes grow logarithmically near the ratio 1: Wδ' = −(2/π)·g·δ·L with L = ln(8/|δ|) − 2, and W =
(2/π)·g·t with the remaining time t. So L = A/t, and |δ| = 8·e^(−2)·exp(−A/t) decays faster than any power.

For c < 1/2 there is no terminal δ*: spinning dies out faster, W/U ~ t^(1/(2c) − 1), because F → 1 and G → W/(2U). For
c > 2 sliding dies out faster, U/W ~ t^(c/2 − 1). At c = 1/2 and c = 2 the ratio converges more slowly than any power.
"""

import cmath
import functools
import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from compare.claims import WORKING, Data
from compare.claims.parameters import FIG8
from compare.engines import Engine
from compare.studies.toolkit.free_bodies import NEAR, Slowing, on_a_table
from compare.studies.toolkit.random_systems import state_of
from reference_model import Trajectory
from reference_model.systems import DiscOnDisc, FloatArray

TABLE = on_a_table(FIG8.mass, 1.0, FIG8.contact_radius, friction=0.1)
"""The ring of Fig. 8 without springs, dampers and shaft on a master disc at rest, J = mR²."""

DECELERATION = TABLE.friction_force / TABLE.mass  # g in m/s²
SPEED = 0.3  # initial √(U² + W²) in m/s, with U of the centre and W of the rim
HEADING = 0.7  # direction of the throw in rad from the x axis


@dataclass(frozen=True)
class Throw:
    """A ring with inertia c = J/(mR²) and the initial atan(W/U) in degrees; a negative value reverses the spin."""

    inertia: float
    degrees: float

    @property
    def disc(self) -> DiscOnDisc:
        """The disc."""
        return on_a_table(TABLE.mass, self.inertia, TABLE.contact_radius, TABLE.friction_force)

    @property
    def sliding(self) -> float:
        """Initial U (m/s)."""
        return 0.0 if abs(self.degrees) == 90.0 else SPEED * math.cos(math.radians(self.degrees))

    @property
    def rim(self) -> float:
        """Initial W (m/s), with the sign of the spin."""
        return SPEED * math.sin(math.radians(self.degrees))

    @property
    def state(self) -> FloatArray:
        """Initial state, shape (6,)."""
        return state_of(0j, cmath.rect(self.sliding, HEADING), spin=self.rim / TABLE.contact_radius)

    @property
    def name(self) -> str:
        """Label with both parameters."""
        return f"J/mR² = {self.inertia:g}, atan(W/U) = {self.degrees:g}°"


DEGREES = (8.0, -33.0, 57.0, -70.0)
RINGS = tuple(Throw(1.0, degrees) for degrees in DEGREES)

OTHERS = tuple(Throw(inertia, degrees) for inertia in (0.7, 1.4) for degrees in (15.0, -75.0))
"""Throws with a terminal ratio other than 1, from both sides."""

INTEGRATED = (*RINGS, *OTHERS)

LOPSIDED = tuple(Throw(inertia, degrees) for inertia in (0.3, 3.0) for degrees in (30.0, 60.0))
"""Throws with J/(mR²) outside the range from 1/2 to 2."""

INTERVALS = 400  # samples until rest

REMAINING, ENDING = np.array([2e-4, 4e-4, 8e-4, 1.6e-3]), np.geomspace(1e-3, 3e-2, 10)
"""Remaining times of samples as shares of the time to rest, also for a power law."""

NEARNESSES = (7.0, 9.0)  # A/t of the samples

TOLERANCE = WORKING / 10
"""For ratios near rest, where less than a thousandth of the initial speed is left."""

SOURCE = "assumption: the ring of Fig. 8 on a table at rest; friction force and starts are our choice"
CITED = "; Farkas et al. 2003, Weidman and Malhotra 2007"

INERTIAS = (0.1, 0.3, 0.45, 0.499, 0.501, 0.55, 0.7, 1.3, 1.7, 1.9, 1.99, 2.01, 2.2, 3.0, 10.0)
"""Values of J/(mR²) inside and outside the range from 1/2 to 2."""


def nearness(delta: ArrayLike) -> FloatArray:
    """Return L = ln(8/|δ|) − 2, which increases as δ tends to zero."""
    with np.errstate(divide="ignore"):  # an engine may reach zero
        return np.asarray(math.log(8.0) - 2.0 - np.log(np.abs(delta)))


def deviation(nearness: ArrayLike) -> FloatArray:
    """Return |δ| at the ``nearness`` L."""
    return np.asarray(8.0 * np.exp(-2.0 - np.asarray(nearness)))


@functools.cache
def expected_approach(throw: Throw, near: float = NEAR) -> float:
    """Return A (s) for a throw with c = 1, evaluated at |δ| = ``near``."""
    left = Slowing(1.0).stop(throw.sliding, abs(throw.rim), near).left
    return float(left * nearness(near)) / DECELERATION


def curves() -> Data:
    inertias = 0.5 * 4.0 ** np.linspace(0.002, 0.998, 101)
    ratios = [math.exp(Slowing(float(inertia)).terminal) for inertia in inertias]
    return {"inertia": inertias, "ratio": np.array(ratios)}


# --- Simulated throws


@functools.cache
def roughly_rest(engine: Engine, throw: Throw) -> float:
    """Return the time (s) of rest in ``engine``, which determines the sample times.

    A smaller tolerance shifts the rest relative to the samples, so the change of a result includes their timing
    error.
    """
    longest = 2.0 * max(1.0, throw.inertia) * SPEED / DECELERATION
    found = rest_of(engine.simulate(throw.disc, throw.state, [0.0, longest], tolerance=TOLERANCE))
    return found if math.isfinite(found) else longest


@functools.cache
def thrown(engine: Engine, throw: Throw, tolerance: float) -> Trajectory:
    rest = roughly_rest(engine, throw)
    shares = 1.0 - np.concatenate((REMAINING, ENDING, [-0.02]))
    approach = approach_times(engine, throw) if throw in RINGS else ()
    times = np.concatenate((uniform_times(engine, throw), rest * shares, approach))
    return engine.simulate(throw.disc, throw.state, np.unique(times), tolerance=tolerance)


def uniform_times(engine: Engine, throw: Throw) -> FloatArray:
    return np.linspace(0.0, roughly_rest(engine, throw), INTERVALS + 1)[:-1]


def approach_times(engine: Engine, throw: Throw) -> FloatArray:
    return roughly_rest(engine, throw) - expected_approach(throw) / np.array(NEARNESSES)


def rest_of(trajectory: Trajectory) -> float:
    """Return the time (s) when the ring comes to rest, NaN if it does not."""
    return trajectory.phases[-1].start if trajectory.phases[-1].kind == "stick" else math.nan


def speeds_at(trajectory: Trajectory, times: ArrayLike) -> tuple[FloatArray, FloatArray]:
    """Return U and W (m/s) at ``times``, which must be times of the trajectory."""
    states = trajectory.states[[int(np.argmin(np.abs(trajectory.times - time))) for time in np.ravel(times)]]
    return np.hypot(states[:, 3], states[:, 4]), TABLE.contact_radius * np.abs(states[:, 5])


def speeds_before_rest(
    engine: Engine, throw: Throw, tolerance: float, left: ArrayLike
) -> tuple[FloatArray, FloatArray]:
    """Return U and W (m/s) when the fractions ``left`` of the time to rest remain; they must be sample times."""
    return speeds_at(thrown(engine, throw, tolerance), roughly_rest(engine, throw) * (1.0 - np.asarray(left)))
