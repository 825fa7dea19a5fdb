"""Figs. 9 and 10: radius and spin of whirl, self-centred equilibrium and sticking of the disc over μN."""

# ruff: noqa: I001 - the order of the report
from compare.studies.disc.fig09 import whirls, rests, of_theory
from compare.studies.disc.fig09.pictures import draw
from compare.studies.disc.fig09.theory import STUDY

STUDY.provides(figures=draw)

__all__ = ["STUDY", "of_theory", "rests", "whirls"]
