"""A support that hardens or has a stop: what limits the amplitude "in practical application"."""

from compare.studies.pin.nonlinear_support.study import STUDY

__all__ = ["STUDY"]
