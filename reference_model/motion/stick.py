"""Stick phases (eq. 6 to 9): the required friction, the time of release, and the start of slip.

In stick w = 0: the pin turns with the disc, z(t) = z₀·exp(iωt), and friction balances the pull a(z, 0). A friction
disc sticks only as a whole, so its centre is a stuck pin with reduced friction.
"""

import cmath
import math
from dataclasses import dataclass, replace

import numpy as np
from scipy.optimize import brentq

from reference_model.contact.contact_law import IsotropicContact
from reference_model.motion.disc_equations import DiscMotion
from reference_model.motion.pin_equations import SlipMotion
from reference_model.systems import ComplexArray, FloatArray

GRAZING = 1e-8
"""Relative excess of the pull above friction that does not count as a release.

An excess δ moves the pin by about g·δ²/ω², below rounding.
"""

NARROW = 1e-5
"""Smallest angle in rad that the search for the first release resolves.

A pin released over a smaller angle moves by about NARROW³ of its path.
"""

ROUNDING = 1e-12
"""Angle in rad within which a pin counts as being at the friction limit."""


def can_hold(motion: SlipMotion, z: complex) -> bool:
    """Return whether friction can hold a pin at rest at ``z`` (eq. 6)."""
    return abs(motion.pull(z, 0.0)) <= motion.friction


def release_delay(motion: SlipMotion, z: complex) -> float:
    """Return how long a pin held at ``z`` sticks, in s; inf for permanent stick.

    Eq. 7 with equality is |p + q·exp(iωt)| = g with the constant pull p = k²X₀ of the offset and the turning pull q
    of the position. On a linear support its first upward crossing has a closed form.
    """
    if not motion.support.linear:
        return _first_release(motion, z)
    constant = motion.support.stiffness * motion.support.offset
    turning = motion.pull(z, 0.0) - constant
    p, q, g = abs(constant), abs(turning), motion.friction
    if motion.disc_speed == 0.0 or p + q <= g * (1.0 + GRAZING):
        return math.inf
    # Angle between the two pulls, in its direction of growth; friction holds outside ± limit. The half-angle form is
    # accurate where an arccos would lose digits.
    angle = cmath.phase(turning / constant) * math.copysign(1.0, motion.disc_speed)
    limit = 2.0 * math.atan2(
        math.sqrt((p + q - g) * (p + q + g)), math.sqrt(max((g - p + q) * (g + p - q), 0.0))
    )
    turn = (-limit - angle) % (2.0 * math.pi)
    if 2.0 * math.pi - turn < ROUNDING:
        turn = 0.0
    return turn / abs(motion.disc_speed)


def _first_release(motion: SlipMotion, z: complex) -> float:
    """Return the delay of :func:`release_delay` by a search for the first root over one turn of the disc.

    While the disc turns by h the margin of friction over the pull changes by at most Λh. Relative to the disc the
    offset moves, so Λ = |X0|·T with the tangent stiffness T at the largest deflection on the way; relative to the
    ground the pin moves, so Λ = |z|·(T + |ω² − iωβ/m|). Intervals that allow a negative margin are halved down to
    NARROW.
    """
    if motion.disc_speed == 0.0 or motion.support.offset == 0.0:
        return math.inf  # the pull turns but keeps its size
    g, radius, offset = motion.friction, abs(z), abs(motion.support.offset)
    sense = math.copysign(1.0, motion.disc_speed)
    carried = abs(complex(motion.damping, motion.disc_speed) * motion.disc_speed)

    def at(turn: float) -> complex:
        return z * cmath.exp(1j * sense * turn)

    def spare(turn: float) -> float:
        return g - abs(motion.pull(at(turn), 0j))

    def deflection(turn: float) -> float:
        return abs(at(turn) - motion.support.offset)

    held = firmly = 0.0  # last angles with margins >= −GRAZING·g and > 0
    waiting = [2.0 * math.pi]
    while waiting:
        firmly = held if spare(held) > 0.0 else firmly
        end = waiting[-1]
        h = end - held
        tangent = motion.support.tangent(0.5 * (deflection(held) + deflection(end) + min(offset, radius) * h))
        slope = min(offset * tangent, radius * (carried + tangent))
        least = 0.5 * (spare(held) + spare(end) - slope * h)
        if least >= -GRAZING * g:
            held = end
            waiting.pop()
        elif h > NARROW:
            waiting.append(0.5 * (held + end))
        elif spare(end) >= -GRAZING * g:
            held = end
            waiting.pop()
        else:
            if spare(firmly) > 0.0:
                firmly = float(brentq(spare, firmly, end, xtol=1e-15, rtol=1e-15))
            return firmly / abs(motion.disc_speed)
    return math.inf


def stuck_centre(motion: DiscMotion, contact: IsotropicContact) -> SlipMotion | None:
    """Return the stuck pin equivalent to the centre of a stuck disc; None if friction cannot hold the shaft's moment.

    Its friction is the force on the limit surface at that moment; as S ~ sin α grows, the moment grows and the force
    falls.
    """
    g = motion.centre.friction
    asked = abs(motion.turning_pull(0.0)) * motion.gyration * motion.length  # moment over mass, N m/kg
    most = contact.shares(0.0, 1.0).moment
    if asked > g * most:
        return None

    def lacking(alpha: float) -> float:
        return g * contact.shares(math.cos(alpha), math.sin(alpha) / most).moment - asked

    alpha = float(brentq(lacking, 0.0, math.pi / 2.0, xtol=1e-16, rtol=1e-15)) if asked > 0.0 else 0.0
    return replace(
        motion.centre, friction=g * contact.shares(math.cos(alpha), math.sin(alpha) / most).resistance
    )


