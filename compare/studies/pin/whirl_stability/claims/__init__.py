"""Eq. 11 to 16: the whirl without offset, where it exists, and how deviations from it develop."""

from compare.studies.pin.whirl_stability.claims import conditions, motions
from compare.studies.pin.whirl_stability.claims.study import STUDY

__all__ = ["STUDY", "conditions", "motions"]
