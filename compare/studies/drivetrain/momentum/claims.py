"""An isolated drivetrain of public parts, of every kind of node: its angular momentum does not change.

Engine, clutch disc and vehicle move in space or in the plane, or turn about a fixed axis, and only act on each
other: by friction, by an elastic shaft that is fixed to the vehicle beside its centre, and by a torsional spring. All
of that is inner force, eccentric as it is. A part that forgets the moment of its force about one of the bodies, or
that acts along different axes on both, fails here.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from compare.claims.claim import Claim, ErrorBudget
from compare.claims.error_estimates import ROUNDING
from compare.claims.study import Data, Findings, Study
from compare.engines import Engine
from compare.figures import BLACK, BLUE, GREEN, ORANGE, axis, new_figure
from reference_model.systems import FloatArray

if TYPE_CHECKING:
    from matplotlib.figure import Figure

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

UNTIL = 10.0
"""In s."""

SAMPLES = 100


@dataclass(frozen=True)
class Solver:
    """A solver of Exudyn, the number of its steps, its order, and the drift that can still be seen."""

    name: str
    steps: int
    order: int
    resolution: float


SOLVERS = {
    "explicit": Solver("RK67", 400, 6, 1e-11),
    "implicit": Solver("GeneralizedAlpha", 1200, 2, 1e-8),
}

SENTENCE = "An isolated drivetrain of any kinds of nodes keeps its angular momentum: {} solver"

DRAWN = ("rotation vector",) * 3


def measure(engine: Engine, drivetrains: Sequence[tuple[str, str, str]] = DRIVETRAINS) -> Findings:
    """Let every drivetrain run for 10 s with either solver."""
    data: Data = {}
    return Findings(tuple(_claim(engine, name, drivetrains, data) for name in SOLVERS), data)


def _claim(engine: Engine, name: str, drivetrains: Sequence[tuple[str, str, str]], data: Data) -> Claim:
    solver = SOLVERS[name]
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
            data["t"], data["each"] = times, each[..., 2]
    data[f"{name}: t"], data[f"{name}: drift"] = times, np.array([np.abs(d).max(axis=1) for d in drifts])
    measured = np.array([np.abs(drift).max() for drift in drifts])
    return Claim(
        SENTENCE.format(name),
        equation="",
        kind="conservation",
        engine=engine.name,
        predicted=np.zeros(len(measured)),
        measured=measured,
        budget=ErrorBudget([np.max(error) for error in errors], resolution=solver.resolution),
        parameters={
            "friction_force": FRICTION,
            "inner_radius": INNER_RADIUS,
            "outer_radius": OUTER_RADIUS,
            "eccentricity": ECCENTRICITY,
            "solver": solver.name,
            "steps": solver.steps,
        },
        source="three bodies by choice, displaced, tilted and moving against each other",
        note=f"Largest drift in {UNTIL:g} s over the largest angular momentum of one body, for "
        f"{len(measured)} drivetrains in which each kind of node of each body meets each of the others: "
        f"{', '.join(KINDS)}. About all three axes where every body is spatial, else about z. Numerical error: from "
        f"the change with half the steps, for a solver of order {solver.order} that is observed with half an order "
        "less at worst, and the rounding of every step: rotation vectors lose digits where they pass whole turns.",
    )


def _relative_drift(kinds: Sequence[str], momenta: FloatArray) -> FloatArray:
    """Return the drift of the sum about the axes that keep it, over the largest part of one body, shape (n, axes)."""
    total = momenta.sum(axis=1)
    kept = slice(None) if set(kinds) <= set(SPATIAL) else slice(2, 3)
    return np.asarray((total - total[0])[:, kept] / np.abs(momenta).max())


def angular_momenta(kinds: Sequence[str], solver: Solver, steps: int) -> tuple[FloatArray, FloatArray]:
    """Return times in s, and the angular momentum of each body about the origin in kg m²/s, shape (n, 3, 3)."""
    import exudyn as exu
    import exudyn.itemInterface

    from exudyn_models import add_radial_support, add_ring_friction

    items: Any = exudyn.itemInterface
    container = exu.SystemContainer()
    mbs = container.AddSystem()
    added = [_add_body(mbs, kind, body) for kind, body in zip(kinds, BODIES.values(), strict=True)]
    (engine, _), (disc, disc_body), (vehicle, vehicle_body) = added
    add_ring_friction(
        mbs,
        engine,
        disc,
        inner_radius=INNER_RADIUS,
        outer_radius=OUTER_RADIUS,
        friction_coefficient=1.0,
        normal_load=FRICTION,
        regularisation=EPSILON,
    )
    add_radial_support(mbs, vehicle, disc, stiffness=STIFFNESS, damping=DAMPING, offset=(ECCENTRICITY, 0.0))
    mbs.AddObject(
        items.TorsionalSpringDamper(
            markerNumbers=[
                mbs.AddMarker(items.MarkerBodyRigid(bodyNumber=body)) for body in (vehicle_body, disc_body)
            ],
            stiffness=TORSIONAL_STIFFNESS,
            damping=TORSIONAL_DAMPING,
        )
    )

    def momenta(mbs: Any, t: float, sensors: Any, factors: Any, configuration: Any) -> list[float]:
        parts = [
            _angular_momentum(mbs, kind, body, node)
            for kind, body, (node, _) in zip(kinds, BODIES.values(), added, strict=True)
        ]
        return [float(value) for value in np.ravel(parts)]

    sensor = mbs.AddSensor(
        items.SensorUserFunction(sensorUserFunction=momenta, storeInternal=True, writeToFile=False)
    )
    mbs.Assemble()
    settings = exu.SimulationSettings()
    settings.solution.file.write = False
    settings.solution.sensors.writePeriod = UNTIL / SAMPLES
    options = settings.timeIntegration
    options.endTime, options.numberOfSteps, options.verboseMode = UNTIL, steps, 0
    options.solverType = getattr(exu.DynamicSolverType, solver.name)
    options.newton.useModifiedNewton = False
    options.newton.relativeTolerance = options.newton.absoluteTolerance = 1e-12
    exu.config.printToConsole = False
    explicit = SOLVERS["explicit"] == solver
    solution: Any = exu.MainSolverExplicit() if explicit else exu.MainSolverImplicitSecondOrder()
    if not solution.SolveSystem(mbs, settings):
        raise RuntimeError(f"Exudyn's {solver.name} gave up on a drivetrain of {', '.join(kinds)}")
    stored = np.array(mbs.GetSensorStoredData(sensor))
    return stored[:, 0], stored[:, 1:].reshape(-1, len(BODIES), 3)


def _add_body(mbs: Any, kind: str, data: Body) -> tuple[Any, Any]:
    """Add a body with a node of ``kind``; return the numbers of node and body."""
    import exudyn.itemInterface

    items: Any = exudyn.itemInterface
    x, y, *_, angle = data.place
    vx, vy, *_, spin = data.velocity
    if kind == ROTOR:
        node = mbs.AddNode(
            items.Node1D(referenceCoordinates=[0.0], initialCoordinates=[angle], initialVelocities=[spin])
        )
        return node, mbs.AddObject(items.ObjectRotationalMass1D(nodeNumber=node, inertia=data.inertia[2]))
    if kind == PLANAR:
        node = mbs.AddNode(
            items.NodeRigidBody2D(initialCoordinates=[x, y, angle], initialVelocities=[vx, vy, spin])
        )
        body = items.ObjectRigidBody2D(nodeNumber=node, mass=data.mass, inertia=data.inertia[2])
        return node, mbs.AddObject(body)
    node = mbs.AddNode(
        getattr(items, SPATIAL[kind])(
            referenceCoordinates=[0.0] * 6,
            initialCoordinates=list(data.place),
            initialVelocities=list(data.velocity),
        )
    )
    body = items.ObjectRigidBody(nodeNumber=node, mass=data.mass, inertia=[*data.inertia, 0.0, 0.0, 0.0])
    return node, mbs.AddObject(body)


def _angular_momentum(mbs: Any, kind: str, body: Body, node: Any) -> FloatArray:
    """Return that of one body about the origin from its place and spin as Exudyn sees them, in kg m²/s."""
    import exudyn as exu

    variables = exu.OutputVariableType
    if kind == ROTOR:
        return np.array([0.0, 0.0, body.inertia[2] * float(mbs.GetNodeOutput(node, variables.Coordinates_t))])
    place, velocity, spin, rotation = (
        mbs.GetNodeOutput(node, variable)
        for variable in (
            variables.Position,
            variables.Velocity,
            variables.AngularVelocityLocal,
            variables.RotationMatrix,
        )
    )
    own = rotation.reshape(3, 3) @ (np.array(body.inertia) * spin)
    return np.asarray(body.mass * np.cross(place, velocity) + own)


def draw(data: Mapping[str, Data]) -> dict[str, Figure]:
    """Draw what the three bodies exchange, and how far their sum drifts."""
    found = next((values for values in data.values() if "each" in values), None)
    if found is None:
        return {}
    figure, (exchange, drift) = new_figure(ncols=2, width=10.0, height=4.0)
    each = found["each"]
    looks = zip((*BODIES, "sum"), (BLUE, GREEN, ORANGE, BLACK), (*each.T, each.sum(axis=1)), strict=True)
    for name, colour, momentum in looks:
        exchange.plot(found["t"], momentum - momentum[0], color=colour, label=name)
    exchange.set(xlabel=axis("t", "s"), ylabel="change of angular momentum in kg m²/s")
    exchange.legend(loc="upper left")
    for name, colour, above in zip(SOLVERS, (BLUE, ORANGE), (-13, 4), strict=True):
        times, drifts = found[f"{name}: t"], found[f"{name}: drift"]
        solver = SOLVERS[name]
        drift.semilogy(times[1:], np.maximum(drifts[:, 1:].T, 1e-17), color=colour, linewidth=0.8)
        drift.axhline(solver.resolution, color=colour, linestyle="--", linewidth=1.0)
        drift.annotate(
            f"{name}: {solver.name}, {solver.steps} steps",
            (0.0, solver.resolution),
            xytext=(0, above),
            textcoords="offset points",
            color=colour,
        )
    drift.set(xlabel=axis("t", "s"), ylabel="drift over the largest part", ylim=(1e-17, 1e-6))
    return {"drivetrain-momentum": figure}


STUDY = Study(
    name="drivetrain-momentum",
    title="Angular momentum of an isolated drivetrain, on every kind of node",
    section="The drivetrain",
    paper="Not in the paper. Friction contact, elastic shaft and torsional spring are parts for models of one's own: "
    "between any two bodies they only exchange momentum and angular momentum, however far the axes are apart. "
    "Nothing from outside acts on the drivetrains here.",
    by_hand=measure,
    draw=draw,
    figures={
        "drivetrain-momentum": "Engine, clutch disc on an eccentric shaft, and vehicle, which nothing else touches. "
        "Left: what they exchange, all of them bodies in space. Right: drift of the sum for "
        f"{len(DRIVETRAINS)} combinations of nodes; dashed: the resolution of the claims. The steps "
        "are where the engine's rotation vector comes close to a whole turn and loses digits."
    },
    only=("exudyn",),
    seconds=4.5,
)
