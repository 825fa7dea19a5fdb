"""The study that the claims are declared in."""

from __future__ import annotations

from compare.claims.study import Study
from compare.studies.drivetrain.frozen.pictures import draw
from compare.studies.drivetrain.frozen.theory import BORDER_SURPLUS, BORDER_TORQUES, curves
from compare.studies.toolkit.drivetrain_bench import SOURCE

STUDY = Study.beside(
    __file__,
    "drivetrain-frozen",
    words={
        "surplus": f"{100.0 * BORDER_SURPLUS:g}",
        "low": f"{BORDER_TORQUES[0]:g}",
        "high": f"{BORDER_TORQUES[-1]:g}",
    },
    source=SOURCE,
    only=("exudyn",),
    seconds=4.0,
)
STUDY.provides(figures=draw, curves=curves)
