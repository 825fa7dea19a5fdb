"""The modulated cycle itself on the continuous ring: its period, its turn about the axis and its extremes."""

from __future__ import annotations

import functools

from compare.claims.error_estimates import Measurement, known, refined
from compare.claims.measured import Measured
from compare.engines import Engine
from compare.studies.disc.fig11.claims.study import STUDY
from compare.studies.disc.fig11.parameters import EXTREMES, OF_CYCLE, TIMES, UNTIL
from compare.studies.disc.fig11.theory import last_modulation, predicted_modulation
from compare.studies.toolkit.fig11_motion import RING, START
from reference_model import Trajectory

NOTE = (
    f"The last modulation within {UNTIL:g} s, from one maximum of the radius to the next. Predicted: (19) as it "
    "stands, integrated at a tolerance of 1e-12. Error: the change at a smaller tolerance, and the change from the "
    "modulation before, of both."
)


@STUDY.claim(
    "The modulation on the continuous ring has the period, and the turn within it, that (19) gives",
    equation="(19)–(21)",
    kind="trajectory",
    unit="s, rad",
    resolution=1e-3,
    note=NOTE,
    named={"period of the modulation": 0, "turn in it": 1},
)
def period_and_turn(engine: Engine) -> Measured:
    """Compare period and turn of the last modulation with those of an integration of (19) as it stands."""
    found = modulation(engine)
    return Measured(
        predicted=predicted_modulation()[0][:2],
        value=found.value[:2],
        error=found.error[:2],
        components=("period in s", "turn in rad"),
        data={"the continuous ring": _run(engine, OF_CYCLE).states},
    )


@STUDY.claim(
    "The modulated cycle on the continuous ring has the least and greatest radius and spin that (19) gives",
    equation="(19)–(21)",
    kind="trajectory",
    unit="m, rad/s",
    resolution=1e-6,
    note=NOTE,
)
def extremes(engine: Engine) -> Measured:
    """Compare the extremes of the last modulation with those of an integration of (19) as it stands."""
    found = modulation(engine)
    return Measured(
        predicted=predicted_modulation()[0][2:],
        value=found.value[2:],
        error=found.error[2:],
        components=EXTREMES,
    )


@functools.lru_cache(maxsize=4)
def modulation(engine: Engine) -> Measurement:
    """Return the last modulation of the motion, as ``last_modulation`` does, with the error of both sides."""
    found = refined(
        lambda tolerance: last_modulation(_run(engine, tolerance).states)[0], OF_CYCLE, alike=False
    )
    error = found.error + predicted_modulation()[1] + last_modulation(_run(engine, OF_CYCLE).states)[1]
    return Measurement(found.value, known(found.value, error))


@functools.lru_cache(maxsize=4)
def _run(engine: Engine, tolerance: float) -> Trajectory:
    return engine.simulate(RING, START, TIMES, tolerance=tolerance)
