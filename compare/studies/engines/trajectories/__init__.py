"""Simple motions: states, and integrals of velocities and forces."""

from compare.studies.engines.trajectories.pictures import draw
from compare.studies.engines.trajectories.study import STUDY

STUDY.provides(figures=draw)
