"""Fig. 8 and eq. 24 to 26: place and spin of the self-centred disc over the friction force, and where it ends."""

from compare.studies.disc.fig08.pictures import draw
from compare.studies.disc.fig08.study import STUDY

STUDY.provides(figures=draw)

__all__ = ["STUDY"]
