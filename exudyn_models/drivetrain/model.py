"""A dry clutch in its drivetrain, built of public parts: the paper's disc between an engine and a vehicle.

Engine and flywheel press on both facings of the clutch disc on the gearbox's input shaft, which is radially elastic
and may be offset. A torsional spring and damper connect the disc to the gearbox and the vehicle.
"""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import exudyn as exu
import numpy as np

from exudyn_models.drivetrain.parameters import Drivetrain
from exudyn_models.forces.load_and_coefficient import NumberOrFunction
from exudyn_models.parts.energy_balance import EnergyBalance, add_energy_balance, spring_energy
from exudyn_models.parts.friction_sensors import RingFriction
from exudyn_models.parts.radial_support import RadialSupport, add_radial_support
from exudyn_models.parts.ring_friction import add_ring_friction
from exudyn_models.parts.rotational.torques import Torque, add_torque
from exudyn_models.solver.items import add_rotor, coordinate_marker, items, node_sensor
from exudyn_models.solver.solve_dynamic import solve_dynamic
from exudyn_models.solver.solver_run import quiet
from exudyn_models.solver.works import Power
from reference_model.systems import (
    FloatArray,
    checked_tolerance,
    finite_number,
    positive_number,
    require_callable,
    require_kind,
)

ENERGY_UNIT = 1e3
"""Unit of energy of the energy balance in J."""

ANGLE, SPEED = exu.OutputVariableType.Coordinates, exu.OutputVariableType.Coordinates_t
"""Output variables of a node."""


@dataclass(frozen=True, eq=False)
class DrivetrainMotion:
    """The motion of a drivetrain; all arrays of shape (n,) or, for the disc, (n, 3).

    ``times`` are in s, angles in rad and speeds in rad/s. ``disc`` contains x, y in m and the angle in rad,
    ``disc_velocity`` their rates. ``energy`` is the energy balance at the same times.
    """

    times: FloatArray
    engine_angle: FloatArray
    engine_speed: FloatArray
    disc: FloatArray
    disc_velocity: FloatArray
    vehicle_angle: FloatArray
    vehicle_speed: FloatArray
    energy: EnergyBalance

    @property
    def slip(self) -> FloatArray:
        """Speed of the engine relative to the disc, in rad/s."""
        return np.asarray(self.engine_speed - self.disc_velocity[:, 2])


@dataclass(frozen=True, eq=False)
class DrivetrainModel:
    """A drivetrain in Exudyn, assembled.

    ``container`` owns ``mbs`` and must live as long as ``mbs``. ``engine``, ``disc`` and ``vehicle`` are nodes, whose
    coordinates and velocities the ``sensors`` record. ``friction.change(normal_load=...)`` engages the clutch.
    ``support`` holds the disc on its shaft. ``balance`` returns the energy balance after a run.
    """

    container: Any
    mbs: Any
    engine: Any
    disc: Any
    vehicle: Any
    friction: RingFriction
    support: RadialSupport
    sensors: tuple[Any, ...]
    balance: Callable[[], EnergyBalance]

    def slip(self) -> float:
        """Return the current slip in rad/s, for a controller."""
        engine, disc = (self.mbs.GetNodeOutput(node, SPEED) for node in (self.engine, self.disc))
        return float(engine - disc[2])

    def run(
        self, until: float, *, sample_every: float, largest_step: float = 1e-3, tolerance: float = 1e-8
    ) -> DrivetrainMotion:
        """Return the motion from the start to ``until`` (s), sampled every ``sample_every`` s.

        DOPRI5 computes it with steps up to ``largest_step`` (s) and the local error ``tolerance`` in m, rad, m/s,
        rad/s and ``ENERGY_UNIT``. Raises ``SimulationError`` if Exudyn fails or a state is not finite.
        """
        until, sample_every, largest_step = (
            positive_number(name, value, "s")
            for name, value in (
                ("until", until),
                ("sample_every", sample_every),
                ("largest_step", largest_step),
            )
        )
        tolerance = checked_tolerance(tolerance)
        settings = exu.SimulationSettings()
        settings.solution.file.write = False
        settings.solution.sensors.writePeriod = sample_every
        options = settings.timeIntegration
        options.verboseMode = 0
        options.endTime, options.numberOfSteps = until, math.ceil(until / largest_step)
        options.absoluteTolerance, options.relativeTolerance = tolerance, 0.0
        options.initialStepSize = min(1e-6, until)
        with quiet():
            solve_dynamic(self.mbs, settings, exu.DynamicSolverType.DOPRI5)
        stored = [self.mbs.GetSensorStoredData(sensor) for sensor in self.sensors]
        engine, engine_speed, disc, disc_velocity, vehicle, vehicle_speed = (
            values[:, 1:] for values in stored
        )
        return DrivetrainMotion(
            stored[0][:, 0],
            engine[:, 0],
            engine_speed[:, 0],
            disc,
            disc_velocity,
            vehicle[:, 0],
            vehicle_speed[:, 0],
            self.balance(),
        )


