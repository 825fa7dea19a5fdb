"""The study of Figs. 9 and 10, to which the modules beside this one add its claims."""

from __future__ import annotations

from compare.claims.study import Study
from compare.studies.disc.fig09.pictures import draw
from compare.studies.disc.fig09.theory import RING, SOURCE, curves

STUDY = Study.beside(
    __file__,
    "fig09",
    source=SOURCE,
    system=RING,
    seconds=7.0,
    words={"own": f"{RING.offset:g}"},
)
STUDY.provides(figures=draw, curves=curves)
