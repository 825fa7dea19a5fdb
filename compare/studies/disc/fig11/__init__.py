"""Fig. 11: the modulated cycle of the whirl, its origin, and the range of offsets where it exists."""

# ruff: noqa: I001 - the order of the report
from compare.studies.disc.fig11 import whirl, offsets, of_theory
from compare.studies.disc.fig11.pictures import draw
from compare.studies.disc.fig11.parameters import STUDY
from compare.studies.disc.fig11.theory import curves

STUDY.provides(figures=draw, curves=curves)

__all__ = ["STUDY", "of_theory", "offsets", "whirl"]
