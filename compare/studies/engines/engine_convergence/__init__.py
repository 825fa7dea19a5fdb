"""Convergence of the engines with the tolerance, the step, and the slip speed that regularises friction."""

from compare.studies.engines.engine_convergence.pictures import draw
from compare.studies.engines.engine_convergence.study import STUDY

STUDY.provides(figures=draw)

__all__ = ["STUDY"]
