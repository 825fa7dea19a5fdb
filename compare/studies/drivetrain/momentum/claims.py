"""An isolated drivetrain of public parts, of every kind of node: its angular momentum does not change.

Engine, clutch disc and vehicle move in space or in the plane, or turn about a fixed axis, and only act on each
other: by friction, by an elastic shaft that is fixed to the vehicle beside its centre, and by a torsional spring. All
of that is inner force, eccentric as it is. A part that forgets the moment of its force about one of the bodies, or
that acts along different axes on both, fails here.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from compare.claims.error_estimates import ROUNDING
from compare.claims.measured import Measured
from compare.claims.study import Data, Study
from compare.engines import Engine
from compare.studies.drivetrain.momentum.model import angular_momenta
from compare.studies.drivetrain.momentum.parameters import (
    DRAWN,
    DRIVETRAINS,
    ECCENTRICITY,
    FRICTION,
    INNER_RADIUS,
    KINDS,
    OUTER_RADIUS,
    SOLVERS,
    SPATIAL,
    UNTIL,
)
from compare.studies.drivetrain.momentum.pictures import draw
from reference_model.systems import FloatArray

STUDY = Study.beside(
    __file__,
    "drivetrain-momentum",
    words={"combinations": str(len(DRIVETRAINS))},
    source="three bodies by choice, displaced, tilted and moving against each other",
    draw=draw,
    only=("exudyn",),
    seconds=4.5,
)


@STUDY.claim(
    "An isolated drivetrain of any kinds of nodes keeps its angular momentum: {} solver",
    kind="conservation",
    note=f"Largest drift in {UNTIL:g} s over the largest angular momentum of one body, for {len(DRIVETRAINS)} "
    "drivetrains in which each kind of node of each body meets each of the others: "
    f"{', '.join(KINDS)}. About all three axes where every body is spatial, else about z.",
    each=tuple(SOLVERS),
)
def momentum(
    engine: Engine, name: str, drivetrains: Sequence[tuple[str, str, str]] = DRIVETRAINS
) -> Measured:
    """Let every drivetrain run with a solver, and with half its steps."""
    solver = SOLVERS[name]
    data: Data = {}
    drifts, errors = [], []
    for kinds in drivetrains:
        times, each = angular_momenta(kinds, solver, solver.steps)
        _, coarse = angular_momenta(kinds, solver, solver.steps // 2)
        drift, coarse_drift = (_relative_drift(kinds, momenta) for momenta in (each, coarse))
        drifts.append(drift)
        errors.append(
            np.abs(drift - coarse_drift) / (2.0 ** (solver.order - 0.5) - 1.0) + solver.steps * ROUNDING
        )
        if kinds == DRAWN:
            data |= {"t": times, "each": each[..., 2]}
    largest = np.array([np.abs(drift).max() for drift in drifts])
    return Measured(
        predicted=np.zeros(len(largest)),
        value=largest,
        error=[np.max(error) for error in errors],
        resolution=solver.resolution,
        at={"engine, disc, vehicle": [", ".join(kinds) for kinds in drivetrains]},
        parameters={
            "friction_force": FRICTION,
            "inner_radius": INNER_RADIUS,
            "outer_radius": OUTER_RADIUS,
            "eccentricity": ECCENTRICITY,
            "solver": solver.name,
            "steps": solver.steps,
        },
        note=f"Numerical error: from the change with half the steps, for a solver of order {solver.order} that is "
        "observed with half an order less at worst, and the rounding of every step: rotation vectors lose digits "
        "where they pass whole turns.",
        data=data
        | {f"{name}: t": times, f"{name}: drift": np.array([np.abs(d).max(axis=1) for d in drifts])},
    )


def _relative_drift(kinds: Sequence[str], momenta: FloatArray) -> FloatArray:
    """Return the drift of the sum about the axes that keep it, over the largest part of one body, shape (n, axes)."""
    total = momenta.sum(axis=1)
    kept = slice(None) if set(kinds) <= set(SPATIAL) else slice(2, 3)
    return np.asarray((total - total[0])[:, kept] / np.abs(momenta).max())
