"""Fig. 8 and eqs. (24) to (26): the self-centred equilibrium against the friction force."""

from compare.studies.disc.fig08.pictures import curves, draw
from compare.studies.disc.fig08.study import STUDY

STUDY.provides(figures=draw, curves=curves)
