"""Fig. 5: equilibrium and whirl side by side, the stick phases on the way, and the start that divides them."""

from compare.studies.pin.fig05.claims import STUDY

__all__ = ["STUDY"]
