"""Fig. 6: equilibrium, sticking and whirl under increasing friction force, and where each of them ends."""

from compare.studies.pin.fig06.claims import STUDY

__all__ = ["STUDY"]
