"""Fig. 11: the whirl whose radius and spin swell and shrink, how it comes about, and for which offsets."""

# ruff: noqa: I001 - the order of the report
from compare.studies.disc.fig11.claims import whirl, cycle, offsets, six_points, of_theory
from compare.studies.disc.fig11.claims.study import STUDY

__all__ = ["STUDY", "cycle", "of_theory", "offsets", "six_points", "whirl"]
