"""The car's drivetrain at frozen speeds."""

from compare.studies.drivetrain.frozen import steady, whirls
from compare.studies.drivetrain.frozen.pictures import draw
from compare.studies.drivetrain.frozen.theory import STUDY

STUDY.provides(figures=draw)

__all__ = ["STUDY", "steady", "whirls"]
