"""Fig. 11: the modulated cycle of the whirl."""

# ruff: noqa: I001 - the order of the report
from compare.studies.disc.fig11 import whirl, offsets
from compare.studies.disc.fig11.pictures import curves, draw
from compare.studies.disc.fig11.theory import STUDY

STUDY.provides(figures=draw, curves=curves)

__all__ = ["STUDY", "offsets", "whirl"]
