"""Friction laws of a pin, of points on a ring, of a ring and of an annulus, and the limit surface of a disc."""

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
