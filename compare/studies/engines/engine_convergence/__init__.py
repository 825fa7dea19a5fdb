"""Convergence of the engines with tolerance, step and regularisation."""

from compare.studies.engines.engine_convergence.pictures import draw
from compare.studies.engines.engine_convergence.study import STUDY

STUDY.provides(figures=draw)
