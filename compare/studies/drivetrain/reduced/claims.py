"""The drivetrain with the paper's disc for a clutch: what the model gives where engine and vehicle can't be slowed.

With an engine and a vehicle of endless inertia, a clutch with one ring for a facing and a damper alone for a
torsional spring, the drivetrain is a ``DiscOnDisc``: flywheel and gearbox are the paper's master disc and shaft. The
model is the same that runs up and launches; the reference knows nothing of it.
"""

from __future__ import annotations

import functools
from collections.abc import Sequence

import numpy as np

from compare.claims.error_estimates import Measurement, observed_exponent, refined
from compare.claims.measured import Measured
from compare.claims.study import Study
from compare.engines import Engine
from compare.studies.drivetrain.reduced.model import drivetrain_motion
from compare.studies.drivetrain.reduced.parameters import (
    CASES,
    CYCLE,
    ENDLESS,
    INERTIAS,
    ORDER_TOLERANCE,
    TOLERANCE,
    UNTIL,
    Case,
)
from compare.studies.drivetrain.reduced.pictures import draw
from reference_model import simulate
from reference_model.systems import FloatArray

STUDY = Study.beside(__file__, "drivetrain-reduced", draw=draw, only=("exudyn",), seconds=2.0)


@functools.lru_cache(maxsize=32)  # one of the motions is asked for by both claims
def _motion(
    engine: Engine, case: Case, tolerance: float, inertia: float = ENDLESS
) -> tuple[FloatArray, FloatArray]:
    return drivetrain_motion(case, tolerance, inertia)


@functools.cache  # the same beside every engine
def _in_reference(name: str, times: tuple[float, ...]) -> Measurement:
    case = CASES[name]
    return refined(
        lambda tolerance: (
            simulate(case.disc, case.start, times, tolerance=tolerance, contact=case.contact).states
        ),
        TOLERANCE,
    )


@STUDY.claim(
    "A drivetrain that is reduced to a friction disc moves as the reference does: {}",
    equation="(19)",
    kind="trajectory",
    resolution=1e-7,
    note=f"x, y, angle and their rates at t = {UNTIL:g} s, in SI units. Error: the change of both between a "
    f"tolerance of {TOLERANCE:g} and eight times that, the largest of centre and of turning.",
    each=tuple(CASES),
)
def moves(engine: Engine, name: str) -> Measured:
    """Run a case for 50 s in the drivetrain and in the reference."""
    case = CASES[name]
    times, states = _motion(engine, case, TOLERANCE)
    found = refined(lambda tolerance: _motion(engine, case, tolerance)[1][-1], TOLERANCE)
    predicted = _in_reference(name, tuple(times.tolist()))
    # An error oscillates as the motion does: those of the plane and those of the turning are taken together.
    together = (found.error + predicted.error[-1]).reshape(2, 3)
    together[:, :2], together[:, 2] = together[:, :2].max(), together[:, 2].max()
    return Measured(
        predicted=predicted.value[-1],
        value=found.value,
        error=together.ravel(),
        components=("x", "y", "angle", "vx", "vy", "spin"),
        system=case.disc,
        parameters={"inner_radius": case.inner_radius},
        source=case.source,
        data={f"{name}: t": times, f"{name}: states": states, f"{name}: reference": predicted.value},
    )


@STUDY.claim(
    "The change of the modulated cycle by a finite inertia of engine and vehicle falls like 1/inertia",
    equation="(19)",
    kind="order",
    resolution=0.02,
    note=f"The change of the disc's state at t = {UNTIL:g} s, for inertias from {INERTIAS[0]:g} to {INERTIAS[-1]:g} "
    "kg m². Numerical error: scatter about the power law, and the runs' own errors; model error: its next term.",
)
def order(engine: Engine, inertias: Sequence[float] = INERTIAS) -> Measured:
    """Compare the power of the inertia with which the end of the cycle comes to that of endless inertia."""

    def end(tolerance: float, inertia: float = ENDLESS) -> FloatArray:
        return np.asarray(_motion(engine, CYCLE, tolerance, inertia)[1][-1])

    endless = end(ORDER_TOLERANCE)
    errors = np.array([np.linalg.norm(end(ORDER_TOLERANCE, inertia) - endless) for inertia in inertias])
    noise = 2.0 * float(np.linalg.norm(endless - end(TOLERANCE)))
    exponent, numerical, model = observed_exponent(
        1.0 / np.array(inertias)[::-1], errors[::-1], next_term=1.0, noise=noise
    )
    return Measured(
        predicted=1.0,
        value=exponent,
        error=numerical,
        model=model,
        system=CYCLE.disc,
        source=CYCLE.source,
        data={"inertia": inertias, "finite inertia": errors},
    )
