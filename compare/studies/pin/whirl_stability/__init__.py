"""Eqs. (11) to (16): the whirl without offset, and deviations from it."""

from compare.studies.pin.whirl_stability.pictures import curves, draw
from compare.studies.pin.whirl_stability.study import STUDY

STUDY.provides(figures=draw, curves=curves)
