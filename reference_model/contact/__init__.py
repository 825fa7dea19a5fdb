"""Friction laws of a pin, of points, of a ring and of an annulus, and the limit surface of a disc."""

from reference_model.contact.annulus import Annulus
from reference_model.contact.contact_law import (
    Contact,
    IsotropicContact,
    Pin,
    Ring,
    ThreeTermRing,
    contact_of,
    isotropic_contact_of,
)
from reference_model.contact.points import Points, PointsOnRing

__all__ = [
    "Annulus",
    "Contact",
    "IsotropicContact",
    "Pin",
    "Points",
    "PointsOnRing",
    "Ring",
    "ThreeTermRing",
    "contact_of",
    "isotropic_contact_of",
]
