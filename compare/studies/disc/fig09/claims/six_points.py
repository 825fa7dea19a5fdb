"""The disc on six points, as the paper simulated it."""

from __future__ import annotations

import functools
import math
from collections.abc import Sequence

import numpy as np

from compare.claims.error_estimates import TIGHTEST, refined
from compare.claims.linearised_flow import rotated
from compare.claims.measured import Measured
from compare.engines import Engine
from compare.studies.disc.fig09.claims.searches import circle, circles_of, rest, rests_of
from compare.studies.disc.fig09.claims.study import STUDY
from compare.studies.disc.fig09.theory import (
    CENTRED,
    CIRCLES,
    OUTSIDE,
    REST_LOADS,
    RING,
    SOURCE_CENTRED,
    STICK_LOADS,
    TOLERANCE,
    circle_of,
    on_six_points,
    radius_of_pin,
    stuck_at,
)
from compare.studies.toolkit.self_centred import with_load
from reference_model import simulate
from reference_model.systems import FloatArray

REFERENCE = Engine("reference", simulate, ("points",))

BY_REFERENCE = f"Predicted by the reference at tolerance {TIGHTEST:g}."


@STUDY.claim(
    "On six points the mean whirl without offset is that of exact Coulomb friction",
    equation="(19)–(21)",
    kind="trajectory",
    resolution=1e-6,
    note=f"In units of μN/(βk), k and ω; means over the motion that comes back turned. {BY_REFERENCE}",
    swept=("friction_force",),
)
def six_circles(engine: Engine, circles: tuple[tuple[float, int], ...] = CIRCLES) -> Measured:
    """Compare the whirls on six points with those of the reference."""
    found = circles_of(engine, on_six_points(CENTRED), circles)
    predicted = np.array([_circle_of_reference(*one) for one in circles])
    beside = np.abs(predicted[:, 0] - [circle_of(*one).radius / radius_of_pin(one[0]) for one in circles])
    loads = [load for load, _ in circles]
    return Measured(
        predicted=predicted,
        value=found.value,
        error=found.error,
        at={"μN in N": loads},
        components=("radius", "frequency", "spin"),
        system=on_six_points(CENTRED),
        source=SOURCE_CENTRED,
        note=f"In radius it differs from that on the ring by {np.max(beside):.1g} near the fold, and by less than "
        "1e-9 from 0.001 N on: slip is along the circle then, at all points.",
        data={"six circle load": loads, "six circle": found.value},
    )


@functools.cache
def _circle_of_reference(load: float, which: int) -> tuple[float, ...]:
    return tuple(circle(REFERENCE, on_six_points(CENTRED), load, which, TIGHTEST))


@STUDY.claim(
    "On six points the mean place and spin of the self-centred disc are those of exact Coulomb friction",
    equation="(19)–(21)",
    kind="trajectory",
    resolution=1e-7,
    note="Means in units of X0 and ω over the motion that comes back after a sixth of a turn. "
    + BY_REFERENCE,
    swept=("friction_force",),
)
def six_rests(engine: Engine, loads: Sequence[float] = REST_LOADS) -> Measured:
    """Compare the motions about the equilibrium on six points with those of the reference."""
    found = rests_of(engine, on_six_points(RING), loads)
    return Measured(
        predicted=[_rest_of_reference(load) for load in loads],
        value=found.value,
        error=found.error,
        at={"μN in N": loads},
        components=("x", "y", "spin"),
        system=on_six_points(RING),
        data={"rest load": loads, "six rest": found.value},
    )


@functools.cache
def _rest_of_reference(load: float) -> tuple[float, ...]:
    return tuple(rest(REFERENCE, on_six_points(RING), load, TIGHTEST))


@STUDY.claim(
    "A disc on six points that is stuck beyond the radius (9) slips away as under exact Coulomb friction",
    equation="(7)",
    kind="trajectory",
    resolution=2e-3,
    note="Displacement on the master disc in units of the radius, and spin less ω in units of ω, half as long again "
    f"after the start as (7) has it for the continuous ring; at {OUTSIDE[-1]:g} of the radius (9). {BY_REFERENCE}",
    swept=("friction_force",),
)
def six_releases(
    engine: Engine, loads: Sequence[float] = STICK_LOADS, tolerance: float = TOLERANCE
) -> Measured:
    """Compare how far discs outside of the radius (9) have slipped on six points with the reference."""
    found = refined(lambda tolerance: [_slipped(engine, load, tolerance) for load in loads], tolerance)
    predicted = [_slipped_in_reference(load) for load in loads]
    return Measured(
        predicted=predicted,
        value=found.value,
        error=found.rows,
        at={"μN in N": loads},
        components=("x", "y", "spin"),
        system=on_six_points(RING),
        note=f"By then the disc has slipped by {', '.join(f'{math.hypot(*one[:2]):.2g}' for one in predicted)} of "
        "the radius.",
    )


def _slipped(engine: Engine, load: float, tolerance: float) -> FloatArray:
    disc = on_six_points(with_load(RING, load))
    start, release = stuck_at(disc, OUTSIDE[-1])
    end = 1.5 * release
    run = engine.simulate(disc, start, [0.0, end], tolerance=tolerance)
    away = rotated(run.at_end, -disc.disc_speed * end) - start
    return np.array([*away[:2] / np.hypot(*start[:2]), away[-1] / disc.disc_speed])


@functools.cache
def _slipped_in_reference(load: float) -> tuple[float, ...]:
    return tuple(_slipped(REFERENCE, load, TIGHTEST))
