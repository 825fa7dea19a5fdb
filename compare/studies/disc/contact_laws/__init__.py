"""Eqs. (20) to (23): friction on a disc in each engine, and differences between the contact laws."""

from compare.studies.disc.contact_laws.pictures import draw
from compare.studies.disc.contact_laws.study import STUDY

STUDY.provides(figures=draw)

__all__ = ["STUDY"]
