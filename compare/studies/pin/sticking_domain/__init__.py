"""Eqs. (6) to (9): where the pin sticks permanently, when it is released elsewhere, and the resonance of both."""

from compare.studies.pin.sticking_domain.pictures import draw
from compare.studies.pin.sticking_domain.study import STUDY, curves

STUDY.provides(figures=draw, curves=curves)

__all__ = ["STUDY"]
