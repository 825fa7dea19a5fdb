"""Eqs. (6) to (9): permanent stick, release, and their resonance."""

from compare.studies.pin.sticking_domain.pictures import draw
from compare.studies.pin.sticking_domain.study import STUDY, curves

STUDY.provides(figures=draw, curves=curves)
