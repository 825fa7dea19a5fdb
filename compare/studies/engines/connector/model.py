"""Two free discs in Exudyn that rub on each other, and their momenta."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from compare.studies.engines.connector.parameters import BODIES, EPSILON, FRICTION, RADIUS, UNTIL
from reference_model.systems import FloatArray


def two_discs(add_friction: Callable[..., Any], steps: int) -> tuple[FloatArray, FloatArray]:
    """Return times in s and x, y, angle, vx, vy, spin of master and disc at 101 of them, shape (101, 2, 6)."""
    import exudyn as exu
    import exudyn.itemInterface

    from exudyn_models.solver.solver_run import quiet

    items: Any = exudyn.itemInterface
    container = exu.SystemContainer()
    mbs = container.AddSystem()
    nodes = []
    for body in BODIES:
        node = mbs.AddNode(
            items.NodeRigidBody2D(initialCoordinates=list(body.place), initialVelocities=list(body.velocity))
        )
        mbs.AddObject(items.ObjectRigidBody2D(nodeNumber=node, mass=body.mass, inertia=body.inertia))
        nodes.append(node)
    add_friction(
        mbs,
        *nodes,
        contact_radius=RADIUS,
        friction_coefficient=1.0,
        normal_load=FRICTION,
        regularisation=EPSILON,
    )
    variables = exu.OutputVariableType
    sensors = [
        mbs.AddSensor(
            items.SensorNode(
                nodeNumber=node, outputVariableType=variable, storeInternal=True, writeToFile=False
            )
        )
        for node in nodes
        for variable in (variables.Coordinates, variables.Coordinates_t)
    ]
    mbs.Assemble()
    settings = exu.SimulationSettings()
    settings.solution.file.write = False
    settings.solution.sensors.writePeriod = UNTIL / 100
    options = settings.timeIntegration
    options.endTime, options.numberOfSteps, options.verboseMode = UNTIL, steps, 0
    options.solverType = exu.DynamicSolverType.RK67
    solver: Any = exu.MainSolverExplicit()
    with quiet():
        solved = solver.SolveSystem(mbs, settings)
    if not solved:
        raise RuntimeError("Exudyn's RK67 gave up on two free discs")
    stored = [np.array(mbs.GetSensorStoredData(sensor)) for sensor in sensors]
    states = np.stack([np.hstack((stored[2 * i][:, 1:], stored[2 * i + 1][:, 1:])) for i in range(2)], axis=1)
    return stored[0][:, 0], states


def momenta(states: FloatArray) -> FloatArray:
    """Momentum in kg m/s and angular momentum about the origin in kg m²/s of each body, shape (..., 2, 3)."""
    mass = np.array([body.mass for body in BODIES])
    inertia = np.array([body.inertia for body in BODIES])
    x, y, _, vx, vy, spin = np.moveaxis(states, -1, 0)
    return np.stack((mass * vx, mass * vy, mass * (x * vy - y * vx) + inertia * spin), axis=-1)
