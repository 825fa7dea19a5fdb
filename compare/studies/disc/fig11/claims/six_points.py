"""The modulated motion on six points, of which single ones come to rest."""

from __future__ import annotations

import functools

import numpy as np

from compare.claims.error_estimates import known, refined
from compare.claims.measured import Measured
from compare.engines import Engine, StatesOnly, UnsupportedSystemError
from compare.studies.disc.fig11.claims.study import STUDY
from compare.studies.disc.fig11.parameters import EXTREMES, OF_RESTS, ROUND, TIMES
from compare.studies.disc.fig11.theory import extremes_of
from compare.studies.toolkit.fig11_motion import SIX, START
from reference_model import Trajectory, simulate
from reference_model.systems import FloatArray

NOTE = f"Within {ROUND[-1]:g} s. Predicted: the reference at 1e-11."


@STUDY.claim(
    "Single points of six, about which the disc then turns, come to rest when the reference says",
    equation="(19)–(21)",
    kind="trajectory",
    unit="s",
    resolution=1e-2,
    note=f"{NOTE} A rest too many or too few shows as a missing number.",
)
def points_rest(engine: Engine) -> Measured:
    """Compare when single points come to rest and let go with when they do in the reference."""
    if isinstance(_run(engine, OF_RESTS), StatesOnly):
        raise UnsupportedSystemError(f"{engine.name} does not tell when single points rest")
    predicted = rests_of_points(_reference())

    def rests(tolerance: float) -> FloatArray:
        found = rests_of_points(_run(engine, tolerance))
        return found if len(found) == len(predicted) else np.full(len(predicted), np.nan)

    found = refined(rests, OF_RESTS)
    longer = engine.simulate(SIX, START, TIMES, tolerance=OF_RESTS)
    return Measured(
        predicted=predicted,
        value=found.value,
        error=float(np.max(known(found.value, found.error))),
        components=[
            f"{what} {1 + i}" for i in range(len(predicted) // 2) for what in ("start of rest", "end of rest")
        ],
        system=SIX,
        data={"six points": longer.states, "six points: rests": rests_of_points(longer)},
    )


@STUDY.claim(
    "Within 300 s the motion on six points has the least and greatest radius and spin that the reference gives",
    equation="(19)–(21)",
    kind="trajectory",
    unit="m, rad/s",
    resolution=1e-5,
    note=NOTE,
)
def extremes_on_six_points(engine: Engine) -> Measured:
    """Compare the extremes over one modulation with those of the reference."""
    found = refined(lambda tolerance: extremes_of(_run(engine, tolerance)), OF_RESTS, alike=False)
    return Measured(
        predicted=extremes_of(_reference()),
        value=found.value,
        error=found.largest,
        components=EXTREMES,
        system=SIX,
    )


def rests_of_points(trajectory: Trajectory) -> FloatArray:
    """Return when single points come to rest and let go, in s, one after the other, shape (2·rests,)."""
    return np.ravel([(phase.start, phase.end) for phase in trajectory.phases if phase.kind == "pivot"])


@functools.lru_cache(maxsize=4)
def _run(engine: Engine, tolerance: float) -> Trajectory:
    return engine.simulate(SIX, START, ROUND, tolerance=tolerance)


@functools.cache
def _reference() -> Trajectory:
    return simulate(SIX, START, ROUND, tolerance=1e-11)
