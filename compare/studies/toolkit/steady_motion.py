"""Steady motions of a disc as fixed points of an engine's own flow: what comes back after a share of a turn.

The centre of a disc in a steady motion rests, or without offset circles at a constant distance from the axis. On a
continuous ring nothing changes in the axes that turn with the centre. On n points there is a ripple besides, which
repeats whenever the disc has turned in these axes by 2π/n. So one search serves both.
"""

from __future__ import annotations

import cmath
import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike
from scipy.optimize import brentq, root

from compare.claims import ROUNDING
from compare.claims.linearised_flow import rotated
from compare.engines import Engine
from reference_model import self_centred_equilibria
from reference_model.contact.contact_law import IsotropicContact
from reference_model.formulas.disc import held_pin, shaft_torque
from reference_model.steady.stability import sliding_jacobian
from reference_model.steady.steady_states import SelfCentredEquilibrium, SpinningEquilibrium, Whirl
from reference_model.systems import ANGLE, DiscOnDisc, FloatArray

CONVERGED = 1e-9
"""Largest relative miss of a motion that comes back."""

SAMPLES = 12
"""Of a motion, for its means."""

SYMMETRY = 6
"""Share of a turn after which a ring, which looks the same at every angle, is looked at."""

Y = 1
"""Place in the state, and in the unknowns: the turn takes it where y = 0."""

TURNING = np.kron(np.eye(2), [[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 0.0]])
"""Rate of change of a state that turns about the axis with 1 rad/s, but for the angle."""


@dataclass(frozen=True, eq=False)
class SteadyMotion:
    """A motion that comes back turned.

    Parameters
    ----------
    states : array of shape (SAMPLES + 1, 6)
        At equal distances in time from the start until it is back, in the axes that turn with the centre.
    period : float
        Time until it is back, in s.
    frequency : float
        Mean angular velocity of the centre about the axis, in rad/s; zero if it rests.
    spin : float
        Mean of the spin in rad/s.

    """

    states: FloatArray
    period: float
    frequency: float
    spin: float

    @property
    def mean(self) -> FloatArray:
        """Mean of x and y in m, in the axes that turn with the centre; of a period the sum is exact to rounding."""
        return np.asarray(self.states[:-1, :2].mean(axis=0))

    @property
    def state(self) -> FloatArray:
        """The state at the start, shape (6,), with the angle zero."""
        return np.asarray(self.states[0])


def steady_motion(
    engine: Engine, disc: DiscOnDisc, guess: ArrayLike, tolerance: float
) -> SteadyMotion | None:
    """Return the steady motion near to ``guess``, found with the engine's own flow; None if there is none.

    Solves for the state and the time T after which it is the same again but for the angle, by which the disc has
    turned. A centre that circles, as it does without offset unless it is on the axis, has turned about the axis by an
    angle θ meanwhile: then y = 0 at the start and θ is sought in its place.

    Parameters
    ----------
    engine : Engine
        The engine.
    disc : DiscOnDisc
        The parameters.
    guess : array of shape (6,)
        A state near to one of the motion; y = 0 if it circles.
    tolerance : float
        Handed to the engine.

    """
    guess = np.asarray(guess, dtype=float)
    circles = disc.offset == 0.0
    frequency = guess[4] / guess[0] if circles else 0.0
    share = math.copysign(_share(disc), guess[-1] - frequency)
    duration = share / (guess[-1] - frequency)
    speed = abs(disc.disc_speed)
    length = abs(disc.offset) or float(np.hypot(*guess[:2]))
    sizes = np.array([length, length, speed * length, speed * length, speed])

    def parts(unknowns: FloatArray) -> tuple[FloatArray, float, float]:
        """Return state, time, and turn about the axis."""
        part, turn = unknowns[:-1] * sizes, 0.0
        if circles:
            part[Y], turn = 0.0, float(unknowns[Y])
        return np.insert(part, ANGLE, 0.0), float(unknowns[-1] * duration), turn

    def miss(unknowns: FloatArray) -> FloatArray:
        if not 0.1 < unknowns[-1] < 10.0:  # Newton's method has lost its way
            return np.full(unknowns.shape, np.nan)
        state, time, turn = parts(unknowns)
        end = engine.simulate(disc, state, [0.0, time], tolerance=tolerance).at_end
        away = rotated(end, -turn) - state
        return np.append(np.delete(away, ANGLE) / sizes, away[ANGLE] - share)

    first = np.append(np.delete(guess, ANGLE) / sizes, 1.0)
    if circles:
        first[Y] = frequency * duration
    # Steps of the square root of the tolerance balance the noise of the flow with its curvature. A tenth of the
    # tolerance is the last step that is worth taking: below it Newton's method takes noise for a wrong derivative.
    found = root(miss, first, method="hybr", options={"eps": tolerance, "xtol": 0.1 * tolerance})
    if not np.max(np.abs(found.fun)) < CONVERGED:
        return None
    state, time, turn = parts(found.x)
    times = np.linspace(0.0, time, SAMPLES + 1)
    states = engine.simulate(disc, state, times, tolerance=tolerance).states
    return SteadyMotion(rotated(states, -turn * times / time), time, turn / time, (share + turn) / time)


