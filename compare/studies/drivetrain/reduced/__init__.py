"""The drivetrain whose engine and vehicle can't be slowed, beside the paper's disc."""

from compare.studies.drivetrain.reduced.claims import STUDY

__all__ = ["STUDY"]
