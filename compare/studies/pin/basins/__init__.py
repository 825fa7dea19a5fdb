"""How likely the whirl is: the basins of Fig. 5, their boundary, and how they change with the speed."""

from compare.studies.pin.basins.pictures import draw
from compare.studies.pin.basins.study import STUDY

STUDY.provides(figures=draw)

__all__ = ["STUDY"]
