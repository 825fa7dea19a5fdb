"""The isolated drivetrain in Exudyn, and the angular momentum of its bodies."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from compare.studies.drivetrain.momentum.parameters import (
    BODIES,
    DAMPING,
    ECCENTRICITY,
    EPSILON,
    FRICTION,
    INNER_RADIUS,
    OUTER_RADIUS,
    PLANAR,
    ROTOR,
    SAMPLES,
    SOLVERS,
    SPATIAL,
    STIFFNESS,
    TORSIONAL_DAMPING,
    TORSIONAL_STIFFNESS,
    UNTIL,
    Body,
    Solver,
)
from reference_model.systems import FloatArray


def angular_momenta(kinds: Sequence[str], solver: Solver, steps: int) -> tuple[FloatArray, FloatArray]:
    """Return times in s, and the angular momentum of each body about the origin in kg m²/s, shape (n, 3, 3)."""
    import exudyn as exu
    import exudyn.itemInterface

    from exudyn_models.solver.solver_run import quiet

    container = exu.SystemContainer()
    mbs = container.AddSystem()
    nodes = _add_drivetrain(mbs, kinds)

    def momenta(mbs: Any, t: float, sensors: Any, factors: Any, configuration: Any) -> list[float]:
        parts = [
            _angular_momentum(mbs, kind, body, node)
            for kind, body, node in zip(kinds, BODIES.values(), nodes, strict=True)
        ]
        return [float(value) for value in np.ravel(parts)]

    items: Any = exudyn.itemInterface
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
    options.newton.useModifiedNewton = True
    options.newton.relativeTolerance = options.newton.absoluteTolerance = 1e-12
    explicit = SOLVERS["explicit"] == solver
    solution: Any = exu.MainSolverExplicit() if explicit else exu.MainSolverImplicitSecondOrder()
    with quiet():
        solved = solution.SolveSystem(mbs, settings)
    if not solved:
        raise RuntimeError(f"Exudyn's {solver.name} gave up on a drivetrain of {', '.join(kinds)}")
    stored = np.array(mbs.GetSensorStoredData(sensor))
    return stored[:, 0], stored[:, 1:].reshape(-1, len(BODIES), 3)


def _add_drivetrain(mbs: Any, kinds: Sequence[str]) -> list[Any]:
    """Add engine, disc and vehicle with nodes of these kinds, and all that acts between them; return the nodes."""
    import exudyn.itemInterface

    from exudyn_models import add_radial_support, add_ring_friction

    items: Any = exudyn.itemInterface
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
    return [engine, disc, vehicle]


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
    (x, y, z), (vx, vy, vz) = place, velocity
    return np.asarray(body.mass * np.array((y * vz - z * vy, z * vx - x * vz, x * vy - y * vx)) + own)
