"""For which offset the modulated cycle of Fig. 11 exists: between steady whirl and self-centred equilibrium."""

from __future__ import annotations

import functools
import math
from collections.abc import Sequence

import numpy as np

from compare.claims.error_estimates import WORKING, Measurement, known, refined
from compare.claims.measured import Measured, answers_of, asked
from compare.claims.parameters import at_each
from compare.engines import Engine
from compare.studies.disc.fig11.claims.study import STUDY
from compare.studies.disc.fig11.parameters import (
    ENDS_TOLERANCE,
    ENDS_UNTIL,
    KINDS,
    LOOKED_AT,
    OFFSETS,
    ORBITS_EXTENT,
    SAMPLES_A_TURN,
    SWING,
    TRIED,
    WITHOUT_ANGLE,
)
from compare.studies.disc.fig11.theory import (
    critical_offset,
    disc_at,
    extents,
    multipliers_by_variation,
    pair_modulus,
    rest_offset,
)
from compare.studies.toolkit.fig11_motion import RING, SOURCE, START, rates
from reference_model import Orbit


@STUDY.claim(
    "The whirl is unstable below a critical X0, where a pair of Floquet multipliers crosses the unit circle",
    equation="(19)–(21)",
    kind="trajectory",
    unit="m",
    resolution=1e-3 * TRIED[1],
    note="Measured: whirls with an offset are found by shooting with the engine, for "
    f"{at_each('X0', TRIED)} m, and their multipliers by differences. Predicted: what one step of Newton's "
    "method makes of that X0 with multipliers from the variational equations, integrated with the analytic "
    "Jacobian. Error: the change at a smaller tolerance, that by a straight line for the interpolation, and how "
    "much the linearised return map changes a shift in time.",
    named={"critical offset": 0},
    swept=("offset",),
)
def critical(engine: Engine) -> Measured:
    """Compare the critical X0 by the multipliers of the engine's own whirl with that by exact ones."""
    predicted, found = critical_of(engine)
    return Measured(predicted=predicted, value=found.value, error=found.error, source=SOURCE)


@functools.lru_cache(maxsize=4)
def critical_of(engine: Engine) -> tuple[float, Measurement]:
    """Return the critical X0 in m by exact multipliers and by the engine's own; no numbers where there is none."""
    found = functools.cache(lambda tolerance: critical_offset(engine, tolerance))
    try:
        measured, error = refined(lambda tolerance: found(tolerance)[0])
        _, interpolation, slope, near = found(WORKING)
        exact = multipliers_by_variation(disc_at(float(measured)), near)
    except RuntimeError:  # no whirl, or none that could be critical
        return math.nan, Measurement(np.array(math.nan), np.array(0.0))
    error = error + interpolation + error_of_monodromy(near) / abs(slope)
    predicted = float(measured) - (pair_modulus(exact) - 1.0) / slope
    return predicted, Measurement(measured, known(measured, error))


def error_of_monodromy(orbit: Orbit) -> float:
    """Return about how wrong the linearised return map is: it should leave a shift in time as it is."""
    shift = np.array(rates(disc_at(orbit.system.offset), orbit.state))[WITHOUT_ANGLE]
    change = orbit.monodromy @ shift - shift
    # One direction of as many as there are states.
    return math.sqrt(len(shift)) * float(np.linalg.norm(change) / np.linalg.norm(shift))


@STUDY.claim(
    "Motions end modulated at small offsets, as a steady whirl at larger ones, and at rest beyond those",
    equation="(19)–(21)",
    note=f"From the last {LOOKED_AT:g} of {ENDS_UNTIL:g} s: the spin, averaged over a turn, swings by more than "
    f"{SWING:g} rad/s, or the radius by more than {ORBITS_EXTENT:g} m. Predicted: from the critical X0 and from the "
    "one at which an eigenvalue of the self-centred equilibrium crosses zero.",
    basis="reference",
    swept=("offset",),
)
def ends(engine: Engine, offsets: Sequence[float] = OFFSETS) -> Measured:
    """See what the motion ends in at ``offsets`` in m."""
    critical, _ = critical_of(engine)
    predicted = [2 if offset < critical else 1 if offset < rest_offset() else 0 for offset in offsets]
    extents: dict[float, list[list[float]]] = {}

    def as_predicted(tolerance: float) -> list[bool]:
        found = [end_of(engine, offset, tolerance=tolerance) for offset in offsets]
        extents[tolerance] = [extent for extent, _ in found]
        return [kind == KINDS[expected] for (_, kind), expected in zip(found, predicted, strict=True)]

    return answers_of(
        *asked(as_predicted, ENDS_TOLERANCE),
        note=f"{', '.join(KINDS[kind] for kind in predicted)} for {at_each('X0', offsets)} m; the last one is that "
        "of the other figures.",
        data={"offsets": offsets, "extents": extents[ENDS_TOLERANCE]},
    )


def end_of(
    engine: Engine, offset: float, start: tuple[float, ...] = START, tolerance: float = ENDS_TOLERANCE
) -> tuple[list[float], str]:
    """Return least and greatest radius and spin in the end, and its kind, one of ``KINDS``."""
    step = 2.0 * math.pi / RING.natural_frequency / SAMPLES_A_TURN
    run = engine.simulate(disc_at(offset), start, np.arange(0.0, ENDS_UNTIL, step), tolerance=tolerance)
    found = extents(run, round(LOOKED_AT / step))
    averaged = np.convolve(run.states[:, 5], np.full(SAMPLES_A_TURN, 1.0 / SAMPLES_A_TURN), "valid")
    swing = np.ptp(averaged[-round(LOOKED_AT / step) :])
    kind = "modulated" if swing > SWING else "whirl" if found[1] - found[0] > ORBITS_EXTENT else "rest"
    return found, kind
