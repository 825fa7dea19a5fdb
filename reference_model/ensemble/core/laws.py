"""Scaled constants of pins and discs, forces, and the duration of rest."""

import math
from collections.abc import Callable
from typing import NamedTuple

from reference_model.core.rest import GRAZING, ROUNDING
from reference_model.ensemble.core.contact_shares import LEAST, points_shares, ring_shares, turned
from reference_model.ensemble.core.jit import inlined, scalar

ROUNDING_OF_SLIP = 4.0 * 2.220446049250313e-16
"""Largest relative slip that counts as rounding, so that the body sticks."""

STRETCHING_TIME = 0.5
"""Scaled ratio s₀/g. A larger value shortens steps, a smaller value makes rest and release stiffer."""

SPENT_SHARE = 0.1
"""Share of the tolerance for the slip that remains when creep counts as over."""

CREEP = 0.1
"""Largest excess of the pull in creep, as a fraction of the pull's change in a turn or of g."""


class PinLaw(NamedTuple):
    """Constants of a pin, divided by its mass, scaled so that motion is of order one.

    ``stiffness`` is k², ``damping`` β/m, ``friction`` g = μN/m, ``stretching`` s₀. ``free`` = 1 keeps time
    unstretched without friction, where nothing rests.
    """

    stiffness: float
    damping: float
    friction: float
    disc_speed: float
    offset: float
    stretching: float
    free: float


class DiscLaw(NamedTuple):
    """Constants of a disc, scaled so that motion is of order one; a pin has seven of them.

    ``around`` contains (cos, sin) of the direction of each contact point in sequence; () for the ring. ``leverage``
    is η = R/κ, ``shaft_rate`` b/J, ``lag`` κ(ω − Ω) and ``curling`` 1/κ.
    """

    around: tuple[float, ...]
    stiffness: float
    damping: float
    friction: float
    disc_speed: float
    offset: float
    stretching: float
    free: float
    leverage: float
    shaft_rate: float
    lag: float
    curling: float


Law = PinLaw | DiscLaw

Friction = Callable[[float, float, float, float, DiscLaw], tuple[float, float, float, float]]
"""Takes the slip u_x, u_y, r and the angle; returns as :func:`ring_friction`."""


@scalar
def units(
    k: float, c: float, g: float, omega: float, offset: float, place: float, speed: float
) -> tuple[float, float]:
    """Return the unit of length in m and the inverse unit of time in 1/s, as ``Units.of`` for a pin."""
    rate = max(k, abs(omega))
    if rate == 0.0:
        rate = c
    if rate == 0.0:
        rate = g / speed if g > 0.0 and speed > 0.0 else 1.0
    length = max(max(place, abs(offset)), max(speed / rate, g / rate**2))
    return (length if length > 0.0 else 1.0), rate


@inlined
def pull(z: complex, w: complex, law: Law) -> complex:
    v = w + 1j * law.disc_speed * z
    acceleration: complex = -law.stiffness * (z - law.offset) - (law.damping + 1j * law.disc_speed) * v
    return acceleration


@inlined
def ring_friction(
    ux: float, uy: float, r: float, angle: float, law: DiscLaw
) -> tuple[float, float, float, float]:
    """Return −∂P/∂u_x, −∂P/∂u_y, −∂P/∂r and P of a ring."""
    u, rim = math.sqrt(ux * ux + uy * uy), law.leverage * abs(r)
    by_slip, by_rim = ring_shares(u, rim)
    centre = by_slip / max(u, LEAST)
    turning = by_rim * law.leverage * law.leverage / max(rim, LEAST)
    return -centre * ux, -centre * uy, -turning * r, by_slip * u + by_rim * rim


@inlined
def points_friction(
    ux: float, uy: float, r: float, angle: float, law: DiscLaw
) -> tuple[float, float, float, float]:
    c, s = turned(angle)
    fx, fy, moment, power = points_shares(c * ux + s * uy, c * uy - s * ux, law.leverage * r, law.around)
    return s * fy - c * fx, -s * fx - c * fy, -law.leverage * moment, power


@scalar
def release_delay(z: complex, law: PinLaw) -> float:
    """Return how long a pin at rest at ``z`` sticks, like ``stick.release_delay``: eq. 7."""
    constant = law.stiffness * law.offset
    turning = pull(z, 0j, law) - constant
    p, q, g = abs(constant), abs(turning), law.friction
    if law.disc_speed == 0.0 or p + q <= g * (1.0 + GRAZING):
        return math.inf
    angle = math.atan2(turning.imag, turning.real)
    if constant < 0.0:
        angle -= math.pi
    if law.disc_speed < 0.0:
        angle = -angle
    limit = 2.0 * math.atan2(
        math.sqrt((p + q - g) * (p + q + g)), math.sqrt(max((g - p + q) * (g + p - q), 0.0))
    )
    turn = (-limit - angle) % (2.0 * math.pi)
    if 2.0 * math.pi - turn < ROUNDING:
        turn = 0.0  # already at the limit
    return turn / abs(law.disc_speed)


@scalar
def sticking_radius(law: PinLaw) -> float:
    """Return the largest distance from the axis with permanent stick of a pin (9)."""
    turning = abs(complex(law.stiffness - law.disc_speed**2, law.disc_speed * law.damping))
    spare = law.friction - law.stiffness * abs(law.offset)
    return spare / turning if turning > 0.0 else math.inf


@scalar
def creeps_by_turns(radius: float, last: float, law: PinLaw) -> bool:
    """Return whether a pin released at the radius ``last`` and then at ``radius`` creeps inward forever.

    Once per turn the constant pull p = k²|X0| and the turning pull q add up to g + δ, around which the pull falls
    like B·(ωt)²/2, B = p·q/(p + q). With K = k² − ω² the slip reduces δ by 4.5·K·δ²/(B·ω²), less than all of it, so δ
    never reaches zero. Nor does it if c² >= 4K: see ``pin.slip.creeps_steadily``.
    """
    inward = law.stiffness - law.disc_speed**2
    constant = law.stiffness * abs(law.offset)
    turning = abs(complex(inward, law.disc_speed * law.damping))
    q = turning * last
    peak = constant * q / (constant + q) if q > 0.0 else 0.0
    most = CREEP * peak * min(1.0, law.disc_speed**2 / inward) if inward > 0.0 else 0.0
    if inward > 0.0 and law.damping**2 >= 4.0 * inward:
        most = max(most, CREEP * law.friction)
    return radius < last and law.friction < constant + turning * radius and constant + q < law.friction + most
