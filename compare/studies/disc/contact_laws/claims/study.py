"""The study of the laws of contact, to which the modules beside this one add its claims."""

from __future__ import annotations

from compare.claims.study import Study
from compare.studies.disc.contact_laws.parameters import SOURCE
from compare.studies.disc.contact_laws.pictures import draw
from compare.studies.disc.contact_laws.theory import curves

STUDY = Study.beside(
    __file__,
    "contact-laws",
    source=SOURCE,
    seconds=1.5,
    quick=True,
    contact=True,
)
STUDY.provides(figures=draw, curves=curves)
