"""Given motions, ranges of random motions, and integrals over panels of time.

The paper's m, J and C are all 1, so an engine may confuse them. Here no two parameters are equal, and random
motions cover the whole range.
"""

import functools
import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.polynomial.legendre import leggauss, legvander

from compare.claims import SAFETY, TRUTH, WORKING
from compare.claims.parameters import FIG5, FIG5_STARTS
from reference_model import DiscOnDisc, PinOnDisc, Trajectory, simulate
from reference_model.contact.contact_law import contact_of
from reference_model.formulas.pin import release_time
from reference_model.support import Support
from reference_model.systems import FloatArray, System

PANEL = 0.25
"""Length in s of the integration intervals of forces."""

STICK_RESOLUTION = 5e-4
"""Resolution in s, to detect a millisecond. Approximate laws of stick release about 1e-5 s late at a tolerance of
1e-9.
"""

PIN = PinOnDisc(mass=1.3, stiffness=2.1, damping=0.17, friction_force=0.11, disc_speed=1.9, offset=0.07)

STIFFENING = replace(PIN, hardening=0.4, stop_gap=0.2, stop_stiffness=0.2)

DISC = DiscOnDisc(
    mass=1.3,
    polar_inertia=0.7,
    stiffness=2.1,
    damping=0.4,
    friction_force=0.055,
    disc_speed=1.9,
    offset=0.03,
    contact_radius=0.15,
    shaft_damping=0.02,
    shaft_speed=0.8,
)

SIX = replace(DISC, contact_points=6)

OTHER_WAY = replace(DISC, damping=0.15, disc_speed=-1.9, shaft_speed=-1.6)


@dataclass(frozen=True)
class Motion:
    """A motion to ``until`` (s), with the resolution of its claims in SI units."""

    system: System
    start: tuple[float, ...]
    until: float
    sticks: bool = False
    tolerance: float = WORKING / 10
    resolution: float = 1e-9
    source: str = "no two parameters are equal, and nothing sticks after the start (our choice)"


DISC_START = (0.06, 0.01, 0.2, -0.01, 0.02, 0.9)

PINS = {
    "a pin": Motion(PIN, (0.6, 0.1, -0.2, 0.5), 20.0),
    "a pin inside the play of its stop, with the disc turning the other way": Motion(
        replace(PIN, disc_speed=-PIN.disc_speed, stop_gap=1.0, stop_stiffness=0.2),
        (0.6, 0.1, -0.1, -0.6),
        20.0,
    ),
    "a pin on a support that hardens, beyond its stop": Motion(STIFFENING, (0.6, 0.1, -0.2, 0.5), 20.0),
}

PINS_THAT_STICK = {
    "a pin that sticks on its way": Motion(
        FIG5,
        FIG5_STARTS["whirl"],
        15.0,
        sticks=True,
        tolerance=WORKING,
        resolution=1e-8,
        source="Fig. 5, second start",
    )
}

RINGS = {
    "a disc on the continuous ring": Motion(DISC, DISC_START, 20.0),
    "a disc on the continuous ring, all turning the other way": Motion(
        OTHER_WAY, (0.3, 0.1, 0.3, 0.05, -0.4, -1.7), 20.0
    ),
}

POINTS = {"a disc on six points": Motion(SIX, DISC_START, 20.0)}

MOTIONS = PINS | PINS_THAT_STICK | RINGS | POINTS
"""Only in the pin that sticks does a point of the contact come to rest, where friction has a kink."""

ONE_OF_EACH_KIND = tuple(next(iter(kind.values())) for kind in (PINS, PINS_THAT_STICK, POINTS))
"""Motions for an engine that differs from another engine only in its contact."""

SEED = 8

SPEEDS = ((0.1, 0.3), (0.4, 3.0), (4.1, 6.0))
"""|ω| in rad/s: slow, near the natural frequency, and fast; the other studies use 0.15 to 5."""

UNTIL = 3.0
"""Duration in s."""

LEAST_SLIP = 0.15
"""Smallest ratio of slip to the largest slip, so nothing almost rests where forces are integrated."""

MOST_TURN = 2.0
"""Largest rotation in rad of a disc on points in a ``PANEL``, because its forces turn with it."""

STICKS_FOR = (0.2, 2.0)
"""Duration of the initial stick phase in s."""

MOST_PHASES = 6

LEAST_SAMPLES = 4
"""Fewest samples in a stick phase, so (7) can be evaluated in its middle."""

# --- Motions by the reference, and integrals along them

NODES, WEIGHTS = leggauss(10)
"""Gauss's rule on (−1, 1), exact to rounding for the forces unless a point of the contact comes to rest."""

