"""Plain motions: state by state beside the reference, and whether velocities and forces add up along them."""

from compare.studies.engines.trajectories.pictures import draw
from compare.studies.engines.trajectories.study import STUDY

STUDY.provides(figures=draw)

__all__ = ["STUDY"]
