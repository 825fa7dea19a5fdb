"""A ring thrown on a table at rest: sliding and spinning end together, in a ratio independent of the start."""

from compare.studies.disc.free_ring.pictures import draw
from compare.studies.disc.free_ring.study import STUDY

STUDY.provides(figures=draw)

__all__ = ["STUDY"]
