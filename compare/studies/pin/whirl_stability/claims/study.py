"""The study itself, to which all claims belong."""

from __future__ import annotations

from compare.claims.study import Study
from compare.studies.pin.whirl_stability.parameters import PIN, SOURCE
from compare.studies.pin.whirl_stability.pictures import draw
from compare.studies.pin.whirl_stability.theory import curves

STUDY = Study.beside(
    __file__,
    "whirl-stability",
    source=SOURCE,
    system=PIN,
    seconds=2.5,
    quick=True,
    contact=True,
)
STUDY.provides(figures=draw, curves=curves)