SLOWEST_FALL = 0.9
"""Largest assumed ratio of neighbouring Legendre coefficients of the integrand."""


def times_of(motion: Motion) -> FloatArray:
    """Return the bounds and Gauss nodes of all panels; each panel begins with its bound."""
    bounds = np.linspace(0.0, motion.until, round(motion.until / PANEL) + 1)
    places = np.concatenate(([0.0], 0.5 + 0.5 * NODES))
    return np.append(bounds[:-1, np.newaxis] + PANEL * places, motion.until)


@functools.cache
def by_reference(motion: Motion) -> Trajectory:
    return simulate(motion.system, motion.start, times_of(motion), tolerance=TRUTH)


def at_bounds(states: FloatArray) -> FloatArray:
    """Return the states at the bounds of the panels, shape (panels + 1, 4 or 6)."""
    return states[:: len(NODES) + 1]


def at_nodes(states: FloatArray) -> FloatArray:
    """Return the states at the nodes, shape (panels, nodes, 4 or 6)."""
    return states[:-1].reshape(-1, len(NODES) + 1, states.shape[1])[:, 1:]


def gauss(rates: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the integrals of ``rates`` (panels, nodes, k) over each panel and their errors, both (panels, k).

    The rule with n nodes misses the Legendre coefficients from 2n on. They are assumed to decay at the mean rate
    between the middle and the last of the first n, times SAFETY for a point of the contact that comes to rest.
    """
    n = len(NODES)
    project = legvander(NODES, n - 1).T * WEIGHTS * (np.arange(n)[:, np.newaxis] + 0.5)
    series = np.einsum("ij,pjk->pik", project, rates)
    middle, last = (np.max(np.abs(series[:, k - 1 : k + 1]), axis=1) for k in (n // 2, n - 1))
    fall = np.divide(last, middle, out=np.zeros_like(last), where=last > 0.0) ** (1.0 / (n - 1 - n // 2))
    fall = np.minimum(fall, SLOWEST_FALL)
    return PANEL * series[:, 0], PANEL * SAFETY * last * fall ** (n + 1.5) / (1.0 - fall)


def forces(body: System, states: FloatArray) -> FloatArray:
    """Return the force (N), and for a disc the moment (N m), in slipping ``states`` of shape (..., 4 or 6)."""
    law, support = contact_of(body), Support.of(body)
    half, omega = body.state_size // 2, body.disc_speed

    def force(state: FloatArray) -> list[float]:
        z, v = complex(*state[:2]), complex(*state[half : half + 2])
        angle, spin = (state[2], state[-1]) if isinstance(body, DiscOnDisc) else (0.0, 0.0)
        share, arm = law.force_and_moment(v - 1j * omega * z, omega - spin, angle)
        w = z - body.offset
        total = body.friction_force * share - body.damping * v - support.secant(abs(w)) * w
        if not isinstance(body, DiscOnDisc):
            return [total.real, total.imag]
        lag = spin - body.shaft_speed
        return [total.real, total.imag, body.friction_force * arm - body.shaft_damping * lag]

    return np.apply_along_axis(force, -1, states)


def samples_in_stick(run: Trajectory) -> list[int]:
    """Return the index of the middle sample of each stick phase that ends by release."""
    found = []
    for phase in run.stick_phases:
        inside = np.flatnonzero((run.times > phase.start) & (run.times < phase.end))
        if len(inside) > 0 and phase.end < run.times[-1]:
            found.append(int(inside[len(inside) // 2]))
    return found


def stick_times(run: Trajectory) -> FloatArray:
    """Return start and end (s) of all stick phases longer than ``STICK_RESOLUTION``.

    Shorter phases, such as 1e-7 s of stick before a release, do not change the motion.
    """
    lasting = [phase for phase in run.stick_phases if phase.end - phase.start > STICK_RESOLUTION]
    return np.array([time for phase in lasting for time in (phase.start, phase.end)])


def as_many(found: FloatArray, as_in: FloatArray) -> FloatArray:
    """Return ``found``, or NaN if its shape differs from the shape of ``as_in``."""
    return found if found.shape == as_in.shape else np.full(as_in.shape, math.nan)


def late(run: Trajectory, pin: PinOnDisc, samples: list[int]) -> FloatArray:
    """Return the delay (s) of the end of each phase after (7) at a sample in it; NaN without such a phase."""
    result = []
    for i in samples:
        time = float(run.times[i])
        phase = next((one for one in run.stick_phases if one.start <= time <= one.end), None)
        if phase is None:
            result.append(math.nan)
        else:
            x, y = run.states[i, :2]
            rest = release_time(pin, math.hypot(x, y), math.atan2(y, x))
            result.append(phase.end - time - rest if math.isfinite(rest) else math.nan)
    return np.array(result)
