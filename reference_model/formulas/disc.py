"""The closed forms of section 4 of the paper, one function per equation, and results of the same balances.

Signs are the same as in :mod:`reference_model.formulas.pin`, with the given Ω/ω. If ω < 0, y and the spin change
sign; if X0 < 0, x and y do.
"""

import itertools
import math
from collections.abc import Callable
from dataclasses import fields, replace
from typing import NamedTuple

from reference_model.contact.contact_law import IsotropicContact, isotropic_contact_of
from reference_model.contact.limit_surface import force_beside
from reference_model.formulas import pin as pin_formulas
from reference_model.numerics.roots import zeros_between
from reference_model.support import require_linear_support
from reference_model.systems import DiscOnDisc, PinOnDisc

OF_A_PIN = tuple(field.name for field in fields(PinOnDisc))


def pin_of(disc: DiscOnDisc, **others: float) -> PinOnDisc:
    """Return the pin that moves like a disc without relative spin, with ``others`` replaced."""
    return PinOnDisc(**{name: getattr(disc, name) for name in OF_A_PIN} | others)


def shaft_torque(disc: DiscOnDisc) -> float:
    """Return b|ω − Ω| in N m, the shaft's moment on a disc without relative spin."""
    return disc.shaft_damping * abs(disc.disc_speed - disc.shaft_speed)


def inverse_slip_speed(slip: complex, rim_speed: float, place: float) -> float:
    """Return ν̄_r/|ν_r| at a point of the ring by three terms of its expansion: the first line of (22), corrected.

    With ε = R(ω − φ̇)·ν̃_xy/ν̄_r² it is 1/√(1 + 2ε) = 1 − ε + (3/2)ε² − …, which leads to (23). ``slip`` is (ẋ + ωy)
    + i(ẏ − ωx) and ``rim_speed`` R(ω − φ̇), both in m/s; ``place`` is φ + χ in rad.
    """
    small = _expanded(slip, rim_speed, place)
    return 1.0 - small + 1.5 * small**2


def inverse_slip_speed_as_printed(slip: complex, rim_speed: float, place: float) -> float:
    """Return the right side of the first line of (22) as printed, with ν̃_r/|ν_r| on the left."""
    return 1.0 - _expanded(slip, rim_speed, place)


def held_pin(disc: DiscOnDisc, contact: IsotropicContact | None = None) -> PinOnDisc:
    """Return the pin equivalent to the centre of a stuck disc; its μN is the force that friction can hold.

    The constant moment b(ω − Ω) leaves the force F of the limit surface in place of μN in (7) to (9). So
    ``pin_formulas.sticking_radius(held_pin(disc))`` is the right side of (9). Raises ``ValueError`` if friction
    cannot supply the moment or the disc rests on single points.
    """
    law = isotropic_contact_of(disc, contact, "the limits of sticking")
    force = force_beside(law, disc.friction_force, shaft_torque(disc))
    if force is None:
        largest = disc.friction_force * law.shares(0.0, 1.0).moment
        raise ValueError(
            f"friction_force = {disc.friction_force:g} N: the disc cannot stick, because friction holds only "
            f"{largest:g} N m of the shaft's {shaft_torque(disc):g} N m"
        )
    return replace(pin_of(disc), friction_force=force)


class Position(NamedTuple):
    """Position of a self-centred disc, x and y in m, and its spin in rad/s."""

    x: float
    y: float
    spin: float


class ReducedParameters(NamedTuple):
    """Parameters of (25): μ₀ and b₀ in m, and the number δ."""

    load: float
    shaft_damping: float
    speed_difference: float


def position_of(disc: DiscOnDisc, distance: float, alpha: float, theta: float) -> Position:
    """Return position and spin by (24) from A in m and the angles α and θ in rad.

    The slip speeds of centre and rim are U = |ω|A·cos α and R(ω − φ̇) = ωA·sin α.
    """
    return Position(
        distance * math.cos(alpha) * math.cos(theta),
        distance * math.cos(alpha) * math.sin(theta),
        disc.disc_speed * (1.0 - distance / disc.contact_radius * math.sin(alpha)),
    )


