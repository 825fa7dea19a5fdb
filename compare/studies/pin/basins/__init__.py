"""Basins of equilibrium and whirl in Fig. 5: their boundary, and their change with the speed."""

from compare.studies.pin.basins.study import STUDY

__all__ = ["STUDY"]
