"""Measured pushes of a body on a plane, compared with Coulomb's law."""

from compare.studies.plane.pushes.pictures import draw
from compare.studies.plane.pushes.study import STUDY

STUDY.provides(figures=draw)
