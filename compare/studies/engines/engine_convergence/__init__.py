"""How fast the engines converge: in tolerance, in step, and in the slip speed that smooths the friction law."""

from compare.studies.engines.engine_convergence.pictures import draw
from compare.studies.engines.engine_convergence.study import STUDY

STUDY.provides(figures=draw)

__all__ = ["STUDY"]
