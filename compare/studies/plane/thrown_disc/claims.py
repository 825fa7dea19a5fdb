"""Discs thrown on a plane at rest while they spin: a ring, points and a full disc."""

from __future__ import annotations

import cmath
from collections.abc import Callable, Sequence

import numpy as np

from compare.claims.error_estimates import refined
from compare.claims.measured import Measured
from compare.claims.study import Study
from compare.engines import Engine
from compare.studies.plane.thrown_disc.full_disc import way_of
from compare.studies.plane.thrown_disc.parameters import (
    FULL,
    HEADING,
    POINTS,
    RADIUS,
    RING,
    SOURCE,
    SPEED,
    TO_REST,
    WHILE_SLIDING,
    Throw,
)
from compare.studies.plane.thrown_disc.pictures import draw
from reference_model.systems import FloatArray

STUDY = Study.beside(__file__, "thrown-disc", source=SOURCE, seconds=1.0, quick=True, contact=True)
STUDY.provides(figures=draw)

SEEN = (
    "way along in m",
    "way across in m",
    "way of the rim in m",
    "speed along in m/s",
    "speed across in m/s",
    "speed of the rim in m/s",
)

Follow = Callable[[Throw, FloatArray, float], FloatArray]
"""From a throw, times and tolerance to the states at the times."""


def in_engine(engine: Engine, points: int | None = None) -> Follow:
    """Return what follows throws of a disc on ``points``, or on a ring, with ``engine``."""

    def follow(throw: Throw, times: FloatArray, tolerance: float) -> FloatArray:
        return engine.simulate(throw.disc(points), throw.state, times, tolerance=tolerance).states

    return follow


def compared(
    follow: Follow,
    throws: Sequence[Throw],
    shares: FloatArray,
    name: str,
    *,
    points: int | None = None,
    error: float = 0.0,
) -> Measured:
    """Compare throws with the closed form, at ``shares`` of the time in which they stop.

    ``name`` is for the figure, and ``error`` is that of friction over μN.
    """

    def states(tolerance: float) -> FloatArray:
        found = [seen(follow(throw, throw.time * shares, tolerance)[1:]) for throw in throws]
        return np.array(found)

    found = refined(states)
    return Measured(
        predicted=[throw.seen_at(shares[1:]) for throw in throws],
        value=found.value,
        error=found.largest + error * SPEED,  # friction takes all of the speed
        at={"throw": [throw.name for throw in throws], "t over the time to rest": shares[1:]},
        components=SEEN,
        system=throws[0].disc(points),
        data={f"{name}: speeds": found.value[:, :, [3, 5]]},
    )


def seen(states: FloatArray) -> FloatArray:
    """Return ways and speeds along and across the throw and of the rim, in m and m/s, of states (n, 6)."""
    z, v = (states[:, (0, 3)] + 1j * states[:, (1, 4)]).T * cmath.rect(1.0, -HEADING)
    rim = RADIUS * states[:, (2, 5)]
    return np.column_stack((z.real, z.imag, rim[:, 0], v.real, v.imag, rim[:, 1]))


@STUDY.claim(
    "A ring that slides is slowed down by μN, one that spins by μNR, and one that does both by 2/π of each",
    equation="(19), (20)",
    unit="m, m/s",
    resolution=1e-6,
    note="Uniform deceleration to rest; both: J = mR², and the rim is as fast as the centre.",
    swept=("polar_inertia",),
)
def on_ring(engine: Engine) -> Measured:
    """Compare throws of a ring with uniform deceleration."""
    return compared(in_engine(engine), RING, TO_REST, "ring")


@STUDY.claim(
    "A disc on {} points that slides is slowed down by μN, one that spins by μNR",
    equation="(19), (21)",
    unit="m, m/s",
    resolution=1e-6,
    note="Uniform deceleration to rest.",
    swept=("polar_inertia",),
    each={str(points): points for points in POINTS},
)
def on_points(engine: Engine, points: int) -> Measured:
    """Compare throws of a disc on points with uniform deceleration."""
    return compared(in_engine(engine, points), POINTS[points], TO_REST, f"{points} points", points=points)


@STUDY.claim(
    "A full disc that slides is slowed down by μN, one that spins by ⅔·μNR, and one that does both by less of each",
    equation="(19), (20)",
    unit="m, m/s",
    resolution=1e-6,
    note="Contact under uniform pressure within R. Uniform deceleration, looked at until nine tenths of the time to "
    "rest; both alike: J = mR²/3, and the rim is as fast as the centre, with the force 8/3π·μN and the moment "
    "8/9π·μNR.",
    swept=("polar_inertia",),
)
def on_full_disc(engine: Engine) -> Measured:
    """Compare throws of a full disc with uniform deceleration."""
    way = way_of(engine)
    return compared(way.follow, FULL, WHILE_SLIDING, "full disc", error=way.quadrature)
