"""A launch of the passenger car: its clutch engages from full slip, sticks, and is opened again."""

from compare.studies.drivetrain.launch.claims import STUDY

__all__ = ["STUDY"]