def reduced_parameters(disc: DiscOnDisc) -> ReducedParameters:
    """Return μ₀, b₀ and δ of (25).

    Raises ``ValueError`` if stiffness or disc speed is zero, or the support is not linear.
    """
    require_linear_support(disc)
    _require_not_zero(disc, "stiffness", "disc_speed")
    return ReducedParameters(
        load=disc.friction_force / disc.stiffness,
        shaft_damping=disc.shaft_damping * abs(disc.disc_speed) / (disc.contact_radius * disc.stiffness),
        speed_difference=1.0 - disc.shaft_speed / disc.disc_speed,
    )


def speed_difference_at(disc: DiscOnDisc, distance: float, alpha: float) -> float:
    """Return the right side of the first line of (26), whose left side is δ, at A in m and α in rad.

    Raises ``ValueError`` as :func:`reduced_parameters`, and if the shaft damping is zero.
    """
    _require_not_zero(disc, "shaft_damping")
    load, shaft_damping, _ = reduced_parameters(disc)
    sine, cosine = math.sin(alpha), math.cos(alpha)
    moment = sine * (1.0 - 0.5 * cosine**2 * (1.0 - 1.5 * sine**2))
    return sine / disc.contact_radius * distance + load / shaft_damping * moment


def squared_distance(disc: DiscOnDisc, alpha: float) -> float:
    """Return A² in m² by the second line of (26), corrected, at α in rad; negative if no A exists.

    (24) inserted into (23) gives the bracket 1 − ½sin²α + (3/16)·sin²2α. Raises the errors of
    :func:`reduced_parameters`.
    """
    return _squared_distance(
        disc, alpha, 1.0 - 0.5 * math.sin(alpha) ** 2 + 0.1875 * math.sin(2.0 * alpha) ** 2
    )


def squared_distance_as_printed(disc: DiscOnDisc, alpha: float) -> float:
    """Return A² in m² by (26) as printed, with the wrong bracket 1 − ½cos²α + (3/16)·sin²α."""
    return _squared_distance(disc, alpha, 1.0 - 0.5 * math.cos(alpha) ** 2 + 0.1875 * math.sin(alpha) ** 2)


def polar_angle(disc: DiscOnDisc, distance: float, alpha: float) -> float:
    """Return θ of the third line of (26) in rad, at A in m and α in rad, in the sense of ω.

    Raises ``ValueError`` if the offset is zero, which leaves no direction, or if A·cos α > |X0|.
    """
    _require_not_zero(disc, "offset")
    cosine = distance * math.cos(alpha) / disc.offset
    if abs(cosine) > 1.0 + 1e-12:
        raise ValueError(
            f"A·cos(alpha) = {distance * math.cos(alpha):g} m: it must not exceed |offset| = {abs(disc.offset):g} m"
        )
    angle = math.acos(max(-1.0, min(cosine, 1.0)))
    return math.copysign(angle, disc.disc_speed * disc.offset)


def positions_by_26(disc: DiscOnDisc, *, as_printed: bool = False) -> tuple[Position, ...]:
    """Return all solutions of (26) as positions (24), in order of increasing |α|.

    The corrected (26) gives the equilibria of :class:`reference_model.contact.contact_law.ThreeTermRing`. Raises
    ``ValueError`` if stiffness, disc speed, shaft damping or offset is zero.
    """
    _require_not_zero(disc, "shaft_damping", "offset")
    squared = squared_distance_as_printed if as_printed else squared_distance
    difference = reduced_parameters(disc).speed_difference

    def excess(alpha: float) -> float:
        """Return the residual of the first line of (26) times cos α, because A grows like its reciprocal."""
        distance = math.sqrt(max(squared(disc, alpha), 0.0))
        return (speed_difference_at(disc, distance, alpha) - abs(difference)) * math.cos(alpha)

    def real(alpha: float) -> float:
        return squared(disc, alpha) * math.cos(alpha) ** 2

    ends = [0.0, *zeros_between(real, 0.0, math.pi / 2.0), math.pi / 2.0]
    places = []
    for left, right in itertools.pairwise(ends):
        if left < right and real((left + right) / 2.0) > 0.0:
            for root in zeros_between(excess, left, right):
                alpha = math.copysign(root, difference)
                distance = math.sqrt(max(squared(disc, alpha), 0.0))
                places.append(position_of(disc, distance, alpha, polar_angle(disc, distance, alpha)))
    return tuple(places)


