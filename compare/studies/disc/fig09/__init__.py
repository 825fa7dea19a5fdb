"""Figs. 9 and 10: motions of the disc against the friction force."""

# ruff: noqa: I001 - the order of the report
from compare.studies.disc.fig09 import steady_motions, growth_and_stick
from compare.studies.disc.fig09.pictures import draw
from compare.studies.disc.fig09.theory import STUDY

STUDY.provides(figures=draw)

__all__ = ["STUDY", "growth_and_stick", "steady_motions"]
