"""Steady motions of a disc as fixed points of an engine's flow over a fraction of a revolution.

The centre rests or, without offset, moves on a circle around the axis. In axes that rotate with it, a disc on a
continuous ring is in equilibrium, and n points add a ripple with a period of 2π/n of the disc's turn.
"""

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
"""Largest relative residual of a fixed point."""

SAMPLES, SYMMETRY = 12, 6
"""Samples for the means of a motion, and divisor of the revolution for a continuous ring, which allows any value."""

Y = 1
"""Index of y in the state and of θ in the unknowns, which replaces y."""

TURNING = np.kron(np.eye(2), [[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 0.0]])
"""Rate of change of a state that rotates about the axis at 1 rad/s, without the disc's angle."""


@dataclass(frozen=True, eq=False)
class SteadyMotion:
    """A motion that repeats after a rotation, with its period in s.

    ``states``, shape (SAMPLES + 1, 6), are equidistant in axes that rotate with the centre. Its ``frequency`` about
    the axis (zero if it rests) and the ``spin`` are means in rad/s.
    """

    states: FloatArray
    period: float
    frequency: float
    spin: float

    @property
    def mean(self) -> FloatArray:
        """Mean of x and y (m) in axes that rotate with the centre."""
        return np.asarray(self.states[:-1, :2].mean(axis=0))

    @property
    def state(self) -> FloatArray:
        """Initial state with angle zero, shape (6,)."""
        return np.asarray(self.states[0])


def steady_motion(
    engine: Engine, disc: DiscOnDisc, guess: ArrayLike, tolerance: float
) -> SteadyMotion | None:
    """Return the steady motion near the state ``guess``, shape (6,); None if the search fails.

    The unknowns are the state and the period T; all but the disc's angle repeats after T. Without offset, the centre
    moves by an angle θ during T, which replaces the unknown y, and y of the ``guess`` must be 0.
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
        part, turn = unknowns[:-1] * sizes, 0.0
        if circles:
            part[Y], turn = 0.0, float(unknowns[Y])
        return np.insert(part, ANGLE, 0.0), float(unknowns[-1] * duration), turn

    def miss(unknowns: FloatArray) -> FloatArray:
        if not 0.1 < unknowns[-1] < 10.0:  # Newton's method diverges
            return np.full(unknowns.shape, np.nan)
        state, time, turn = parts(unknowns)
        end = engine.simulate(disc, state, [0.0, time], tolerance=tolerance).at_end
        away = rotated(end, -turn) - state
        return np.append(np.delete(away, ANGLE) / sizes, away[ANGLE] - share)

    first = np.append(np.delete(guess, ANGLE) / sizes, 1.0)
    if circles:
        first[Y] = frequency * duration
    # Difference steps of √tolerance balance the noise of the flow against its curvature. Iterations stop at a tenth
    # of the tolerance because smaller steps only follow the noise.
    found = root(miss, first, method="hybr", options={"eps": tolerance, "xtol": 0.1 * tolerance})
    if not np.max(np.abs(found.fun)) < CONVERGED:
        return None
    state, time, turn = parts(found.x)
    times = np.linspace(0.0, time, SAMPLES + 1)
    states = engine.simulate(disc, state, times, tolerance=tolerance).states
    return SteadyMotion(rotated(states, -turn * times / time), time, turn / time, (share + turn) / time)


def sharpness(disc: DiscOnDisc, motion: SelfCentredEquilibrium | Whirl) -> float:
    """Return the amplification of an error of the flow in :func:`steady_motion`: the largest 1/|1 − exp(λT)|."""
    frequency, eigenvalues = 0.0, motion.eigenvalues
    if isinstance(motion, Whirl):
        frequency, eigenvalues = motion.frequency, motion.eigenvalues[1:]
    time = _share(disc) / abs(motion.state[-1] - frequency)
    return max(1.0 / abs(1.0 - cmath.exp(value * time)) for value in eigenvalues)


def _share(disc: DiscOnDisc) -> float:
    return 2.0 * math.pi / (disc.contact_points or SYMMETRY)


def mode_growth(
    engine: Engine,
    disc: DiscOnDisc,
    motion: SelfCentredEquilibrium | Whirl,
    displacement: ArrayLike,
    duration: float,
    tolerance: float,
) -> complex:
    """Return growth rate and frequency (1/s) of the slowest mode of small deviations from a steady motion on a ring.

    Two simulations of ``duration`` s start at ± ``displacement``, shape (6,), so even powers cancel. The left
    eigenvector selects the slowest mode other than a free phase.
    """
    frequency, eigenvalue = 0.0, motion.eigenvalues[0]
    if isinstance(motion, Whirl):
        frequency, eigenvalue = motion.frequency, motion.eigenvalues[1]
    # Nothing depends on the angle, so its component of this eigenvector is zero.
    values, left = np.linalg.eig((sliding_jacobian(disc, motion.state) - frequency * TURNING).T)
    slowest = left[:, np.argmin(np.abs(values - eigenvalue))]
    # Two samples per radian: slow modes oscillate at most at about the natural frequency.
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


# --- The self-centred equilibrium and its end


def with_load(disc: DiscOnDisc, load: float) -> DiscOnDisc:
    return replace(disc, friction_force=float(load))


def equilibrium_of(disc: DiscOnDisc, contact: IsotropicContact | None = None) -> SpinningEquilibrium:
    """Return the unique self-centred equilibrium of a disc under an isotropic law."""
    (equilibrium,) = self_centred_equilibria(disc, contact)
    return equilibrium


def last_load(disc: DiscOnDisc, contact: IsotropicContact | None = None) -> float:
    """Return the μN (N) where the self-centred equilibrium ends: (5) for a disc.

    Above it friction can supply both the force C·|X0| that holds the disc on the axis and the moment b|ω − Ω| of the
    shaft. The limit surface is convex and contains both if C·|X0| + b|ω − Ω|/R <= μN.
    """
    springs, moment = disc.stiffness * abs(disc.offset), shaft_torque(disc) / disc.contact_radius

    def spare(load: float) -> float:
        return held_pin(with_load(disc, load), contact).friction_force - springs

    least = max(springs, moment * (1.0 + ROUNDING))  # required by force or moment alone
    return float(brentq(spare, least, springs + moment, xtol=ROUNDING * springs, rtol=ROUNDING))
