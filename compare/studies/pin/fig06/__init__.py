"""Fig. 6: equilibrium, sticking and whirl under increasing friction force, and where each of them ends."""

from compare.studies.pin.fig06.pictures import draw
from compare.studies.pin.fig06.study import STUDY

STUDY.provides(figures=draw)

__all__ = ["STUDY"]
