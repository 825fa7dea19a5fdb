"""Figs. 9 and 10: radius and spin of whirl, self-centred equilibrium and sticking of the disc over μN."""

# ruff: noqa: I001 - the order of the report
from compare.studies.disc.fig09 import steady_motions, growth_and_stick
from compare.studies.disc.fig09.pictures import draw
from compare.studies.disc.fig09.theory import STUDY

STUDY.provides(figures=draw)

__all__ = ["STUDY", "growth_and_stick", "steady_motions"]
