"""The constants of pins and discs, the forces that act on them, and how long rest lasts."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

from reference_model.ensemble.core.contact_shares import LEAST, points_shares, ring_shares, turned
from reference_model.ensemble.core.jit import inlined, scalar
from reference_model.motion.stick import GRAZING, ROUNDING

CREEP = 0.1
"""Excess of the pull, as a fraction of by how much it changes in a turn or of g, up to which slip creeps."""


class PinLaw(NamedTuple):
    """The constants of a pin, divided by its mass, in units in which motion is of order one.

    ``stiffness`` is k², ``damping`` β/m, ``friction`` g = μN/m, ``disc_speed`` ω, ``offset`` X0. ``stretching`` is
    s₀; without friction nothing rests, and ``free`` = 1 keeps time as it is.
    """

    stiffness: float
    damping: float
    friction: float
    disc_speed: float
    offset: float
    stretching: float
    free: float


class DiscLaw(NamedTuple):
    """The constants of a disc in units in which motion is of order one; seven as of a pin.

    ``around`` are the unit vectors to the points of contact, (cos, sin) of each, one after the other; none for the
    ring. ``leverage`` is η = R/κ, ``shaft_rate`` b/J, ``lag`` κ(ω − Ω) and ``curling`` 1/κ.
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
"""Returns friction of a slip u_x, u_y, r at an angle, and the mean slip speed, as :func:`ring_friction`."""


@inlined
def pull(z: complex, w: complex, law: Law) -> complex:
    """Return a(z, w), the relative acceleration without friction."""
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
    """Return what :func:`ring_friction` does, of points: in the frame of the disc they always stand alike."""
    c, s = turned(angle)
    fx, fy, moment, power = points_shares(c * ux + s * uy, c * uy - s * ux, law.leverage * r, law.around)
    return s * fy - c * fx, -s * fx - c * fy, -law.leverage * moment, power


@scalar
def release_delay(z: complex, law: PinLaw) -> float:
    """Return how long a pin at rest at ``z`` stays stuck, as ``sticking.release_delay`` does: eq. 7; inf for ever."""
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
        turn = 0.0  # at the limit already
    return turn / abs(law.disc_speed)


@scalar
def sticking_radius(law: PinLaw) -> float:
    """Return the largest distance from the axis at which a pin may stay stuck for ever (9): where p + q = g."""
    turning = abs(complex(law.stiffness - law.disc_speed**2, law.disc_speed * law.damping))
    spare = law.friction - law.stiffness * abs(law.offset)
    return spare / turning if turning > 0.0 else math.inf


@scalar
def creeps_by_turns(radius: float, last: float, law: PinLaw) -> bool:
    """Tell whether a pin that was released at the radius ``last`` and then at ``radius`` creeps inward for ever.

    Of its pull the part p = k²|X0| is constant, and q, in proportion to the radius, turns with it. Once a turn they
    add up to g + δ, from which the pull falls like B·(ωt)²/2 before and after, B = p·q/(p + q). With
    K = k² − ω² the slip that this sets off takes 4.5·K·δ²/(B·ω²) from δ: less than all of it, so that δ never
    comes to zero. Nor does it where c² >= 4K, however far the slip goes: see ``pin.slip.creeps_steadily``.
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
