"""Eq. 6 to 9: where the pin sticks permanently, when it is released elsewhere, and the resonance of both."""

from compare.studies.pin.sticking_domain.study import STUDY

__all__ = ["STUDY"]
