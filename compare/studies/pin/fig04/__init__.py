"""Fig. 4: the shift of the whirl by a small offset, eq. 18, and the exact first-order response."""

from compare.studies.pin.fig04.pictures import draw
from compare.studies.pin.fig04.study import STUDY

STUDY.provides(figures=draw)

__all__ = ["STUDY"]
