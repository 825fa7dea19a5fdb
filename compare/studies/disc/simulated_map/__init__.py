"""The surroundings of Fig. 11 by simulation: what thousands of discs end in, under the stability map's curves."""

from compare.studies.disc.simulated_map.pictures import draw
from compare.studies.disc.simulated_map.study import STUDY

STUDY.provides(figures=draw)

__all__ = ["STUDY"]
