"""Claims on the motion of Fig. 11 with an offset, and on six points."""

from __future__ import annotations

import functools
import math
from collections.abc import Sequence

import numpy as np

import compare.studies.disc.fig11.parameters as parameters
from compare.claims import WORKING, Measured, Measurement, answers_of, asked, known, refined
from compare.claims.parameters import at_each
from compare.engines import Engine, StatesOnly, UnsupportedSystemError
from compare.studies.disc.fig11.parameters import STUDY
from compare.studies.disc.fig11.theory import (
    critical_offset,
    disc_at,
    extents,
    extremes_of,
    multipliers_by_variation,
    pair_modulus,
    rest_offset,
)
from compare.studies.toolkit.fig11 import RING, SIX, SOURCE, START, rates
from reference_model import Orbit, Trajectory, simulate
from reference_model.systems import FloatArray

# --- Ends of the motion over the offset


@STUDY.claim(
    "The whirl is unstable below a critical X0, where a pair of Floquet multipliers crosses the unit circle",
    equation="(19)–(21)",
    kind="trajectory",
    unit="m",
    resolution=1e-3 * parameters.TRIED[1],
    note="Measured: whirls with an offset by shooting with the engine, for "
    f"{at_each('X0', parameters.TRIED)} m, and their multipliers by differences. Predicted: the result of one Newton "
    "step from that X0 with multipliers from the variational equations, integrated with the "
    "analytic Jacobian. Error: the change at a smaller tolerance, the change with linear "
    "interpolation, and the change of a time shift by the linearised return map.",
    named={"critical offset": 0},
    swept=("offset",),
)
def critical(engine: Engine) -> Measured:
    predicted, found = critical_of(engine)
    return Measured(predicted=predicted, value=found.value, error=found.error, source=SOURCE)


@functools.lru_cache(maxsize=4)
def critical_of(engine: Engine) -> tuple[float, Measurement]:
    """Return the critical X0 in m by exact multipliers and by the engine's, NaN if there is none."""
    found = functools.cache(lambda tolerance: critical_offset(engine, tolerance))
    try:
        measured, error = refined(lambda tolerance: found(tolerance)[0])
        _, interpolation, slope, near = found(WORKING)
        exact = multipliers_by_variation(disc_at(float(measured)), near)
    except RuntimeError:  # no whirl, or no critical one
        return math.nan, Measurement(np.array(math.nan), np.array(0.0))
    error = error + interpolation + error_of_monodromy(near) / abs(slope)
    predicted = float(measured) - (pair_modulus(exact) - 1.0) / slope
    return predicted, Measurement(measured, known(measured, error))


def error_of_monodromy(orbit: Orbit) -> float:
    """Return an estimated relative error of the linearised return map, which should preserve a shift in time."""
    shift = np.array(rates(disc_at(orbit.system.offset), orbit.state))[parameters.WITHOUT_ANGLE]
    change = orbit.monodromy @ shift - shift
    # The shift is one of len(shift) directions.
    return math.sqrt(len(shift)) * float(np.linalg.norm(change) / np.linalg.norm(shift))


@STUDY.claim(
    "Motions end modulated at small offsets, as a steady whirl at larger offsets, and at rest beyond",
    equation="(19)–(21)",
    note=f"In the last {parameters.LOOKED_AT:g} of {parameters.ENDS_UNTIL:g} s, the spin averaged over a "
    f"turn oscillates by more than {parameters.SWING:g} rad/s, or the radius by more than "
    f"{parameters.ORBITS_EXTENT:g} m. Predicted: from the critical X0, and from the X0 at which an eigenvalue of "
    "the self-centred equilibrium crosses zero.",
    basis="reference",
    swept=("offset",),
)
def ends(engine: Engine, offsets: Sequence[float] = parameters.OFFSETS) -> Measured:
    """``offsets`` are in m."""
    critical, _ = critical_of(engine)
    predicted = [2 if offset < critical else 1 if offset < rest_offset() else 0 for offset in offsets]
    extents: dict[float, list[list[float]]] = {}

    def as_predicted(tolerance: float) -> list[bool]:
        found = [end_of(engine, offset, tolerance=tolerance) for offset in offsets]
        extents[tolerance] = [extent for extent, _ in found]
        return [
            kind == parameters.KINDS[expected] for (_, kind), expected in zip(found, predicted, strict=True)
        ]

    return answers_of(
        *asked(as_predicted, parameters.ENDS_TOLERANCE),
        note=f"{', '.join(parameters.KINDS[kind] for kind in predicted)} for {at_each('X0', offsets)} m; the "
        "last one is that of the other figures.",
        data={"offsets": offsets, "extents": extents[parameters.ENDS_TOLERANCE]},
    )


