"""Simple motions: all states compared with the reference, and integrals of velocities and forces along them."""

from compare.studies.engines.trajectories.pictures import draw
from compare.studies.engines.trajectories.study import STUDY

STUDY.provides(figures=draw)

__all__ = ["STUDY"]
