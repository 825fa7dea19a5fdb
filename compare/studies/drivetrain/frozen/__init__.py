"""The car's drivetrain at frozen speeds: onset, self-centring, whirl on the stop, and where a whirl is modulated."""

from compare.studies.drivetrain.frozen import steady, whirls
from compare.studies.drivetrain.frozen.pictures import draw
from compare.studies.drivetrain.frozen.theory import STUDY

STUDY.provides(figures=draw)

__all__ = ["STUDY", "steady", "whirls"]
