"""Fig. 3 and eq. 3 to 5: the pin at rest in space on the semicircle, its stability, and the loss of it."""

from compare.studies.pin.fig03.pictures import draw
from compare.studies.pin.fig03.study import STUDY

STUDY.provides(figures=draw)

__all__ = ["STUDY"]
