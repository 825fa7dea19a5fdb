"""The study of Fig. 11, to which the modules beside this one add its claims."""

from __future__ import annotations

from compare.claims.parameters import FIG8
from compare.claims.study import Study
from compare.studies.disc.fig11.parameters import BOTH_STABLE, FROM_THE_CYCLE
from compare.studies.disc.fig11.pictures import draw
from compare.studies.disc.fig11.theory import curves
from compare.studies.toolkit.fig11_motion import RING

STUDY = Study.beside(
    __file__,
    "fig11",
    source=FROM_THE_CYCLE,
    system=RING,
    seconds=5.0,
    words={"both_stable": f"{BOTH_STABLE:g}", "other_offset": f"{FIG8.offset:g}"},
)
STUDY.provides(figures=draw, curves=curves)
