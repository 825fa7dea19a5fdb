"""Figs. 5, 6, 8 and 11 at the size and speed of a clutch: the same motions, with the same verdicts."""

from compare.studies.engines.clutch_scale.pictures import draw
from compare.studies.engines.clutch_scale.study import STUDY

STUDY.provides(figures=draw)

__all__ = ["STUDY"]
