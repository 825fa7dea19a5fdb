"""A support that hardens or has a stop, which limits the amplitude in practical applications."""

from compare.studies.pin.nonlinear_support.study import STUDY

__all__ = ["STUDY"]
