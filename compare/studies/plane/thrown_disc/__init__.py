"""Discs thrown on a plane at rest while they spin: a ring, points and a full disc."""

from compare.studies.plane.thrown_disc.pictures import draw
from compare.studies.plane.thrown_disc.study import STUDY

STUDY.provides(figures=draw)

__all__ = ["STUDY"]
