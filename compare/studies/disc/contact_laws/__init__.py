"""Contact laws of the disc, eqs. (20) to (23)."""

from compare.studies.disc.contact_laws.pictures import draw
from compare.studies.disc.contact_laws.study import STUDY

STUDY.provides(figures=draw)
