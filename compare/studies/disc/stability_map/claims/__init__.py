"""Where steady motions of the centred disc are stable, and where the modulated cycle of Fig. 11 takes their place."""

# ruff: noqa: I001 - the order of the report
from compare.studies.disc.stability_map.claims import beside, regions, borders, laws
from compare.studies.disc.stability_map.claims.study import STUDY

__all__ = ["STUDY", "beside", "borders", "laws", "regions"]
