"""Angular momentum of an isolated drivetrain on every kind of node.

Friction, an elastic shaft attached off-centre, and a torsional spring connect the bodies. The claims fail if a part
lacks the moment of its force about a body, or acts on two bodies along different axes.
"""

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from compare.claims import ROUNDING, ByEngine, Data, Figures, Measured, Study
from compare.engines import Engine
from compare.output.figures import BLACK, BLUE, GREEN, ORANGE, axis, new_figure
from reference_model.systems import FloatArray

ROTOR, PLANAR = "rotor", "planar"
SPATIAL = {"rotation vector": "NodeRigidBodyRotVecLG", "Tait-Bryan": "NodeRigidBodyRxyz"}
KINDS = (ROTOR, PLANAR, *SPATIAL)
"""Kinds of nodes. The bearing of a rotor absorbs every moment except the moment about its axis."""

DRIVETRAINS = tuple(
    (engine, KINDS[1 + (i + j) % 3], vehicle)
    for i, engine in enumerate(KINDS)
    for j, vehicle in enumerate(KINDS)
)
"""Nodes of engine, disc and vehicle; each kind for each body occurs with each kind for the others."""

DRAWN = ("rotation vector",) * 3


class Body(NamedTuple):
    """Mass (kg), principal moments of inertia (kg m²), position and rotation, velocity and turn rates."""

    mass: float
    inertia: tuple[float, float, float]
    position: tuple[float, float, float, float, float, float]
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
"""The axes are apart and slightly tilted, which reveals a force without its arm."""

FRICTION: dict[str, Any] = {
    "friction_coefficient": 1.0,
    "normal_load": 0.1,
    "inner_radius": 0.08,
    "outer_radius": 0.12,
}
EPSILON = 1e-3
SHAFT: dict[str, Any] = {"stiffness": 25.0, "damping": 0.5}
ECCENTRICITY = 0.01
SPRING = {"stiffness": 0.5, "damping": 0.02}
"""Friction in N and m, ε in m/s, shaft in N/m and N s/m, eccentricity in m, spring in N m/rad and N m s/rad."""

UNTIL, SAMPLES = 5.0, 50
"""Duration in s, two turns of the engine; and the number of recorded momenta."""


class Solver(NamedTuple):
    """A solver of Exudyn, its number of steps, its order, and the largest error that still reveals a drift."""

    name: str
    steps: int
    order: int
    resolution: float


SOLVERS = {"explicit": Solver("RK67", 200, 6, 1e-11), "implicit": Solver("GeneralizedAlpha", 600, 2, 1e-8)}

STUDY = Study.beside(
    __file__,
    "drivetrain-momentum",
    words={"combinations": str(len(DRIVETRAINS))},
    source="three bodies (our choice), displaced, tilted and in relative motion",
    only=("exudyn",),
    seconds=4.5,
)


@STUDY.claim(
    "An isolated drivetrain keeps its angular momentum on all kinds of nodes: {} solver",
    kind="conservation",
    friction=False,
    note=f"Largest drift in {UNTIL:g} s, divided by the largest angular momentum of one body, for {len(DRIVETRAINS)} "
    f"drivetrains in which each kind of node of each body meets each of the others: {', '.join(KINDS)}. About all "
    "three axes if every body is spatial, otherwise about z.",
    each=tuple(SOLVERS),
)
def momentum(
    engine: Engine, name: str, drivetrains: Sequence[tuple[str, str, str]] = DRIVETRAINS
) -> Measured:
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
    data |= {
        f"{name}: t": times,
        f"{name}: drift": np.array([np.abs(drift).max(axis=1) for drift in drifts]),
        f"{name}: resolution": np.array(solver.resolution),
    }
    return Measured(
        predicted=np.zeros(len(largest)),
        value=largest,
        error=[np.max(error) for error in errors],
        resolution=solver.resolution,
        at={"engine, disc, vehicle": [", ".join(kinds) for kinds in drivetrains]},
        parameters=FRICTION | {"eccentricity": ECCENTRICITY, "solver": solver.name, "steps": solver.steps},
        note="Numerical error: the change with half the steps, if the order is too low by at most a half, plus "
        "rounding in every step, because rotation vectors lose digits near whole turns.",
        data=data,
    )


def _relative_drift(kinds: Sequence[str], momenta: FloatArray) -> FloatArray:
    """Return the drift about the conserved axes divided by the largest momentum of one body, shape (n, axes)."""
    total = momenta.sum(axis=1)
    kept = slice(None) if set(kinds) <= set(SPATIAL) else slice(2, 3)
    return np.asarray((total - total[0])[:, kept] / np.abs(momenta).max())


