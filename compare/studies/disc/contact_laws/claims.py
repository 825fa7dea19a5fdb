"""Eq. 20 to 23: the friction that acts on a disc in each engine, and how far the laws of contact are apart."""

from __future__ import annotations

import cmath
import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from compare.claims.claim import Claim, ErrorBudget
from compare.claims.error_estimates import refined
from compare.claims.paper_parameters import FIG11
from compare.claims.parameters import at_each, parameters_of
from compare.claims.study import Data, Findings, Study
from compare.engines import Engine
from compare.studies.disc.contact_laws.integrals import ring_by_quadrature, sum_of_points
from compare.studies.disc.contact_laws.pictures import draw
from compare.studies.disc.contact_laws.theory import theory
from reference_model.systems import DiscOnDisc, FloatArray

DISCS = {"ring": FIG11, "points6": replace(FIG11, contact_points=6)}
"""By the name that their law has in the data."""

SENTENCES = {
    "ring": "Friction on the continuous ring is the integral (20)",
    "points6": "Friction on six points is the mean of (20) over the points, which slip as (21) says",
}

EQUATIONS = {"ring": "(20)", "points6": "(21)"}

RATIOS = (0.05, 0.3, 0.6, 0.8, 1.25, 1.7, 3.0, 20.0)
"""U/W of the motions: not too near to U = W, where friction has no derivative."""

SPEED = 0.3
"""√(U² + W²) in m/s, ν̄_r of (22)."""

CENTRE, DIRECTION, ANGLE = 0.05 - 0.02j, 0.4, 0.3
"""Of these motions: where the disc's centre is in m, direction of its slip and angle of the disc in rad."""

STEP = 2e-3
"""In s, between the velocities whose differences give the acceleration at the start."""

DIFFERENCES = (
    (-25.0 / 12.0, 4.0, -3.0, 4.0 / 3.0, -1.0 / 4.0),
    (-11.0 / 6.0, 3.0, -3.0 / 2.0, 1.0 / 3.0, 0.0),
)
"""Weights of the first derivative at the first of five times, of fourth and of third order."""

TOLERANCE = 1e-12


def motions(ratios: Sequence[float]) -> list[tuple[complex, float]]:
    """Return slip of the centre and of the rim, u and R·(ω − φ̇) in m/s, for U/W and both signs of the latter."""
    alphas = [math.atan2(1.0, ratio) for ratio in ratios]
    return [
        (cmath.rect(SPEED * math.cos(alpha), DIRECTION), sign * SPEED * math.sin(alpha))
        for sign in (1.0, -1.0)
        for alpha in alphas
    ]


def measured_friction(
    engine: Engine, disc: DiscOnDisc, ratios: Sequence[float]
) -> tuple[FloatArray, FloatArray]:
    """Return F_x, F_y (per μN) and M (per μN·R) on ``disc`` in ``engine``, and their errors, shape (2n, 3).

    By (19) they are what the acceleration at the start takes besides springs and dampers.
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

    found, error = refined(friction, TOLERANCE)
    # One number alone may be right by chance: of the noise the largest of all counts, of the differences' own error
    # the largest in a motion.
    truncation = np.max(np.abs(found[:, 0] - found[:, 1]), axis=1, keepdims=True)
    return found[:, 0], np.asarray(np.max(error[:, 0], axis=0) + truncation)


def predicted_friction(disc: DiscOnDisc, ratios: Sequence[float]) -> FloatArray:
    """Return the same by (20), or by the sum in its place."""
    if disc.contact_points is None:
        return np.array([ring_by_quadrature(slip, rim)[0] for slip, rim in motions(ratios)])
    return np.array([sum_of_points(slip, rim, ANGLE, disc.contact_points) for slip, rim in motions(ratios)])


def measure(engine: Engine, ratios: Sequence[float] = RATIOS) -> Findings:
    """Measure the friction that acts on the ring and on six points in ``engine``; ``ratios`` are U/W."""
    claims: list[Claim] = []
    data: Data = {"ratio": np.array(ratios)}
    for name, disc in DISCS.items():
        if not engine.simulates(disc):
            continue
        measured, error = measured_friction(engine, disc, ratios)
        claims.append(
            Claim(
                SENTENCES[name],
                equation=EQUATIONS[name],
                engine=engine.name,
                predicted=predicted_friction(disc, ratios),
                measured=measured,
                budget=ErrorBudget(error, resolution=1e-3),
                parameters=parameters_of(disc) | {"x": CENTRE.real, "y": CENTRE.imag, "angle": ANGLE},
                source="Fig. 11; how the disc moves is ours",
                note=f"F_x, F_y over μN and M over μN·R, for {at_each('U/W', ratios)}, with ω − φ̇ > 0, then < 0. "
                f"From the acceleration at the start, by the velocities of the first {4.0 * STEP:g} s; predicted by "
                "quadrature. Error: the change from differences of the next lower order, and at a smaller tolerance.",
            )
        )
        along = measured[:, :2] @ (-math.cos(DIRECTION), -math.sin(DIRECTION))
        data[name] = np.column_stack((along, measured[:, 2]))[: len(ratios)]
    return Findings(tuple(claims), data, engine.lacking(DISCS.values()))


STUDY = Study(
    name="contact-laws",
    title="Laws of contact: ring, points, expansion, annulus",
    section="The friction disc",
    paper=(
        "Friction between the discs acts along a circle (20), (21). In the paper's simulations it is that of six "
        "points on the circle, in its analysis the average of three terms of an expansion (22), which gives (23). "
        "The integral (20) has a closed form by complete elliptic integrals, and so all three can be compared."
    ),
    by_hand=measure,
    theory=theory,
    draw=draw,
    figures={
        "contact-laws": (
            "Force against the slip of the centre and moment about it, over the ratio of slip speed U and rim speed "
            "W = R|ω − φ̇|: the continuous ring, (23), six points at all angles φ, and an annulus from 2R/3 to R "
            "under uniform pressure. Marks: measured in the engines, on the ring."
        ),
        "contact-errors": (
            "Distance from the continuous ring of (23) and of 6, 12, 24 points at the worst angle φ; dots: where it "
            "is the largest. Points are off the most as U → W, where one of them comes to rest."
        ),
    },
    seconds=2.0,
    quick=True,
    contact=True,
)
