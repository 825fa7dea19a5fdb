"""Map of the stability of steady motions of the centred disc."""

# ruff: noqa: I001 - the order of the report
from compare.studies.disc.stability_map import regions, borders
from compare.studies.disc.stability_map.pictures import draw
from compare.studies.disc.stability_map.theory import STUDY

STUDY.provides(figures=draw)

__all__ = ["STUDY", "borders", "regions"]
