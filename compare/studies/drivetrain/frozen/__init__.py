"""The car's drivetrain at frozen speeds: onset, self-centring, whirl on the stop, and modulation of a whirl."""

from compare.studies.drivetrain.frozen import steady, whirls
from compare.studies.drivetrain.frozen.pictures import draw
from compare.studies.drivetrain.frozen.theory import STUDY

STUDY.provides(figures=draw)

__all__ = ["STUDY", "steady", "whirls"]
