"""Figs. 9 and 10: radius and spin of whirl, self-centred equilibrium and sticking of the disc over μN."""

# ruff: noqa: I001 - the order of the report
from compare.studies.disc.fig09.claims import circles, orbits, rests, sticking, six_points, of_theory
from compare.studies.disc.fig09.claims.study import STUDY

__all__ = ["STUDY", "circles", "of_theory", "orbits", "rests", "six_points", "sticking"]
