"""The friction that acts on a disc in an engine, read off its acceleration."""

from __future__ import annotations

import cmath
import math
from collections.abc import Sequence

import numpy as np

from compare.claims.error_estimates import TIGHTEST, refined
from compare.claims.measured import Measured
from compare.engines import Engine
from compare.studies.disc.contact_laws.claims.study import STUDY
from compare.studies.disc.contact_laws.integrals import ring_by_quadrature, sum_of_points
from compare.studies.disc.contact_laws.parameters import (
    ANGLE,
    CENTRE,
    DIFFERENCES,
    DIRECTION,
    DISC,
    RATIOS,
    SIX,
    SPEED,
    STEP,
)
from reference_model.systems import DiscOnDisc, FloatArray

NOTE = (
    "F_x, F_y over μN and M over μN·R. From the acceleration at the start, by the velocities of the first "
    f"{4.0 * STEP:g} s; predicted by quadrature. Error: the change from differences of the next lower order, and at "
    "a smaller tolerance."
)


@STUDY.claim(
    "Friction on the continuous ring is the integral (20)", equation="(20)", resolution=1e-3, note=NOTE
)
def on_ring(engine: Engine, ratios: Sequence[float] = RATIOS) -> Measured:
    """Compare friction on the ring with the integral, at the ``ratios`` U/W."""
    predicted = [ring_by_quadrature(slip, rim)[0] for slip, rim in motions(ratios)]
    return friction_on(engine, DISC, ratios, "ring", predicted)


@STUDY.claim(
    "Friction on six points is the mean of (20) over the points, which slip as (21) says",
    equation="(21)",
    resolution=1e-3,
    note=NOTE,
)
def on_six_points(engine: Engine, ratios: Sequence[float] = RATIOS) -> Measured:
    """Compare friction on six points with the sum over them, at the ``ratios`` U/W."""
    predicted = [sum_of_points(slip, rim, ANGLE, 6) for slip, rim in motions(ratios)]
    return friction_on(engine, SIX, ratios, "points6", predicted)


def motions(ratios: Sequence[float]) -> list[tuple[complex, float]]:
    """Return slip of the centre and of the rim, u and R·(ω − φ̇) in m/s, for U/W and both signs of the latter."""
    alphas = [math.atan2(1.0, ratio) for ratio in ratios]
    return [
        (cmath.rect(SPEED * math.cos(alpha), DIRECTION), sign * SPEED * math.sin(alpha))
        for sign in (1.0, -1.0)
        for alpha in alphas
    ]


def friction_on(
    engine: Engine, disc: DiscOnDisc, ratios: Sequence[float], name: str, predicted: Sequence[FloatArray]
) -> Measured:
    """Compare F_x, F_y (per μN) and M (per μN·R) on ``disc`` with those ``predicted``, shape (2n, 3).

    By (19) they are what the acceleration at the start takes besides springs and dampers. ``name`` is that of the
    law in the figures.
    """
    inertia = np.array((disc.mass, disc.mass, disc.polar_inertia))

    def friction(tolerance: float) -> FloatArray:
        found = []
        for slip, rim in motions(ratios):
            v, spin = slip + 1j * disc.disc_speed * CENTRE, disc.disc_speed - rim / disc.contact_radius
            start = [CENTRE.real, CENTRE.imag, ANGLE, v.real, v.imag, spin]
            velocities = engine.simulate(disc, start, STEP * np.arange(5), tolerance=tolerance).states[:, 3:]
            support = disc.damping * v + disc.stiffness * (CENTRE - disc.offset)
            resisted = (support.real, support.imag, disc.shaft_damping * (spin - disc.shaft_speed))
            found.append(inertia * (np.array(DIFFERENCES) @ velocities) / STEP + resisted)
        return np.array(found) / (disc.friction_force * np.array((1.0, 1.0, disc.contact_radius)))

    found, error = refined(friction, TIGHTEST)
    # One number alone may be right by chance: of the noise the largest of all counts, of the differences' own error
    # the largest in a motion.
    truncation = np.max(np.abs(found[:, 0] - found[:, 1]), axis=1, keepdims=True)
    along = found[:, 0, :2] @ (-math.cos(DIRECTION), -math.sin(DIRECTION))
    return Measured(
        predicted=predicted,
        value=found[:, 0],
        error=np.max(error[:, 0], axis=0) + truncation,
        size=1.0,
        at={"U/W": [f"{ratio:g}, ω {sign} φ̇" for sign in "><" for ratio in ratios]},
        components=("F_x", "F_y", "M"),
        system=disc,
        parameters={"x": CENTRE.real, "y": CENTRE.imag, "angle": ANGLE},
        data={"ratio": ratios, name: np.column_stack((along, found[:, 0, 2]))[: len(ratios)]},
    )
