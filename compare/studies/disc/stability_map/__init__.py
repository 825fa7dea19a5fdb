"""Map of the regions where steady motions of the centred disc are stable, or the modulated cycle replaces them."""

# ruff: noqa: I001 - the order of the report
from compare.studies.disc.stability_map import regions, borders
from compare.studies.disc.stability_map.pictures import draw
from compare.studies.disc.stability_map.theory import STUDY

STUDY.provides(figures=draw)

__all__ = ["STUDY", "borders", "regions"]