def slip_direction(motion: DiscMotion, contact: IsotropicContact, z: complex) -> FloatArray:
    """Return the unit vector (u_x, u_y, r) of the slip that begins from rest at ``z`` when friction is exceeded.

    With the mean slip speed P(n) = F·U + M·S the slip s·n begins with ṡ = a·n − g·P(n), and n maximises this rate:
    there a − g∇P is along n. The centre begins to slip along its pull, which leaves one unknown angle.
    """
    pull, turning = motion.centre.pull(z, 0j), motion.turning_pull(0.0)
    strength, g = abs(pull), motion.centre.friction

    def growth(beta: float) -> tuple[float, float]:
        """Return the components of a − g∇P along n and across it."""
        c, s = math.cos(beta), math.sin(beta)
        shares = contact.shares(motion.length * c, -s / motion.gyration)
        force = strength - g * shares.resistance
        moment = turning + g * shares.moment / (motion.length * motion.gyration)
        return force * c + moment * s, moment * c - force * s

    angles = np.linspace(-math.pi / 2.0, math.pi / 2.0, 65).tolist()
    best = max(range(len(angles)), key=lambda i: growth(angles[i])[0])
    low, beta, high = angles[max(best - 1, 0)], angles[best], angles[min(best + 1, len(angles) - 1)]
    if growth(low)[1] > 0.0 > growth(high)[1]:
        beta = float(brentq(lambda beta: growth(beta)[1], low, high, xtol=1e-16, rtol=1e-15))
    along = math.cos(beta) * (pull / strength if strength > 0.0 else 1.0)
    return np.array((along.real, along.imag, math.sin(beta)))


@dataclass(frozen=True)
class SlipStart:
    """Slip that grows from rest, as a power series in time.

    ``positions`` and ``slip`` are the coefficients of z and w, accurate for ``duration`` in s. ``rest`` is the time
    in s of the return to rest, or inf.
    """

    positions: ComplexArray
    slip: ComplexArray
    duration: float
    rest: float

    def at(self, delays: FloatArray) -> tuple[ComplexArray, ComplexArray]:
        powers = np.asarray(delays)[:, np.newaxis] ** np.arange(len(self.positions))
        return powers @ self.positions, powers @ self.slip


def slip_from_rest(motion: SlipMotion, z: complex, *, terms: int = 20, tolerance: float = 1e-12) -> SlipStart:
    """Return the slip of a pin from rest at ``z`` if the pull is at least friction; linear supports only.

    With w = s·exp(iθ) and b = a·exp(−iθ) the motion is ṡ = Re b − g, s·θ̇ = Im b. If the pull exceeds friction, slip
    grows linearly and the series converges. If they are equal (release from stick), slip grows quadratically along
    the pull, and the series is asymptotic, with an error like exp(−2g/(κt)), κ = d|a|/dt. In both cases order t^k
    satisfies (|a₀| + k·s₁)·θ_k = known, (k+1)·s_{k+1} = (Re b)_k. Within ``duration`` the last terms stay below
    ``tolerance``.
    """
    omega = 1j * motion.disc_speed
    position = np.zeros(terms + 1, dtype=complex)
    velocity = np.zeros_like(position)
    pull = np.zeros_like(position)
    slip = np.zeros_like(position)
    direction = np.zeros_like(position)  # exp(iθ)
    theta = np.zeros(terms + 1)
    speed = np.zeros(terms + 2)

    position[0], velocity[0], pull[0] = z, omega * z, motion.pull(z, 0.0)
    strength = abs(pull[0])
    direction[0] = pull[0] / strength
    speed[1] = strength - motion.friction
    order = np.arange(terms + 2)
    for k in range(1, terms + 1):
        position[k] = velocity[k - 1] / k
        slip[k] = np.dot(speed[1 : k + 1], direction[k - 1 :: -1])
        velocity[k] = slip[k] + omega * position[k]
        pull[k] = -(motion.damping + omega) * velocity[k] - motion.support.stiffness * position[k]
        # Coefficient k of exp(iθ), and of b = a·exp(−iθ), without the terms that contain θ_k.
        direction[k] = 1j * np.dot(order[1:k] * theta[1:k], direction[k - 1 : 0 : -1]) / k
        b = np.dot(pull[: k + 1], direction[k::-1].conj())
        turning = np.dot(speed[2 : k + 1], (order[k - 1 : 0 : -1] * theta[k - 1 : 0 : -1]))
        theta[k] = (b.imag - turning) / (strength + k * speed[1])
        direction[k] += 1j * theta[k] * direction[0]
        speed[k + 1] = b.real / (k + 1)

    last = max(abs(theta[-1]), abs(theta[-2]), abs(slip[-1]), abs(slip[-2]))
    duration = (tolerance / last) ** (1.0 / terms) if last > 0.0 else math.inf
    return SlipStart(position, slip, duration, _first_rest(speed[1:], duration))


def _first_rest(speed: FloatArray, duration: float) -> float:
    """Return the first zero of the slip speed with the series ``speed``, up to ``duration``, or inf.

    At a release the first coefficient should vanish, and its rounding error adds a root near zero, where slip rises.
    """
    if not math.isfinite(duration):
        return math.inf
    scaled = np.polynomial.Polynomial(speed * duration ** np.arange(len(speed)))
    roots = scaled.roots()
    times = roots.real[(abs(roots.imag) < 1e-9 * abs(roots)) & (roots.real > 0.0) & (roots.real <= 1.0)]
    falling = times[scaled.deriv()(times) < 0.0]
    return float(falling.min()) * duration if falling.size else math.inf
