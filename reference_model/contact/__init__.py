"""Laws of friction: a pin, points on a ring, a whole ring or an annulus, and the limit of what a disc can hold."""

from reference_model.contact.annulus import Annulus
from reference_model.contact.contact_law import (
    Contact,
    IsotropicContact,
    Pin,
    PointsOnRing,
    Ring,
    ThreeTermRing,
    contact_of,
    isotropic_contact_of,
)

__all__ = [
    "Annulus",
    "Contact",
    "IsotropicContact",
    "Pin",
    "PointsOnRing",
    "Ring",
    "ThreeTermRing",
    "contact_of",
    "isotropic_contact_of",
]
