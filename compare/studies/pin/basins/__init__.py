"""How likely the whirl is: the basins of Fig. 5, their boundary, and how they change with the speed."""

from compare.studies.pin.basins.study import STUDY

__all__ = ["STUDY"]