def end_of(
    engine: Engine,
    offset: float,
    start: tuple[float, ...] = START,
    tolerance: float = parameters.ENDS_TOLERANCE,
) -> tuple[list[float], str]:
    """Return smallest and largest final radius in m and spin in rad/s, and the kind, one of ``KINDS``."""
    step = 2.0 * math.pi / RING.natural_frequency / parameters.SAMPLES_A_TURN
    run = engine.simulate(
        disc_at(offset), start, np.arange(0.0, parameters.ENDS_UNTIL, step), tolerance=tolerance
    )
    found = extents(run, round(parameters.LOOKED_AT / step))
    averaged = np.convolve(
        run.states[:, 5], np.full(parameters.SAMPLES_A_TURN, 1.0 / parameters.SAMPLES_A_TURN), "valid"
    )
    swing = np.ptp(averaged[-round(parameters.LOOKED_AT / step) :])
    kind = (
        "modulated"
        if swing > parameters.SWING
        else "whirl"
        if found[1] - found[0] > parameters.ORBITS_EXTENT
        else "rest"
    )
    return found, kind


# --- The modulated motion on six points, where single points come to rest

NOTE = f"Within {parameters.ROUND[-1]:g} s. Predicted: the reference at 1e-11."


@STUDY.claim(
    "Single points of six, about which the disc then turns, come to rest at the times of the reference",
    equation="(19)–(21)",
    kind="trajectory",
    unit="s",
    resolution=1e-2,
    note=f"{NOTE} A missing or additional rest makes all numbers missing.",
)
def points_rest(engine: Engine) -> Measured:
    if isinstance(_run(engine, parameters.OF_RESTS), StatesOnly):
        raise UnsupportedSystemError(f"{engine.name} does not report when single points rest")
    predicted = rests_of_points(_reference())

    def rests(tolerance: float) -> FloatArray:
        found = rests_of_points(_run(engine, tolerance))
        return found if len(found) == len(predicted) else np.full(len(predicted), np.nan)

    found = refined(rests, parameters.OF_RESTS)
    longer = engine.simulate(SIX, START, parameters.TIMES, tolerance=parameters.OF_RESTS)
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
    "Within 300 s, the motion on six points has the smallest and largest radius and spin of the reference",
    equation="(19)–(21)",
    kind="trajectory",
    unit="m, rad/s",
    resolution=1e-5,
    note=NOTE,
)
def extremes_on_six_points(engine: Engine) -> Measured:
    found = refined(lambda tolerance: extremes_of(_run(engine, tolerance)), parameters.OF_RESTS, alike=False)
    return Measured(
        predicted=extremes_of(_reference()),
        value=found.value,
        error=found.largest,
        components=parameters.EXTREMES,
        system=SIX,
    )


def rests_of_points(trajectory: Trajectory) -> FloatArray:
    """Return start and end in s of each rest of a single point, in order of time, shape (2·rests,)."""
    return np.ravel([(phase.start, phase.end) for phase in trajectory.phases if phase.kind == "pivot"])


@functools.lru_cache(maxsize=4)
def _run(engine: Engine, tolerance: float) -> Trajectory:
    return engine.simulate(SIX, START, parameters.ROUND, tolerance=tolerance)


@functools.cache
def _reference() -> Trajectory:
    return simulate(SIX, START, parameters.ROUND, tolerance=1e-11)
