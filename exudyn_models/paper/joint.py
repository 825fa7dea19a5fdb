"""A joint with friction in Exudyn: a rotor on the ground, with exact stick or with Exudyn's own friction object."""

import math
import time
from typing import Any

import exudyn as exu
import numpy as np
from numpy.typing import ArrayLike

from exudyn_models.parts.ring_friction import add_ring_friction
from exudyn_models.solver.items import items
from exudyn_models.solver.solve_dynamic import solve_dynamic
from exudyn_models.solver.solver_run import quiet
from reference_model.systems import FloatArray, checked_times, checked_tolerance, finite_numbers
from reference_model.systems.joint import FrictionJoint
from reference_model.trajectory import MOST_STEPS, SimulationError, Solution, Trajectory

STEP = 10.0
"""Ratio of the step to the root of the tolerance, in the fastest time constant of spring and damper."""

SLOWEST = 0.3
"""Smallest rate of a motion, divided by its duration: stops and breakaways are found within a step."""

BRISTLE = 1e3
"""Deflection of a native joint under its limit F in rad, divided by the tolerance."""

STATIC = 10.0
"""Ratio of the speed that ends its static friction to the speed of a swing on its bristle."""


def simulate_joint(
    joint: FrictionJoint,
    initial_state: ArrayLike,
    times: ArrayLike,
    *,
    tolerance: float,
    native: bool = False,
) -> Trajectory:
    """Return the motion of a joint by ``TrapezoidalIndex2``, of second order, with exact stick.

    Arguments and errors are the same as in ``exudyn_models.simulate``. The state is the angle in rad and the spin in
    rad/s. With ``native``, Exudyn's ``CoordinateSpringDamperExt`` supplies friction, whose stiff bristle holds the
    joint. This bristle deflects by up to 1e3 tolerances in rad.
    """
    state, grid = finite_numbers("initial_state", initial_state), checked_times(times)
    if state.shape != (2,):
        raise ValueError(f"initial_state has shape {state.shape}: a joint takes an angle and a spin")
    began, span = time.perf_counter(), float(grid[-1] - grid[0])
    turns = span * _rate(joint, native)
    steps = math.ceil(max(turns, SLOWEST) / (STEP * math.sqrt(checked_tolerance(tolerance))))
    if steps > MOST_STEPS:
        raise SimulationError(f"more than {MOST_STEPS:,} steps are needed")
    states = state[np.newaxis]
    if len(grid) > 1:
        deflection = BRISTLE * tolerance if native else 0.0
        states = np.vstack((state, _run(joint, state, grid, steps, deflection)))
    seconds = time.perf_counter() - began
    solution = Solution("Exudyn TrapezoidalIndex2", tolerance, 0, steps, seconds)
    return Trajectory(joint, grid, states, (), solution)


def _rate(joint: FrictionJoint, native: bool) -> float:
    """Return the fastest rate in 1/s of spring and damper, and with ``native`` of a bristle of 1 rad."""
    bristle = math.sqrt(joint.friction_moment / joint.inertia) if native else 0.0
    return max(math.sqrt(joint.stiffness / joint.inertia), joint.damping / joint.inertia, bristle)


def _add_exact_stick(mbs: Any, node: Any, joint: FrictionJoint) -> None:
    """Add friction of this package on a ring of 1 m, which sticks exactly."""
    law: dict[str, Any] = {"contact_radius": 1.0, "friction_coefficient": 1.0}
    load, ratio = joint.friction_moment, joint.static_ratio
    add_ring_friction(mbs, None, node, normal_load=load, static_ratio=ratio, **law)


def _add_bristle(mbs: Any, markers: list[Any], joint: FrictionJoint, deflection: float) -> None:
    """Add Exudyn's friction object, whose bristle is critically damped and deflects by ``deflection`` (rad) at F."""
    stiffness = joint.friction_moment / deflection
    swing = math.sqrt(deflection * joint.friction_moment / joint.inertia)
    slip = items.NodeGenericData(initialCoordinates=[1.0, 0.0, 0.0], numberOfDataCoordinates=3)
    mbs.AddObject(
        items.CoordinateSpringDamperExt(
            markerNumbers=markers,
            nodeNumber=mbs.AddNode(slip),
            dynamicFrictionForce=joint.friction_moment,
            staticFrictionOffsetForce=(joint.static_ratio - 1.0) * joint.friction_moment,
            stickingStiffness=stiffness,
            stickingDamping=2.0 * math.sqrt(stiffness * joint.inertia),
            exponentialDecayStatic=STATIC * swing,
        )
    )


def _run(
    joint: FrictionJoint, state: FloatArray, grid: FloatArray, steps: int, deflection: float
) -> FloatArray:
    container = exu.SystemContainer()
    mbs: Any = container.AddSystem()
    node = mbs.AddNode(items.Node1D(initialCoordinates=[state[0]], initialVelocities=[state[1]]))
    mbs.AddObject(items.ObjectRotationalMass1D(nodeNumber=node, inertia=joint.inertia))
    marker = mbs.AddMarker(items.MarkerNodeCoordinate(nodeNumber=node, coordinate=0))
    ground = mbs.AddMarker(
        items.MarkerNodeCoordinate(nodeNumber=mbs.AddNode(items.NodePointGround()), coordinate=0)
    )
    support = {"stiffness": joint.stiffness, "damping": joint.damping, "offset": joint.offset}
    mbs.AddObject(items.CoordinateSpringDamper(markerNumbers=[ground, marker], **support))
    if joint.moment:
        applied = {"load": 1.0, "loadUserFunction": lambda mbs, t, load: joint.applied(t)}
        mbs.AddLoad(items.LoadCoordinate(markerNumber=marker, **applied))
    if deflection > 0.0:
        _add_bristle(mbs, [ground, marker], joint, deflection)
    else:
        _add_exact_stick(mbs, node, joint)
    sensors = [
        mbs.AddSensor(items.SensorNode(nodeNumber=node, storeInternal=True, outputVariableType=variable))
        for variable in (exu.OutputVariableType.Coordinates, exu.OutputVariableType.Coordinates_t)
    ]
    settings = exu.SimulationSettings()
    settings.solution.file.write = False
    settings.solution.sensors.writePeriod = 0.0  # every step
    options = settings.timeIntegration
    options.startTime, options.endTime, options.numberOfSteps, options.verboseMode = (
        grid[0],
        grid[-1],
        steps,
        0,
    )
    options.newton.absoluteTolerance = options.newton.relativeTolerance = 1e-11
    bends = [at for at, _ in joint.moment if grid[0] < at < grid[-1]]
    breaks = sorted({*bends, *grid[1:-1].tolist()})
    with quiet():
        solve_dynamic(mbs, settings, exu.DynamicSolverType.TrapezoidalIndex2, breaks=breaks)
    rows = mbs.GetSensorStoredData(sensors[0])[:, 0]
    at = np.clip(np.searchsorted(rows, grid[1:], side="right") - 1, 0, len(rows) - 1)
    return np.column_stack([mbs.GetSensorStoredData(sensor)[at, 1] for sensor in sensors])
