"""An isolated drivetrain of the project's parts, on every kind of node, keeps its angular momentum."""

from compare.studies.drivetrain.momentum.study import STUDY as STUDY
