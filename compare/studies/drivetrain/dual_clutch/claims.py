"""A gear change by two clutches, in Exudyn and by SciPy."""

from __future__ import annotations

import functools

import numpy as np

from compare.claims.error_estimates import COARSENING, change_as_error
from compare.claims.measured import Measured
from compare.claims.study import Data, Study
from compare.engines import Engine
from compare.studies.drivetrain.dual_clutch.model import run
from compare.studies.drivetrain.dual_clutch.parameters import (
    DENSE,
    EPSILON,
    OFTEN,
    RADIUS,
    RATIOS,
    TIMES,
    TOLERANCE,
)
from compare.studies.drivetrain.dual_clutch.pictures import draw
from compare.studies.drivetrain.dual_clutch.theory import change
from reference_model.systems import FloatArray

SPEEDS = ("engine", "shaft of the first gear", "shaft of the second gear", "wheels")
CLUTCHES = ("first clutch", "second clutch")


def curves() -> Data:
    """Return speeds and heat by SciPy, for the figure."""
    return {"t": DENSE, "found": change()[:, 2:]}


STUDY = Study.beside(
    __file__,
    "dual-clutch",
    source="a car with a dual clutch, an assumption",
    draw=draw,
    curves=curves,
    only=("exudyn",),
    seconds=2.0,
)


@functools.lru_cache(maxsize=1)
def _runs(engine: Engine) -> tuple[FloatArray, FloatArray]:
    return run(TOLERANCE), run(TOLERANCE / COARSENING)


BY_SCIPY = (
    "Predicted: the torsional equations by SciPy, with the same ε and no part in common. Numerical error: the "
    "largest change with the tolerance of either."
)


@STUDY.claim(
    "Two clutches that hand over the torque take engine, shafts and wheels along as SciPy's equations do",
    kind="trajectory",
    basis="independent",
    unit="rad/s",
    resolution=1e-6,
    note=BY_SCIPY,
)
def moves(engine: Engine) -> Measured:
    """Compare the speeds."""
    return _beside_scipy(engine, slice(0, 4), SPEEDS, {"t": TIMES, "found": _runs(engine)[0]})


@STUDY.claim(
    "Each of two clutches heats as SciPy's equations say",
    kind="trajectory",
    basis="independent",
    unit="J",
    resolution=1e-4,
    note=BY_SCIPY,
)
def heats(engine: Engine) -> Measured:
    """Compare the heat of both."""
    return _beside_scipy(engine, slice(4, 6), CLUTCHES, {})


def _beside_scipy(engine: Engine, which: slice, names: tuple[str, ...], data: Data) -> Measured:
    predicted, finer = (change(tolerance)[OFTEN::OFTEN, 2:][:, which] for tolerance in (1e-10, 1e-11))
    found, other = (values[:, which] for values in _runs(engine))
    errors = change_as_error(found, other), change_as_error(predicted, finer)
    return Measured(
        predicted=predicted,
        value=found,
        error=sum(float(np.max(error)) for error in errors),
        components=names,
        at={"t in s": TIMES},
        data=data,
    )


@STUDY.claim(
    "After the change the engine turns with the second gear, but for the creep of a clutch that holds",
    unit="rad/s",
    resolution=0.1,
    note="Engine less ratio times wheels at the end. Model error: ε/R, the largest creep, which the shaft's "
    "oscillation, long damped, adds nothing to.",
)
def holds(engine: Engine) -> Measured:
    """Compare the speeds of engine and wheels with the ratio of the second gear."""
    engine_speed, _, _, wheels = _runs(engine)[0][-1, :4]
    return Measured(
        predicted=0.0,
        value=float(engine_speed - RATIOS[1] * wheels),
        model=EPSILON / RADIUS,
        size=engine_speed,
    )
