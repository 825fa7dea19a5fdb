"""What the error bars of all claims are worth: true errors of random motions beside their estimates."""

from compare.studies.engines.error_estimates.pictures import draw
from compare.studies.engines.error_estimates.study import STUDY

STUDY.provides(figures=draw)

__all__ = ["STUDY"]
