"""Energy: what the drive puts in is heat and stored energy, on every kind of trajectory and without a reference."""

from compare.studies.engines.power_balance.pictures import draw
from compare.studies.engines.power_balance.study import STUDY

STUDY.provides(figures=draw)

__all__ = ["STUDY"]
