"""Eq. 20 to 23: the friction that acts on a disc in each engine, and how far the laws of contact are apart."""

from compare.studies.disc.contact_laws.pictures import draw
from compare.studies.disc.contact_laws.study import STUDY

STUDY.provides(figures=draw)

__all__ = ["STUDY"]
