"""A block on a plane at rest: thrown, held, released, on a spring, and pulled."""

from compare.studies.plane.block.pictures import draw
from compare.studies.plane.block.study import STUDY

STUDY.provides(figures=draw)
