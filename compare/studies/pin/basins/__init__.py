"""Basins of equilibrium and whirl in Fig. 5."""

from compare.studies.pin.basins.pictures import draw
from compare.studies.pin.basins.study import STUDY, curves

STUDY.provides(figures=draw, curves=curves)
