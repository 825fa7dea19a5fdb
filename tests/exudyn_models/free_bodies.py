"""Discs and rotors without support, and the momenta that friction between them must conserve."""

from typing import Any

import exudyn as exu
import exudyn.rigidBodyUtilities
import numpy as np

from exudyn_models import solve_dynamic
from exudyn_models.solver.items import add_rotor as rotor
from exudyn_models.solver.items import coordinate_marker as coordinate
from exudyn_models.solver.items import items, node_sensor

__all__ = ["coordinate", "items", "node_sensor", "rotor"]

rotations: Any = exudyn.rigidBodyUtilities


def planar_body(mbs: Any, mass: float, inertia: float, position: list[float], velocity: list[float]) -> Any:
    # Half of the position is in the reference coordinates, to expose a connector that omits them.
    half = [value / 2.0 for value in position]
    node = mbs.AddNode(
        items.NodeRigidBody2D(referenceCoordinates=half, initialCoordinates=half, initialVelocities=velocity)
    )
    mbs.AddObject(items.ObjectRigidBody2D(nodeNumber=node, mass=mass, inertia=inertia))
    return node


def ball(
    mbs: Any, kind: Any, mass: float, inertia: float, place: Any, velocity: Any, spin: Any, axes: Any = None
) -> Any:
    """Add a body with a node of ``kind``, the same inertia about all axes, and ``axes`` as columns."""
    return mbs.CreateRigidBody(
        inertia=rotations.RigidBodyInertia(mass=mass, inertiaTensor=inertia * np.eye(3)),
        nodeType=kind,
        referencePosition=place,
        referenceRotationMatrix=np.eye(3) if axes is None else axes,
        initialVelocity=velocity,
        initialAngularVelocity=spin,
    )


def settings_of(end: float, steps: int, start: float = 0.0, newton: float | None = None) -> Any:
    """Return settings of a quiet run without files; ``newton`` is the residual of implicit solvers."""
    settings = exu.SimulationSettings()
    settings.solution.file.write = False
    options = settings.timeIntegration
    options.startTime, options.endTime, options.numberOfSteps, options.verboseMode = start, end, steps, 0
    if newton is not None:
        options.newton.relativeTolerance = options.newton.absoluteTolerance = newton
    return settings


def run_explicitly(mbs: Any, end: float, steps: int = 6000) -> None:
    if not mbs.systemIsConsistent:
        mbs.Assemble()
    settings = settings_of(end, steps)
    settings.timeIntegration.solverType = exu.DynamicSolverType.RK67
    assert exu.MainSolverExplicit().SolveSystem(mbs, settings)


def new_model() -> Any:
    return exu.SystemContainer().AddSystem()


def changes_of(
    mbs: Any, end: float, step: float, solver: Any = exu.DynamicSolverType.TrapezoidalIndex2, **options: Any
) -> list[tuple[float, int, int, int]]:
    """Return the changes of mode in a run as (time, contact, before, after)."""
    changes = solve_dynamic(mbs, settings_of(end, round(end / step)), solver, **options)
    return [(change.time, change.contact, int(change.before), int(change.after)) for change in changes]


def drive(mbs: Any, node: Any, load: Any) -> None:
    """Add a load, a number or a function of time, on the first coordinate of a node."""
    marker = coordinate(mbs, node)
    if callable(load):
        mbs.AddLoad(items.LoadCoordinate(markerNumber=marker, loadUserFunction=lambda mbs, t, _: load(t)))
    else:
        mbs.AddLoad(items.LoadCoordinate(markerNumber=marker, load=load))


def rate_of(mbs: Any, node: Any) -> float:
    """Return the rate of the only coordinate of a node."""
    return float(np.squeeze(mbs.GetNodeOutput(node, exu.OutputVariableType.Coordinates_t)))


def all_states(mbs: Any) -> np.ndarray:
    return np.hstack((mbs.systemData.GetODE2Coordinates(), mbs.systemData.GetODE2Coordinates_t()))


def felt_accelerations(mbs: Any, node: Any) -> Any:
    """Add a sensor of the second derivatives of a node's coordinates."""
    return node_sensor(mbs, node, exu.OutputVariableType.Coordinates_tt)


def coordinates(mbs: Any, node: Any) -> tuple[np.ndarray, np.ndarray]:
    kinds = exu.OutputVariableType
    position = np.atleast_1d(mbs.GetNodeOutput(node, kinds.Coordinates))
    velocity = np.atleast_1d(mbs.GetNodeOutput(node, kinds.Coordinates_t))
    return position + mbs.GetNodeParameter(node, "referenceCoordinates"), velocity


def momenta(mbs: Any, bodies: list[tuple[Any, float, float]]) -> np.ndarray:
    """Return the momentum in x and y, and the angular momentum about the origin."""
    total = np.zeros(3)
    for node, mass, inertia in bodies:
        (x, y, _), (vx, vy, spin) = coordinates(mbs, node)
        total += [mass * vx, mass * vy, mass * (x * vy - y * vx) + inertia * spin]
    return total


def spatial_body(
    mbs: Any, kind: Any, mass: float, inertia: list[float], position: list[float], velocity: list[float]
) -> Any:
    """Add a body with a node of ``kind`` and the principal moments of ``inertia``."""
    half = [value / 2.0 for value in position]
    node = mbs.AddNode(kind(referenceCoordinates=half, initialCoordinates=half, initialVelocities=velocity))
    mbs.AddObject(items.ObjectRigidBody(nodeNumber=node, mass=mass, inertia=[*inertia, 0.0, 0.0, 0.0]))
    return node


def euler_body(
    mbs: Any, mass: float, inertia: list[float], position: list[float], velocity: list[float]
) -> Any:
    """Add the body that ``spatial_body`` adds with angles, with Euler parameters."""
    parameters = rotations.RotationMatrix2EulerParameters(rotations.RotXYZ2RotationMatrix(position[3:]))
    spin = rotations.RotXYZ2G(position[3:]) @ np.array(velocity[3:])
    rates = rotations.AngularVelocity2EulerParameters_t(spin, parameters)
    half, reference = [value / 2.0 for value in position[:3]], [1.0, 0.0, 0.0, 0.0]
    node = mbs.AddNode(
        items.NodeRigidBodyEP(
            referenceCoordinates=[*half, *reference],
            initialCoordinates=[*half, *(parameters - reference)],
            initialVelocities=[*velocity[:3], *rates],
        )
    )
    mbs.AddObject(items.ObjectRigidBody(nodeNumber=node, mass=mass, inertia=[*inertia, 0.0, 0.0, 0.0]))
    return node


def spatial_momenta(mbs: Any, node: Any, mass: float, inertia: Any) -> np.ndarray:
    """Return momentum and angular momentum about the origin, (6,), from Exudyn's positions and rotations."""
    kinds = exu.OutputVariableType
    position, velocity, spin, rotation = (
        mbs.GetNodeOutput(node, kind)
        for kind in (kinds.Position, kinds.Velocity, kinds.AngularVelocityLocal, kinds.RotationMatrix)
    )
    own = rotation.reshape(3, 3) @ (np.diag(inertia) @ spin)
    return np.hstack((mass * velocity, mass * np.cross(position, velocity) + own))


def spatial_energy(mbs: Any, node: Any, mass: float, inertia: Any) -> float:
    """Kinetic energy in J."""
    kinds = exu.OutputVariableType
    velocity, spin = (mbs.GetNodeOutput(node, kind) for kind in (kinds.Velocity, kinds.AngularVelocityLocal))
    return float(mass * velocity @ velocity + spin @ (inertia * spin)) / 2.0
