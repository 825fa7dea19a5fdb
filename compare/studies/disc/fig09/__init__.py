"""Figs. 9 and 10: radius and spin of whirl, self-centred equilibrium and sticking of the disc over μN."""

from compare.studies.disc.fig09.claims import STUDY

__all__ = ["STUDY"]
