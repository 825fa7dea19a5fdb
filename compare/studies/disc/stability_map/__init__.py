"""Where steady motions of the centred disc are stable, and where the modulated cycle of Fig. 11 takes their place."""

from compare.studies.disc.stability_map.claims import STUDY

__all__ = ["STUDY"]
