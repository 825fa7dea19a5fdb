"""Discs that stick to the master disc: inside of the radius (9) for ever, outside until (7) lets them go."""

from __future__ import annotations

import functools
import math
from collections.abc import Sequence

import numpy as np

from compare.claims.error_estimates import COARSENING, ROUNDING, refined
from compare.claims.linearised_flow import rotated
from compare.claims.measured import Measured, answers_of, asked
from compare.engines import Engine
from compare.studies.disc.fig09.claims.study import STUDY
from compare.studies.disc.fig09.theory import (
    INSIDE,
    LATEST,
    OUTSIDE,
    RING,
    STICK_LOADS,
    TOLERANCE,
    orbit_of_reference,
    stuck_at,
)
from compare.studies.toolkit.self_centred import with_load
from compare.studies.toolkit.sticking import first_release
from reference_model import Trajectory
from reference_model.systems import FloatArray

REVOLUTION = 2.0 * math.pi / RING.disc_speed
"""In s: the period of what holds a disc that sticks."""


@STUDY.claim(
    "A disc stuck at 0.98 of the radius (9) turns with the master disc for ever",
    equation="(9)",
    resolution=1e-2,
    note="After a revolution: displacement on the master disc in units of the radius, turn against it in rad, spin "
    "against it in units of ω; and the number of phases that do not stick. What holds the disc has the period of a "
    "revolution. In (9) stands the force that friction can give beside the moment b(ω − Ω). Error: the change at a "
    "smaller tolerance, by which a law that only approximates stick shows its creep.",
    basis="reference",
    swept=("friction_force",),
)
def sticks(engine: Engine, loads: Sequence[float] = STICK_LOADS) -> Measured:
    """Follow discs that stick inside the radius (9) for a revolution."""
    discs = [with_load(RING, load) for load in loads]
    starts = [stuck_at(disc, INSIDE)[0] for disc in discs]

    @functools.cache
    def runs(tolerance: float) -> list[Trajectory]:
        motions = [(disc, start, [0.0, REVOLUTION]) for disc, start in zip(discs, starts, strict=True)]
        return engine.simulate_many(motions, tolerance=tolerance)

    def departures(tolerance: float) -> FloatArray:
        rows = []
        for run, start in zip(runs(tolerance), starts, strict=True):
            away = rotated(run.at_end, -2.0 * math.pi) - start
            size = float(np.hypot(*start[:2]))
            rows.append((*away[:3] / (size, size, 1.0), away[-1] / RING.disc_speed))
        return np.array(rows)

    def slips(tolerance: float) -> float:
        return float(sum(phase.kind != "stick" for run in runs(tolerance) for phase in run.phases))

    found = refined(departures, TOLERANCE)
    change = abs(slips(TOLERANCE / COARSENING) - slips(TOLERANCE))
    parts = ("x", "y", "turn", "spin")
    return Measured(
        predicted=np.zeros(found.value.size + 1),
        value=np.append(found.value.ravel(), slips(TOLERANCE)),
        # Departures of zero have no scale of their own for rounding.
        error=np.append(found.largest + ROUNDING + np.zeros(found.value.size), change),
        components=[*(f"{part} at μN = {load:g} N" for load in loads for part in parts), "phases that slip"],
        data={
            "stick load": loads,
            "stuck": [(run.radius[-1], run.at_end[-1]) for run in runs(TOLERANCE)],
        },
    )


@STUDY.claim(
    "A disc stuck at 1.02 and at 1.5 of the radius (9) is let go at the time of (7)",
    equation="(7)",
    unit="rad",
    resolution=1e-2,
    note="Turn of the master disc until the end of the first stick phase, after a start where the least force holds "
    "the disc. In (7) stands the force that friction can give beside the moment b(ω − Ω).",
    basis="reference",
    swept=("friction_force",),
)
def releases(engine: Engine, loads: Sequence[float] = STICK_LOADS) -> Measured:
    """Compare when discs outside of the radius (9) are let go with (7)."""
    cases = [(load, share) for load in loads for share in OUTSIDE]
    starts = [(with_load(RING, load), *stuck_at(with_load(RING, load), share)) for load, share in cases]

    def turns(tolerance: float) -> list[float]:
        motions = [(disc, start, [0.0, LATEST * release]) for disc, start, release in starts]
        runs = engine.simulate_many(motions, tolerance=tolerance)
        return [run.system.disc_speed * first_release(run) for run in runs]

    found = refined(turns, TOLERANCE)
    return Measured(
        predicted=[disc.disc_speed * release for disc, _, release in starts],
        value=found.value,
        error=found.largest + ROUNDING,
        components=[f"μN = {load:g} N, {share:g} of the radius" for load, share in cases],
    )


@STUDY.claim(
    "Sticking and a whirl that never sticks exist for the same parameters",
    equation="(9), (11)",
    note="Whether a start stuck at half the radius (9) sticks all the time, for a turn, and one on the whirl slides "
    "all the time, for ten.",
)
def coexist(engine: Engine) -> Measured:
    """See whether for the largest friction force a disc sticks for a revolution and whirls without sticking."""
    load = STICK_LOADS[-1]
    start, _ = stuck_at(with_load(RING, load), 0.5)
    orbit = orbit_of_reference(load, 0)

    def sticks_and_slides(tolerance: float) -> list[bool]:
        stays = engine.simulate(with_load(RING, load), start, [0.0, REVOLUTION], tolerance=tolerance)
        whirl = engine.simulate(orbit.system, orbit.state, [0.0, 10.0 * orbit.period], tolerance=tolerance)
        return [
            all(phase.kind == kind for phase in run.phases)
            for run, kind in ((stays, "stick"), (whirl, "slip"))
        ]

    return answers_of(*asked(sticks_and_slides, TOLERANCE), system=orbit.system)
