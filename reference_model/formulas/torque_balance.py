"""All solutions of the force and moment balances of a disc in steady motion.

Isotropic friction depends only on the ratio of slip speed U and rim speed W = R|S|, as in (24). The ratio determines
force μN·F and moment μN·M, which leaves one equation for the ratio.

The torsional balance b(ω − Ω − S) = μN·M gives S the sign of ω − Ω, because M has the sign of S. M grows with W : U
for every law here, so the ratios with μN·M <= b|ω − Ω| form an interval.
"""

import math
import sys
from collections.abc import Callable, Iterator

from reference_model.contact.contact_law import IsotropicContact, Shares
from reference_model.formulas.disc import pin_of, shaft_torque, whirl_arm
from reference_model.formulas.pin import circling_speed, driven_radius, require_drive
from reference_model.numerics.roots import largest_between, zero_between, zeros_between
from reference_model.support import Support
from reference_model.systems import DiscOnDisc

OfRatio = Callable[[float, float], float]
"""A function of slip and rim speed >= 0 that depends only on their ratio."""

NO_SLIP = 1e-30
"""Ratio of slip to rim speed below which the quotient takes its limit."""

ROUNDING = 8.0 * sys.float_info.epsilon
"""Relative residual of a balance that rounding may cause."""


def resting_positions(disc: DiscOnDisc, contact: IsotropicContact) -> Iterator[tuple[complex, float]]:
    """Yield x + iy in m and the spin in rad/s of all sliding equilibria in space, in order of increasing W : U.

    Nothing is yielded if every position or every spin is an equilibrium.

    Friction acts across the radius, so springs with the deflection d must pull by μN·F at a right angle to it: ρ² +
    d² = X0². With U = |ω|ρ, m = b|ω − Ω|/μN and tan α = W/U, the torsional balance gives U = (μN·R/b)(m − M)/tan α,
    which leaves the zeros of (μN·R/(b|ω|)·(m − M)·cos α)² + (d² − X0²)·sin² α.
    """
    load, offset, torque = disc.friction_force, abs(disc.offset), shaft_torque(disc)
    speed, radius = abs(disc.disc_speed), disc.contact_radius
    support = Support.of(disc)
    if load == 0.0:
        if support.centring and disc.shaft_damping > 0.0:
            yield complex(disc.offset), disc.shaft_speed
        return
    if speed == 0.0 or support.pull(offset) == 0.0:
        # There is no friction without a spring force, so the centre does not slip.
        to_shaft = torque - load * contact.shares(0.0, 1.0).moment
        if to_shaft > 0.0 and (speed > 0.0 or support.centring):
            place = complex(disc.offset) if speed == 0.0 else 0j
            yield place, _spin(disc, to_shaft / disc.shaft_damping)
        return

    largest_moment = torque / load

    def at(slip: float, rim: float) -> Shares:
        return contact.shares(slip, rim / radius)

    def balance(slip: float, rim: float) -> float:
        resistance, moment = at(slip, rim)
        from_shaft = load * radius / (disc.shaft_damping * speed) * (largest_moment - moment) * slip
        deflection = support.deflection(load * resistance)
        return _difference(from_shaft**2, (offset - deflection) * (offset + deflection) * rim**2)

    # The disc has no relative spin without a moment of the shaft.
    ratios = (
        [(1.0, 0.0)]
        if torque == 0.0
        else _zeros(balance, lambda slip, rim: largest_moment - at(slip, rim).moment)
    )
    for slip, rim in ratios:
        resistance, moment = at(slip, rim)
        deflection, spare_moment = support.deflection(load * resistance), largest_moment - moment
        squared_place = (offset - deflection) * (offset + deflection)
        # The size comes from the balance that keeps more digits.
        if spare_moment * offset**2 > squared_place * largest_moment:
            size = load * radius / disc.shaft_damping * spare_moment / rim
        else:
            size = speed * math.sqrt(max(squared_place, 0.0)) / slip
        if size > 0.0:
            rho = size * slip / speed
            place = rho * complex(rho, math.copysign(deflection, disc.disc_speed)) / disc.offset
            yield place, _spin(disc, size * rim / radius)


def circles(disc: DiscOnDisc, contact: IsotropicContact) -> Iterator[tuple[float, float]]:
    """Yield radius in m and spin in rad/s of all whirls of a disc without offset, the largest first.

    They solve :func:`reference_model.formulas.disc.whirl_arm` = b|ω − Ω|/μN; on a nonlinear support the arm depends
    on the load. Raises ``ValueError`` if :func:`whirl_arm` does, or without damping or friction.
    """
    pin = pin_of(disc)
    require_drive(pin)
    speed, needed = abs(disc.disc_speed), shaft_torque(disc) / disc.friction_force

    def circle(resistance: float) -> tuple[float, float]:
        """Return the radius at this share of friction, and the slip speed of the centre."""
        radius = driven_radius(pin, disc.friction_force * resistance)
        return radius, (speed - circling_speed(pin, radius)) * radius

    def arm_at_load(slip: float, rim: float) -> float:
        slip = max(slip, NO_SLIP)
        resistance, moment = contact.shares(slip, rim / disc.contact_radius)
        relative_spin = circle(resistance)[1] * rim / (slip * disc.contact_radius)
        return moment + disc.shaft_damping * relative_spin / disc.friction_force

    arm = whirl_arm(disc, contact) if disc.linear_support else arm_at_load
    for slip, rim in _zeros(lambda slip, rim: _difference(arm(slip, rim), needed)):
        if slip > 0.0:
            radius, centre = circle(contact.shares(slip, rim / disc.contact_radius).resistance)
            if centre > 0.0:
                yield radius, _spin(disc, centre * rim / (slip * disc.contact_radius))


def least_load_with_whirl(disc: DiscOnDisc, contact: IsotropicContact) -> float:
    """Return the smallest load in N with a whirl."""
    arm = whirl_arm(disc, contact)
    halves = (lambda q: arm(1.0, q)), (lambda q: arm(q, 1.0))
    return shaft_torque(disc) / max(largest_between(half, 0.0, 1.0) for half in halves)


def _difference(one: float, other: float) -> float:
    """Return one − other, or zero within rounding error, whose changes of sign would count as solutions."""
    difference = one - other
    return difference if abs(difference) > ROUNDING * max(abs(one), abs(other)) else 0.0


def _spin(disc: DiscOnDisc, relative_spin: float) -> float:
    return disc.disc_speed - math.copysign(relative_spin, disc.disc_speed - disc.shaft_speed)


def _zeros(balance: OfRatio, allowed: OfRatio = lambda slip, rim: 1.0) -> Iterator[tuple[float, float]]:
    """Yield the zeros (slip, rim) of ``balance`` with ``allowed`` >= 0, in order of increasing rim : slip.

    The larger of slip and rim is 1, to keep the relative accuracy. The halves meet at the kink of a ring's friction.
    """
    end = 1.0 if allowed(1.0, 1.0) >= 0.0 else zero_between(lambda q: allowed(1.0, q), 0.0, 1.0)
    for q in zeros_between(lambda q: balance(1.0, q), 0.0, end):
        yield 1.0, q
    if end == 1.0:
        end = 0.0 if allowed(0.0, 1.0) >= 0.0 else zero_between(lambda q: allowed(q, 1.0), 0.0, 1.0)
        for q in reversed(zeros_between(lambda q: balance(q, 1.0), end, 1.0)):
            if q < 1.0:
                yield q, 1.0
