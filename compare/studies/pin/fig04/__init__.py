"""Fig. 4: the shift of the whirl by a small offset, eq. 18, and the exact first-order response."""

from compare.studies.pin.fig04.claims import STUDY

__all__ = ["STUDY"]
