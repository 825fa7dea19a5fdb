"""Eq. 20 to 23: the friction that acts on a disc in each engine, and how far the laws of contact are apart."""

from compare.studies.disc.contact_laws.claims import in_engines, of_laws
from compare.studies.disc.contact_laws.claims.study import STUDY

__all__ = ["STUDY", "in_engines", "of_laws"]
