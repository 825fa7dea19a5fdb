"""Friction laws of a pin, points, a patch, a ring and an annulus, and their limit surfaces."""

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
from reference_model.contact.limit_surface import largest_wrench, wrench_of_slip
from reference_model.contact.patch import polygon_patch
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
    "largest_wrench",
    "polygon_patch",
    "wrench_of_slip",
]
