"""The characteristic equation of a disc's whirl: corrected (13) for section 4 of the paper."""

from typing import NamedTuple

from reference_model.contact.contact_law import IsotropicContact, isotropic_contact_of
from reference_model.support import require_linear_support
from reference_model.systems import DiscOnDisc


class Coefficients(NamedTuple):
    """Coefficients of λ³, λ², λ and 1 in the characteristic equation λ⁴ + … = 0, in 1/s to 1/s⁴."""

    cubic: float
    square: float
    linear: float
    constant: float

    @property
    def hurwitz(self) -> float:
        """Hurwitz determinant in 1/s⁶: zero where two eigenvalues have the sum zero."""
        return self.linear * (self.square * self.cubic - self.linear) - self.cubic**2 * self.constant

    @property
    def squared_frequency(self) -> float:
        """ν² in 1/s² of the pair ±iν where :attr:`hurwitz` is zero; negative for a real pair ±|ν|."""
        return self.linear / self.cubic


def characteristic_coefficients(
    disc: DiscOnDisc, slip: float, rim: float, contact: IsotropicContact | None = None
) -> Coefficients:
    """Return the coefficients of the characteristic equation of a disc's whirl without offset: (13) for the disc.

    With the deviations ξ of the radius, w of the circumferential speed and σ of the spin, (19) is::

        ξ̈ + Dξ̇ − 2kw = 0,   ẇ + 2kξ̇ + ew − fξ + gσ = 0,   σ̇ + cσ + h(w − dξ) = 0

        d = |ω| − k,   D = βω/(md),   e = (β + μN·F_U)/m,   f = (μN·F_U·d − βk)/m,
        g = μN·F_S/m,   h = μN·M_U/J,   c = (b + μN·M_S)/J

    where indices of F and M are derivatives. So λ(λ + D)[(λ + e)(λ + c) − gh] + 2k[(2kλ − f)(λ + c) + ghd] = 0. For a
    pin g = h = 0, and corrected (13) remains. ``slip`` and ``rim`` are positive, with the ratio U : R|ω − φ̇|.

    Raises ``ValueError`` if the law has no derivative there, or the disc rests on single points or a nonlinear
    support.
    """
    require_linear_support(disc)
    law = isotropic_contact_of(disc, contact, "the whirl")
    k, spin = disc.natural_frequency, rim / disc.contact_radius
    relative = abs(disc.disc_speed) - k
    # Actual slip over ``slip``; derivatives of friction are smaller by this factor.
    size = relative * disc.friction_force * law.shares(slip, spin).resistance / (disc.damping * k * slip)
    slopes = law.slopes(slip, spin)
    per_size = disc.friction_force / size
    radial = disc.damping * abs(disc.disc_speed) / (disc.mass * relative)
    along = (disc.damping + per_size * slopes.resistance_by_slip) / disc.mass
    pull = (per_size * slopes.resistance_by_slip * relative - disc.damping * k) / disc.mass
    torsion = (disc.shaft_damping + per_size * slopes.moment_by_spin) / disc.polar_inertia
    coupling = (
        per_size**2 * slopes.resistance_by_spin * slopes.moment_by_slip / (disc.mass * disc.polar_inertia)
    )
    both = along * torsion - coupling
    return Coefficients(
        radial + along + torsion,
        both + radial * (along + torsion) + 4.0 * k**2,
        radial * both + 4.0 * k**2 * torsion - 2.0 * k * pull,
        2.0 * k * (coupling * relative - pull * torsion),
    )
