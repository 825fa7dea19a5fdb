"""The self-centred equilibrium of a disc over the friction force, and where it ends."""

from __future__ import annotations

from dataclasses import replace

from scipy.optimize import brentq

from compare.claims.error_estimates import ROUNDING
from reference_model import self_centred_equilibria
from reference_model.contact.contact_law import IsotropicContact
from reference_model.formulas.disc import held_pin, shaft_torque
from reference_model.steady.steady_states import SpinningEquilibrium
from reference_model.systems import DiscOnDisc


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
