"""Fig. 11: the whirl whose radius and spin swell and shrink, how it comes about, and for which offsets."""

from compare.studies.disc.fig11.claims import STUDY

__all__ = ["STUDY"]
