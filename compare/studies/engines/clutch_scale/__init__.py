"""Figs. 5, 6, 8 and 11 at the size and speed of a clutch: the same motions, with the same verdicts."""

from compare.studies.engines.clutch_scale.claims import STUDY

__all__ = ["STUDY"]
