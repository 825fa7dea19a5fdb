"""The study of the free ring, to which the modules beside this one add its claims."""

from __future__ import annotations

from compare.claims.study import Study
from compare.studies.disc.free_ring.parameters import SOURCE
from compare.studies.disc.free_ring.pictures import draw
from compare.studies.disc.free_ring.theory import curves

STUDY = Study.beside(__file__, "free-ring", source=SOURCE, seconds=2.0)
STUDY.provides(figures=draw, curves=curves)