class WhirlAtRatio(NamedTuple):
    """A whirl without offset: its load μN in N, radius in m and spin in rad/s."""

    load: float
    radius: float
    spin: float


def whirl_at(disc: DiscOnDisc, alpha: float, contact: IsotropicContact | None = None) -> WhirlAtRatio:
    """Return the whirl without offset in closed form, at the ratio tan α = R|ω − φ̇|/U of rim and centre slip.

    The radial balance contains no friction, so the frequency is κ = ±k, as for the pin. Along the circle βkρ =
    μN·F(α) for |ω| > k, as in (11), so U = (|ω| − k)ρ. About the centre b(ω − Ω − S) = μN·M(α) with S = ω − φ̇, R|S|
    = U·tan α. Together they give the load::

        μN = b|ω − Ω| / [M + b(|ω| − k)/(βkR)·F·tan α]

    ``alpha`` is in rad, 0 < α < π/2. The result does not depend on ``friction_force``. ``contact`` None means the law
    of the parameters; :class:`reference_model.contact.contact_law.ThreeTermRing` is (23).

    Raises ``ValueError`` if α is out of range; if stiffness, damping or shaft damping is zero; if Ω = ω or |ω| <= k;
    or if the disc rests on single points or a nonlinear support.
    """
    require_linear_support(disc)
    law = isotropic_contact_of(disc, contact, "the whirl")
    if not 0.0 < alpha < math.pi / 2.0:
        raise ValueError(f"alpha = {alpha:g} rad: it must lie between 0 and π/2")
    if shaft_torque(disc) == 0.0:
        raise ValueError(
            f"shaft_damping = {disc.shaft_damping:g} N m s/rad, disc_speed - shaft_speed = "
            f"{disc.disc_speed - disc.shaft_speed:g} rad/s: the disc does not spin against the master disc"
        )
    slip, rim = math.cos(alpha), math.sin(alpha)
    load = shaft_torque(disc) / whirl_arm(disc, law)(slip, rim)
    radius = (
        load
        * law.shares(slip, rim / disc.contact_radius).resistance
        / (disc.damping * disc.natural_frequency)
    )
    relative_spin = (
        (abs(disc.disc_speed) - disc.natural_frequency) * radius * rim / (slip * disc.contact_radius)
    )
    return WhirlAtRatio(
        load, radius, disc.disc_speed - math.copysign(relative_spin, disc.disc_speed - disc.shaft_speed)
    )


def whirl_arm(disc: DiscOnDisc, contact: IsotropicContact) -> Callable[[float, float], float]:
    """Return b|ω − Ω|/μN in m of the whirl as a function of slip and rim >= 0, whose ratio is U : R|ω − φ̇|.

    It is M + b(|ω| − k)/(βkR)·F·rim/slip, with its limit at slip = 0, b|ω − Ω| divided by the onset load. Raises
    ``ValueError`` if stiffness or damping is zero, |ω| <= k, or the support is not linear.
    """
    require_linear_support(disc)
    per_load = pin_formulas.whirl_radius(pin_of(disc, friction_force=1.0))
    against_slip = disc.shaft_damping * (abs(disc.disc_speed) - disc.natural_frequency) * per_load

    def arm(slip: float, rim: float) -> float:
        relative_spin = rim / disc.contact_radius
        resistance, moment = contact.shares(slip, relative_spin)
        damper = resistance / slip if slip > 0.0 else contact.slopes(0.0, relative_spin).resistance_by_slip
        return moment + against_slip * damper * relative_spin

    return arm


def _expanded(slip: complex, rim_speed: float, place: float) -> float:
    along_rim = slip.real * math.sin(place) - slip.imag * math.cos(place)
    return rim_speed * along_rim / (abs(slip) ** 2 + rim_speed**2)


def _squared_distance(disc: DiscOnDisc, alpha: float, bracket: float) -> float:
    load = reduced_parameters(disc).load
    direct = disc.offset / math.cos(alpha)
    return (direct - load * bracket) * (direct + load * bracket)


def _require_not_zero(disc: DiscOnDisc, *names: str) -> None:
    for name in names:
        if getattr(disc, name) == 0.0:
            raise ValueError(f"{name} = 0: it must not be zero in (24) to (26)")
