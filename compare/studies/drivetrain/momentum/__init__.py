"""An isolated drivetrain of public parts, of every kind of node: its angular momentum does not change."""

from compare.studies.drivetrain.momentum.claims import STUDY

__all__ = ["STUDY"]
