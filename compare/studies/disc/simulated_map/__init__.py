"""The surroundings of Fig. 11 by simulation: what thousands of discs end in, under the stability map's curves."""

from compare.studies.disc.simulated_map.claims import STUDY

__all__ = ["STUDY"]
