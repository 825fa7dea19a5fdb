"""When and where a ring comes to rest, and what its energy becomes."""

from __future__ import annotations

import cmath
import math
from collections.abc import Sequence

import numpy as np
from scipy.interpolate import make_interp_spline

from compare.claims.error_estimates import Measurement, refined
from compare.claims.measured import Measured
from compare.engines import Engine
from compare.studies.disc.free_ring.claims.study import STUDY
from compare.studies.disc.free_ring.parameters import (
    DECELERATION,
    HEADING,
    INTEGRATED,
    RINGS,
    SPEED,
    TABLE,
    TOLERANCE,
    Throw,
)
from compare.studies.disc.free_ring.throws import rest_of, speeds_at, thrown, uniform_times
from compare.studies.toolkit.free_bodies import NEAR, Slowing
from reference_model.contact.elliptic import mean_directions
from reference_model.systems import FloatArray


@STUDY.claim(
    "Time and ways to rest are those of the integrals over the ratio",
    equation="(19), (20)",
    unit="s, m, rad",
    resolution=1e-8,
    note="Predicted by integrals over the ratio U/W, without a step in time.",
    basis="reference",
    swept=("polar_inertia",),
)
def stops(engine: Engine, throws: Sequence[Throw] = INTEGRATED) -> Measured:
    """Compare rest and ways with the integrals."""
    found = stops_of(engine, throws)
    predicted, nearly = (
        np.array([_integrated(throw, near) for throw in throws]) for near in (NEAR, 10.0 * NEAR)
    )
    return Measured(
        system=TABLE,
        predicted=predicted,
        value=found.value,
        error=found.largest + float(np.max(np.abs(predicted - nearly))),
        at={"throw": [throw.name for throw in throws]},
        components=("time in s", "x in m", "y in m", "angle in rad"),
    )


def stops_of(engine: Engine, throws: Sequence[Throw]) -> Measurement:
    """Return the time to rest in s, and x, y in m and the angle in rad there, shape (n, 4)."""

    def found(tolerance: float) -> FloatArray:
        trajectories = [thrown(engine, throw, tolerance) for throw in throws]
        return np.array([[rest_of(trajectory), *trajectory.at_end[:3]] for trajectory in trajectories])

    return refined(found, TOLERANCE)


def _integrated(throw: Throw, near: float) -> list[float]:
    rest = Slowing(throw.inertia).stop(throw.sliding, abs(throw.rim), near)
    place = cmath.rect(rest.slid / DECELERATION, HEADING)
    turned = math.copysign(rest.turned, throw.rim) / DECELERATION / TABLE.contact_radius
    return [rest.time / DECELERATION, place.real, place.imag, turned]


@STUDY.claim(
    "The energy that the ring loses is the heat of friction",
    equation="(19), (20)",
    kind="conservation",
    resolution=1e-6,
    note="Largest difference at any time, as a fraction of the energy at the start. Error: the tolerance, and every "
    "second sample left out of the quadrature of μN·P(U, W).",
    basis="reference",
)
def heat(engine: Engine, throws: Sequence[Throw] = RINGS) -> Measured:
    """Compare the energy that is lost with the integral of the friction power."""

    def imbalance(tolerance: float) -> FloatArray:
        """Return the largest difference in time, as a fraction of all energy, by all samples and by every second."""
        found = []
        for throw in throws:
            times = uniform_times(engine, throw)
            sliding, rim = speeds_at(thrown(engine, throw, tolerance), times)
            energy = 0.5 * TABLE.mass * (sliding**2 + throw.inertia * rim**2)
            shares = [mean_directions(*both) for both in zip(sliding, rim, strict=True)]
            power = TABLE.friction_force * np.sum(np.column_stack((sliding, rim)) * shares, axis=1)
            row = []
            for step in (1, 2):
                heat = make_interp_spline(times[::step], power[::step], k=5).antiderivative()
                row.append(np.max(np.abs(energy[0] - energy - heat(times))[::2]) / energy[0])
            found.append(row)
        return np.array(found)

    found = refined(imbalance, TOLERANCE)
    halved = np.abs(found.value[:, 1] - found.value[:, 0])
    return Measured(
        system=TABLE,
        predicted=np.zeros(len(throws)),
        value=found.value[:, 0],
        error=found.largest + 2.0 * TOLERANCE / SPEED + halved,
        at={"throw": [throw.name for throw in throws]},
    )
