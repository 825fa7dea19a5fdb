"""A ring thrown on a table at rest."""

from compare.studies.disc.free_ring.pictures import draw
from compare.studies.disc.free_ring.study import STUDY

STUDY.provides(figures=draw)
