"""How fast the engines converge: in tolerance, in step, and in the slip speed that smooths the friction law."""

from compare.studies.engines.engine_convergence.claims import STUDY

__all__ = ["STUDY"]
