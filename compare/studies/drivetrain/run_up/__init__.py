"""The car's drivetrain runs up from idle to 6000 rpm with a controlled slip of the clutch."""

from compare.studies.drivetrain.run_up.pictures import animations, draw
from compare.studies.drivetrain.run_up.study import STUDY

STUDY.provides(figures=draw, animations=animations)
