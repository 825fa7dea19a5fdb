"""Eq. 6 to 9: where the pin sticks to the disc for ever, when it lets go elsewhere, and the resonance of both."""

from compare.studies.pin.sticking_domain.study import STUDY

__all__ = ["STUDY"]