def angular_momenta(kinds: Sequence[str], solver: Solver, steps: int) -> tuple[FloatArray, FloatArray]:
    """Return times (s), and the angular momentum of each body about the origin (kg m²/s), shape (n, 3, 3)."""
    import exudyn as exu
    import exudyn.itemInterface

    container = exu.SystemContainer()
    mbs = container.AddSystem()
    nodes = _add_drivetrain(mbs, kinds)

    def momenta(mbs: Any, t: float, sensors: Any, factors: Any, configuration: Any) -> list[float]:
        bodies = zip(kinds, BODIES.values(), nodes, strict=True)
        return [float(value) for value in np.ravel([_angular_momentum(mbs, *body) for body in bodies])]

    item: Any = exudyn.itemInterface.SensorUserFunction
    sensor = mbs.AddSensor(item(sensorUserFunction=momenta, storeInternal=True, writeToFile=False))
    mbs.Assemble()
    settings = exu.SimulationSettings()
    settings.solution.file.write = False
    settings.solution.sensors.writePeriod = UNTIL / SAMPLES
    options = settings.timeIntegration
    options.endTime, options.numberOfSteps, options.verboseMode = UNTIL, steps, 0
    options.newton.useModifiedNewton = True
    options.newton.relativeTolerance = options.newton.absoluteTolerance = 1e-12
    # ``solve_dynamic`` would warn that the coarse run cannot hold a stuck clutch, but these clutches always slip.
    if not mbs.SolveDynamic(settings, getattr(exu.DynamicSolverType, solver.name)):
        raise RuntimeError(f"Exudyn's {solver.name} failed for a drivetrain of {', '.join(kinds)}")
    stored = np.array(mbs.GetSensorStoredData(sensor))
    return stored[:, 0], stored[:, 1:].reshape(-1, len(BODIES), 3)


def _add_drivetrain(mbs: Any, kinds: Sequence[str]) -> list[Any]:
    import exudyn.itemInterface

    from exudyn_models import add_radial_support, add_ring_friction

    items: Any = exudyn.itemInterface
    added = [_add_body(mbs, kind, body) for kind, body in zip(kinds, BODIES.values(), strict=True)]
    (engine, _), (disc, disc_body), (vehicle, vehicle_body) = added
    add_ring_friction(mbs, engine, disc, **FRICTION, regularisation=EPSILON)
    add_radial_support(mbs, vehicle, disc, **SHAFT, offset=(ECCENTRICITY, 0.0))
    ends = [mbs.AddMarker(items.MarkerBodyRigid(bodyNumber=body)) for body in (vehicle_body, disc_body)]
    mbs.AddObject(items.TorsionalSpringDamper(markerNumbers=ends, **SPRING))
    return [engine, disc, vehicle]


def _add_body(mbs: Any, kind: str, data: Body) -> tuple[Any, Any]:
    import exudyn.itemInterface

    items: Any = exudyn.itemInterface
    x, y, *_, angle = data.position
    vx, vy, *_, spin = data.velocity
    if kind == ROTOR:
        rotor = items.Node1D(referenceCoordinates=[0.0], initialCoordinates=[angle], initialVelocities=[spin])
        node = mbs.AddNode(rotor)
        return node, mbs.AddObject(items.ObjectRotationalMass1D(nodeNumber=node, inertia=data.inertia[2]))
    if kind == PLANAR:
        flat = items.NodeRigidBody2D(initialCoordinates=[x, y, angle], initialVelocities=[vx, vy, spin])
        node = mbs.AddNode(flat)
        body = items.ObjectRigidBody2D(nodeNumber=node, mass=data.mass, inertia=data.inertia[2])
        return node, mbs.AddObject(body)
    start = {"initialCoordinates": list(data.position), "initialVelocities": list(data.velocity)}
    node = mbs.AddNode(getattr(items, SPATIAL[kind])(referenceCoordinates=[0.0] * 6, **start))
    body = items.ObjectRigidBody(nodeNumber=node, mass=data.mass, inertia=[*data.inertia, 0.0, 0.0, 0.0])
    return node, mbs.AddObject(body)


def _angular_momentum(mbs: Any, kind: str, body: Body, node: Any) -> FloatArray:
    import exudyn as exu

    of = exu.OutputVariableType
    if kind == ROTOR:
        return np.array([0.0, 0.0, body.inertia[2] * float(mbs.GetNodeOutput(node, of.Coordinates_t))])
    position, velocity, spin, rotation = (
        mbs.GetNodeOutput(node, quantity)
        for quantity in (of.Position, of.Velocity, of.AngularVelocityLocal, of.RotationMatrix)
    )
    own = rotation.reshape(3, 3) @ (np.array(body.inertia) * spin)
    (x, y, z), (vx, vy, vz) = position, velocity
    return np.asarray(body.mass * np.array((y * vz - z * vy, z * vx - x * vz, x * vy - y * vx)) + own)


def draw(data: ByEngine) -> Figures:
    found = next((values for values in data.values() if "each" in values), None)
    if found is None:
        return {}
    figure, (exchange, drift) = new_figure(ncols=2, width=10.0, height=4.0)
    each = found["each"]
    momenta = (*each.T, each.sum(axis=1))
    names, colours = ("engine", "disc", "vehicle", "sum"), (BLUE, GREEN, ORANGE, BLACK)
    for name, colour, momentum in zip(names, colours, momenta, strict=True):
        exchange.plot(found["t"], momentum - momentum[0], color=colour, label=name)
    exchange.set(xlabel=axis("t", "s"), ylabel="change of angular momentum in kg m²/s")
    exchange.legend(loc="upper left")
    for name, colour, above in (("explicit", BLUE, -13), ("implicit", ORANGE, 4)):
        times, drifts, resolution = (found[f"{name}: {key}"] for key in ("t", "drift", "resolution"))
        drift.semilogy(times[1:], np.maximum(drifts[:, 1:].T, 1e-17), color=colour, linewidth=0.8)
        drift.axhline(float(resolution), color=colour, linestyle="--", linewidth=1.0)
        place = (0.0, float(resolution)), (0, above)
        drift.annotate(f"{name} solver", *place, textcoords="offset points", color=colour)
    drift.set(xlabel=axis("t", "s"), ylim=(1e-17, 1e-6))
    drift.set(ylabel="drift relative to the largest\nmomentum of one body")
    return {"drivetrain-momentum": figure}


STUDY.provides(figures=draw)