def build_drivetrain(
    drivetrain: Drivetrain,
    *,
    normal_load: NumberOrFunction,
    regularisation: float,
    engine_speed: float,
    gearbox_speed: float,
    engine_torque: Torque | None = None,
    vehicle_torque: Torque | None = None,
    shaft_torque: float = 0.0,
) -> DrivetrainModel:
    """Build a drivetrain whose disc initially turns with the gearbox about the shaft's axis.

    ``normal_load`` is the load of ``add_ring_friction``, which all facings carry. ``regularisation`` is ε > 0 in m/s.
    Initial speeds are in rad/s, and ``shaft_torque``, in N m, is the initial torque of the torsional spring. Raises
    ``ValueError`` if a number is out of range.
    """
    require_kind("drivetrain", drivetrain, Drivetrain)
    engine_speed = finite_number("engine_speed", engine_speed)
    gearbox_speed = finite_number("gearbox_speed", gearbox_speed)
    shaft_torque = finite_number("shaft_torque", shaft_torque)
    for name, given in (("engine_torque", engine_torque), ("vehicle_torque", vehicle_torque)):
        if given is not None:
            require_callable(name, given, "time", "angle", "speed")
    container = exu.SystemContainer()
    mbs = container.AddSystem()
    twist = shaft_torque / drivetrain.torsional_stiffness if shaft_torque else 0.0
    engine = add_rotor(mbs, drivetrain.engine_inertia, engine_speed)
    vehicle = add_rotor(mbs, drivetrain.vehicle_inertia, gearbox_speed, -twist)
    disc = _add_disc(mbs, drivetrain, gearbox_speed)
    support = _add_shaft(mbs, drivetrain, disc)
    torsion = _add_torsional_spring(mbs, drivetrain, vehicle, disc)
    friction = add_ring_friction(
        mbs,
        engine,
        disc,
        **drivetrain.contact,
        friction_coefficient=drivetrain.friction_coefficient,
        normal_load=normal_load,
        plates=drivetrain.faces,
        regularisation=regularisation,
    )
    torques = {"engine": (engine, engine_torque), "vehicle": (vehicle, vehicle_torque)}
    gains = {
        name: add_torque(mbs, node, torque).power
        for name, (node, torque) in torques.items()
        if torque is not None
    }
    balance = _add_balance(mbs, gains, friction, support, torsion, drivetrain.torsional_damping)
    sensors = tuple(
        node_sensor(mbs, node, variable) for node in (engine, disc, vehicle) for variable in (ANGLE, SPEED)
    )
    mbs.Assemble()
    return DrivetrainModel(container, mbs, engine, disc, vehicle, friction, support, sensors, balance)


def _add_disc(mbs: Any, drivetrain: Drivetrain, speed: float) -> Any:
    e = drivetrain.unbalance
    node = mbs.AddNode(
        items.NodeRigidBody2D(
            referenceCoordinates=[0.0, 0.0, 0.0],
            initialCoordinates=[drivetrain.offset, 0.0, 0.0],
            initialVelocities=[0.0, 0.0, speed],
        )
    )
    mbs.AddObject(
        items.ObjectRigidBody2D(
            nodeNumber=node,
            mass=drivetrain.disc_mass,
            # Exudyn expects the inertia about the node.
            inertia=drivetrain.disc_inertia + drivetrain.disc_mass * e * e,
            centerOfMass=[e, 0.0],
        )
    )
    return node


def _add_shaft(mbs: Any, drivetrain: Drivetrain, disc: Any) -> RadialSupport:
    return add_radial_support(
        mbs,
        None,
        disc,
        stiffness=drivetrain.radial_stiffness,
        damping=drivetrain.radial_damping,
        hardening=drivetrain.hardening,
        stop_gap=drivetrain.stop_gap,
        stop_stiffness=drivetrain.stop_stiffness,
        offset=(drivetrain.offset, 0.0),
    )


def _add_torsional_spring(mbs: Any, drivetrain: Drivetrain, vehicle: Any, disc: Any) -> Any:
    return mbs.AddObject(
        items.ObjectConnectorCoordinateSpringDamper(
            markerNumbers=[coordinate_marker(mbs, vehicle), coordinate_marker(mbs, disc, 2)],
            stiffness=drivetrain.torsional_stiffness,
            damping=drivetrain.torsional_damping,
        )
    )


def _add_balance(
    mbs: Any,
    gains: Mapping[str, Power],
    friction: RingFriction,
    support: RadialSupport,
    torsion: Any,
    torsional_damping: float,
) -> Callable[[], EnergyBalance]:
    def torsional_heat(mbs: Any, t: float) -> float:
        rate = mbs.GetObjectOutput(torsion, exu.OutputVariableType.Velocity)
        return float(torsional_damping * rate * rate)

    return add_energy_balance(
        mbs,
        gains=gains,
        losses={
            "friction": friction.power,
            "radial damper": support.power,
            "torsional damper": torsional_heat,
        },
        stored=[support.stored_energy, spring_energy(torsion)],
        unit=ENERGY_UNIT,
    )
