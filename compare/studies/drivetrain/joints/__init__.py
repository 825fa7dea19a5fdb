"""A joint with friction: it stops, holds, breaks away, swings and turns back."""

from compare.studies.drivetrain.joints.pictures import draw
from compare.studies.drivetrain.joints.study import STUDY

STUDY.provides(figures=draw)
