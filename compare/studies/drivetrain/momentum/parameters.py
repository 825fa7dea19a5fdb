"""Three bodies on every kind of node, what acts between them, and the solvers that move them."""

from __future__ import annotations

from dataclasses import dataclass

ROTOR, PLANAR = "rotor", "planar"
SPATIAL = {"rotation vector": "NodeRigidBodyRotVecLG", "Tait-Bryan": "NodeRigidBodyRxyz"}
KINDS = (ROTOR, PLANAR, *SPATIAL)
"""Of nodes; a rotor turns about a fixed axis, so that only the moment about that is inner."""

DRIVETRAINS = tuple(
    (engine, KINDS[1 + (i + j) % 3], vehicle)
    for i, engine in enumerate(KINDS)
    for j, vehicle in enumerate(KINDS)
)
"""Kinds of engine, disc and vehicle: each kind of each body meets each kind of the others."""


@dataclass(frozen=True)
class Body:
    """Mass in kg, principal moments of inertia in kg m², place and rotation, velocity and turn rates."""

    mass: float
    inertia: tuple[float, float, float]
    place: tuple[float, float, float, float, float, float]
    velocity: tuple[float, float, float, float, float, float]


BODIES = {
    "engine": Body(
        40.0, (2.4, 2.4, 4.0), (0.006, -0.003, 0.0, 1e-4, -1e-4, 0.0), (0.0, 0.0, 0.0, 1e-4, 1e-4, 3.0)
    ),
    "disc": Body(
        1.0, (0.012, 0.012, 0.02), (0.013, 0.01, 0.006, -4e-4, 5e-4, 0.2), (0.0, 0.005, 0.0, 0.0, -4e-4, 1.0)
    ),
    "vehicle": Body(
        80.0, (5.0, 5.0, 8.0), (0.0, 0.009, 0.015, 1e-4, 1e-4, 0.1), (0.0, 0.0, 0.0, -1e-4, 1e-4, 1.0)
    ),
}
"""Beside each other and tilted a little."""

FRICTION, INNER_RADIUS, OUTER_RADIUS, EPSILON = 0.1, 0.08, 0.12, 1e-3
STIFFNESS, DAMPING, ECCENTRICITY = 25.0, 0.5, 0.01
TORSIONAL_STIFFNESS, TORSIONAL_DAMPING = 0.5, 0.02
"""In N, m and m/s; N/m, N s/m and m; N m/rad and N m s/rad."""

UNTIL = 5.0
"""In s: two turns of the engine."""

SAMPLES = 50
"""Of a run."""


@dataclass(frozen=True)
class Solver:
    """A solver of Exudyn, the number of its steps, its order, and the drift that can still be seen."""

    name: str
    steps: int
    order: int
    resolution: float


SOLVERS = {
    "explicit": Solver("RK67", 200, 6, 1e-11),
    "implicit": Solver("GeneralizedAlpha", 600, 2, 1e-8),
}

DRAWN = ("rotation vector",) * 3
"""The drivetrain of the figure."""
