"""Measured slides of a tossed cube, compared with Coulomb's law and with engines."""

from compare.studies.plane.tosses.pictures import draw
from compare.studies.plane.tosses.study import STUDY

STUDY.provides(figures=draw)