def sharpness(disc: DiscOnDisc, motion: SelfCentredEquilibrium | Whirl) -> float:
    """Return by how much an error of the flow is amplified in :func:`steady_motion`.

    With an eigenvalue λ the motion takes up the error 1/|1 − exp(λT)| times in the time T after which it is back.
    """
    frequency, eigenvalues = 0.0, motion.eigenvalues
    if isinstance(motion, Whirl):
        frequency, eigenvalues = motion.frequency, motion.eigenvalues[1:]
    time = _share(disc) / abs(motion.state[-1] - frequency)
    return max(1.0 / abs(1.0 - cmath.exp(value * time)) for value in eigenvalues)


def _share(disc: DiscOnDisc) -> float:
    """Return the angle in rad by which a disc turns until it is back."""
    return 2.0 * math.pi / (disc.contact_points or SYMMETRY)


def mode_growth(
    engine: Engine,
    disc: DiscOnDisc,
    motion: SelfCentredEquilibrium | Whirl,
    displacement: ArrayLike,
    duration: float,
    tolerance: float,
) -> complex:
    """Return growth rate and frequency in 1/s of the slowest mode of small deviations from a steady motion.

    Half the difference of two simulations that start on opposite sides of the motion, in which even powers of the
    deviation drop out. Of all modes in it the left eigenvector sees one, the slowest but a phase that is free.

    Parameters
    ----------
    engine : Engine
        The engine.
    disc : DiscOnDisc
        The parameters, on a continuous ring.
    motion : SpinningEquilibrium or SpinningWhirl
        The steady motion.
    displacement : array of shape (6,)
        From it at the start.
    duration : float
        For which the deviation is followed, in s.
    tolerance : float
        Handed to the engine.

    """
    frequency, eigenvalue = 0.0, motion.eigenvalues[0]
    if isinstance(motion, Whirl):
        frequency, eigenvalue = motion.frequency, motion.eigenvalues[1]
    # Nothing depends on the angle: in this eigenvector it has no part.
    values, left = np.linalg.eig((sliding_jacobian(disc, motion.state) - frequency * TURNING).T)
    slowest = left[:, np.argmin(np.abs(values - eigenvalue))]
    # Two samples a radian: in these axes no slow mode oscillates much faster than with the natural frequency.
    times = np.linspace(0.0, duration, 2 * math.ceil(disc.natural_frequency * duration) + 1)
    outwards, inwards = (
        rotated(
            engine.simulate(
                disc, motion.state + sign * np.asarray(displacement), times, tolerance=tolerance
            ).states,
            -frequency * times,
        )
        for sign in (1.0, -1.0)
    )
    part = (outwards - inwards) @ slowest
    growth, turn = np.log(np.abs(part[[0, -1]])), np.unwrap(np.angle(part))[[0, -1]]
    return complex(growth[1] - growth[0], turn[1] - turn[0]) / duration


# --- The self-centred equilibrium of a disc over the friction force, and where it ends.


def with_load(disc: DiscOnDisc, load: float) -> DiscOnDisc:
    """Return ``disc`` under the friction force μN in N."""
    return replace(disc, friction_force=float(load))


def equilibrium_of(disc: DiscOnDisc, contact: IsotropicContact | None = None) -> SpinningEquilibrium:
    """Return the one self-centred equilibrium of a disc under an isotropic law."""
    (equilibrium,) = self_centred_equilibria(disc, contact)
    return equilibrium


def last_load(disc: DiscOnDisc, contact: IsotropicContact | None = None) -> float:
    """Return the μN in N at which the self-centred equilibrium ends: (5) for a disc.

    From there on friction can give the force C·|X0|, which holds the disc on the axis, beside the moment b|ω − Ω| of
    the shaft. Both lie within the limit surface, which is convex, if C·|X0| + b|ω − Ω|/R <= μN.
    """
    springs, moment = disc.stiffness * abs(disc.offset), shaft_torque(disc) / disc.contact_radius

    def spare(load: float) -> float:
        return held_pin(with_load(disc, load), contact).friction_force - springs

    least = max(springs, moment * (1.0 + ROUNDING))  # what one of the two takes alone
    return float(brentq(spare, least, springs + moment, xtol=ROUNDING * springs, rtol=ROUNDING))
