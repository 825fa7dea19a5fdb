"""A dry clutch in its drivetrain, built of public parts: the paper's disc between an engine and a vehicle.

Engine and flywheel press on the clutch disc with both of its facings. The disc sits on the gearbox's input shaft,
which is elastic in radial direction and whose axis may lie beside that of the engine. A torsional spring and damper
lead from the disc to the gearbox and the vehicle.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, fields
from typing import Any, TypeAlias

import exudyn as exu
import exudyn.itemInterface
import numpy as np

from exudyn_models.forces.load_and_coefficient import NumberOrFunction
from exudyn_models.parts.energy_balance import EnergyBalance, Power, add_energy_balance, spring_energy
from exudyn_models.parts.friction_sensors import RingFriction
from exudyn_models.parts.radial_support import RadialSupport, add_radial_support
from exudyn_models.parts.ring_friction import add_ring_friction
from exudyn_models.solver.solve_dynamic import solve_dynamic
from exudyn_models.solver.solver_run import quiet
from reference_model.systems import FloatArray, finite_number

items: Any = exudyn.itemInterface  # its type hints do not fit its own calls

Torque: TypeAlias = Callable[[float, float, float], float]
"""Takes time (s), angle (rad) and speed (rad/s) of a shaft, and returns a torque in N m."""


@dataclass(frozen=True, kw_only=True)
class Drivetrain:
    """Parameters of an engine with flywheel, a dry clutch and a vehicle, as seen from the gearbox's input shaft.

    Parameters
    ----------
    engine_inertia : float
        Of crankshaft, flywheel and clutch cover in kg m², > 0.
    disc_mass, disc_inertia : float
        Of the clutch disc in kg and kg m², > 0.
    unbalance : float
        Distance in m of the disc's centre of mass from the centre of its facings, >= 0.
    inner_radius, outer_radius : float
        Of the facings in m; a ring if they are alike.
    faces : int
        Number of facings, >= 1.
    friction_coefficient : float
        μ of a facing, >= 0.
    offset : float
        X0 in m: the shaft's axis is at (X0, 0), that of the engine at (0, 0).
    radial_stiffness, radial_damping : float
        C in N/m and β in N s/m of the disc on its shaft, >= 0.
    hardening, stop_gap, stop_stiffness : float
        C₃ in N/m³, play in m and C_s in N/m of that support, as ``add_radial_support`` takes them.
    torsional_stiffness, torsional_damping : float
        Between disc and gearbox, in N m/rad and N m s/rad, >= 0.
    vehicle_inertia : float
        Of gearbox, wheels and vehicle in kg m², as seen from the input shaft, > 0.

    Raises
    ------
    ValueError
        If a value is not a finite number or is outside of its range.

    """

    engine_inertia: float
    disc_mass: float
    disc_inertia: float
    unbalance: float = 0.0
    inner_radius: float
    outer_radius: float
    faces: int = 2
    friction_coefficient: float
    offset: float = 0.0
    radial_stiffness: float
    radial_damping: float
    hardening: float = 0.0
    stop_gap: float = 0.0
    stop_stiffness: float = 0.0
    torsional_stiffness: float
    torsional_damping: float
    vehicle_inertia: float

    def __post_init__(self) -> None:
        """Refuse what no drivetrain can be; what its parts are made of is checked by those."""
        for field in fields(self):
            value = finite_number(field.name, getattr(self, field.name))
            if field.name.endswith(("inertia", "mass", "outer_radius")) and value <= 0.0:
                raise ValueError(f"{field.name} = {value:g}: it must be > 0")
            if field.name != "offset" and value < 0.0:
                raise ValueError(f"{field.name} = {value:g}: it must be >= 0")
        if self.faces < 1 or self.faces != int(self.faces):
            raise ValueError(f"faces = {self.faces}: it must be a whole number >= 1")

    @property
    def friction_radius(self) -> float:
        """Torque over friction force of facings that slip about their centre under uniform pressure, in m."""
        ri, ro = self.inner_radius, self.outer_radius
        return 2.0 / 3.0 * (ri * ri + ri * ro + ro * ro) / (ri + ro)

    @property
    def contact(self) -> dict[str, Any]:
        """The facings as ``add_ring_friction`` takes them."""
        if self.inner_radius == self.outer_radius:
            return {"contact_radius": self.outer_radius}
        return {"inner_radius": self.inner_radius, "outer_radius": self.outer_radius}

    def normal_load(self, torque: float) -> float:
        """Return the load in N of each facing under which the slipping clutch transmits ``torque`` (N m)."""
        return torque / (self.faces * self.friction_coefficient * self.friction_radius)


PASSENGER_CAR = Drivetrain(
    engine_inertia=0.2,
    disc_mass=1.2,
    disc_inertia=0.006,
    unbalance=1.5e-5,
    inner_radius=0.075,
    outer_radius=0.114,
    friction_coefficient=0.3,
    offset=2e-4,
    radial_stiffness=1.08e5,
    radial_damping=36.0,
    stop_gap=5e-4,
    stop_stiffness=2e6,
    torsional_stiffness=1000.0,
    torsional_damping=2.0,
    vehicle_inertia=0.75,
)
"""A passenger car of 1,300 kg in first gear: typical values, and assumptions where none are published.

- Vehicle: 1300 kg on wheels of 0.3 m behind 13 : 1, 0.69 kg m², and the gearbox.
- Engine with flywheel, and disc: assumed, below the inertias of a light truck in Applied Sciences 9 (2019) 4287,
  table A3, 0.3 and 0.045 kg m²; clamp loads there are up to 10 kN. Facings of 228 by 150 mm are a size sold for
  petrol engines of 150 N m; dry ones have μ = 0.2 to 0.4 (Modelica Standard Library, Rotational.Components.Clutch).
- Torsional spring: 17 N m per degree.
- Radially, assumed: the stiffness of a steel shaft of 18 mm that is free over 0.31 m, which puts the natural
  frequency at 2865 turns a minute, 5 % of critical damping, play of 0.5 mm in the pilot bearing, 0.2 mm between the
  axes, an unbalance of 18 g mm. That the radial mode of clutch discs becomes unstable in engagement is known:
  Proceedings of the IMechE, Part C (2020), doi 10.1177/0954406220927065.
"""

ENERGY_UNIT = 1e3
"""J in which the energy balance counts."""


def four_cylinder(mean: float, ripple: float) -> Torque:
    """Return the torque of a four-stroke engine with four cylinders, which fire twice a turn.

    It is T·(1 + r·cos 2θ): the mean T = ``mean`` in N m, and what the firing order adds to it, ``ripple`` = r times
    the mean.
    """
    mean, ripple = finite_number("mean", mean), finite_number("ripple", ripple)
    return lambda time, angle, speed: mean * (1.0 + ripple * math.cos(2.0 * angle))


@dataclass(frozen=True, eq=False)
class DrivetrainMotion:
    """How a drivetrain moved; all arrays of shape (n,) or, of the disc, (n, 3).

    Parameters
    ----------
    times : array
        In s.
    engine_angle, engine_speed, vehicle_angle, vehicle_speed : array
        In rad and rad/s.
    disc, disc_velocity : array
        x, y in m and the angle in rad; in m/s and rad/s.
    energy : EnergyBalance
        At the same times.

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
        """By how much the engine turns faster than the disc, in rad/s."""
        return np.asarray(self.engine_speed - self.disc_velocity[:, 2])


@dataclass(frozen=True, eq=False)
class DrivetrainModel:
    """A drivetrain in Exudyn, assembled.

    Parameters
    ----------
    container, mbs : SystemContainer, MainSystem
        ``container`` owns ``mbs`` and must live as long.
    engine, disc, vehicle : NodeIndex
        Of the three bodies.
    friction : RingFriction
        The clutch. ``friction.change(normal_load=...)`` engages it.
    support : RadialSupport
        Of the disc on its shaft.
    sensors : tuple of SensorIndex
        Of coordinates and velocities of engine, disc and vehicle.
    balance : callable
        Reads the energy balance after a run.

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
        """Return the slip (rad/s) of the current motion, for a controller."""
        variable = exu.OutputVariableType.Coordinates_t
        engine, disc = (self.mbs.GetNodeOutput(node, variable) for node in (self.engine, self.disc))
        return float(engine - disc[2])

    def run(
        self, until: float, *, sample_every: float, largest_step: float = 1e-3, tolerance: float = 1e-8
    ) -> DrivetrainMotion:
        """Return the motion from the start to ``until`` (s), sampled every ``sample_every`` s.

        By DOPRI5 with steps up to ``largest_step`` (s) and the local error ``tolerance`` in m, rad, m/s, rad/s and in
        ``ENERGY_UNIT``.

        Raises
        ------
        SimulationError
            If Exudyn gives up or a state is not finite.

        """
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
    """Build a drivetrain whose disc turns with the gearbox about the shaft's axis.

    Parameters
    ----------
    drivetrain : Drivetrain
        The parameters.
    normal_load : float or callable
        Of each facing, as ``add_ring_friction`` takes it.
    regularisation : float
        ε in m/s, > 0.
    engine_speed, gearbox_speed : float
        With which the run starts, in rad/s.
    engine_torque, vehicle_torque : callable, optional
        Torques on engine and vehicle.
    shaft_torque : float
        In N m, by which the torsional spring is wound up at the start.

    Raises
    ------
    ValueError
        If a number is out of its range.

    """
    container = exu.SystemContainer()
    mbs = container.AddSystem()
    twist = shaft_torque / drivetrain.torsional_stiffness if shaft_torque else 0.0
    engine = _add_rotor(mbs, drivetrain.engine_inertia, 0.0, engine_speed)
    vehicle = _add_rotor(mbs, drivetrain.vehicle_inertia, -twist, gearbox_speed)
    e = drivetrain.unbalance
    disc = mbs.AddNode(
        items.NodeRigidBody2D(
            referenceCoordinates=[0.0, 0.0, 0.0],
            initialCoordinates=[drivetrain.offset, 0.0, 0.0],
            initialVelocities=[0.0, 0.0, gearbox_speed],
        )
    )
    mbs.AddObject(
        items.ObjectRigidBody2D(
            nodeNumber=disc,
            mass=drivetrain.disc_mass,
            # Exudyn counts it about the node.
            inertia=drivetrain.disc_inertia + drivetrain.disc_mass * e * e,
            centerOfMass=[e, 0.0],
        )
    )
    support = add_radial_support(
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
    torsion = mbs.AddObject(
        items.ObjectConnectorCoordinateSpringDamper(
            markerNumbers=[_coordinate(mbs, vehicle, 0), _coordinate(mbs, disc, 2)],
            stiffness=drivetrain.torsional_stiffness,
            damping=drivetrain.torsional_damping,
        )
    )
    friction = add_ring_friction(
        mbs,
        engine,
        disc,
        **drivetrain.contact,
        friction_coefficient=drivetrain.faces * drivetrain.friction_coefficient,
        normal_load=normal_load,
        regularisation=regularisation,
    )
    gains: dict[str, Power] = {}
    for name, node, torque in (("engine", engine, engine_torque), ("vehicle", vehicle, vehicle_torque)):
        if torque is not None:
            gains[name] = _add_torque(mbs, node, torque)

    def torsional_heat(mbs: Any, t: float) -> float:
        rate = mbs.GetObjectOutput(torsion, exu.OutputVariableType.Velocity)
        return float(drivetrain.torsional_damping * rate * rate)

    balance = add_energy_balance(
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
    sensors = tuple(
        mbs.AddSensor(
            items.SensorNode(
                nodeNumber=node, outputVariableType=variable, storeInternal=True, writeToFile=False
            )
        )
        for node in (engine, disc, vehicle)
        for variable in (exu.OutputVariableType.Coordinates, exu.OutputVariableType.Coordinates_t)
    )
    mbs.Assemble()
    return DrivetrainModel(container, mbs, engine, disc, vehicle, friction, support, sensors, balance)


def _add_rotor(mbs: Any, inertia: float, angle: float, speed: float) -> Any:
    """Add a rotor about the z-axis; return its ``NodeIndex``."""
    node = mbs.AddNode(
        items.Node1D(referenceCoordinates=[0.0], initialCoordinates=[angle], initialVelocities=[speed])
    )
    mbs.AddObject(items.ObjectRotationalMass1D(nodeNumber=node, inertia=inertia))
    return node


def _coordinate(mbs: Any, node: Any, coordinate: int) -> Any:
    """Add a marker of a coordinate of a node; return its ``MarkerIndex``."""
    return mbs.AddMarker(items.MarkerNodeCoordinate(nodeNumber=node, coordinate=coordinate))


def _add_torque(mbs: Any, node: Any, torque: Torque) -> Power:
    """Let ``torque`` act on a rotor; return its power."""

    def now(mbs: Any, t: float) -> tuple[float, float]:
        """Return torque and speed."""
        angle, speed = (
            float(mbs.GetNodeOutput(node, variable))
            for variable in (exu.OutputVariableType.Coordinates, exu.OutputVariableType.Coordinates_t)
        )
        return torque(t, angle, speed), speed

    mbs.AddLoad(
        items.LoadCoordinate(
            markerNumber=_coordinate(mbs, node, 0),
            load=0.0,
            loadUserFunction=lambda mbs, t, load: now(mbs, t)[0],
        )
    )

    def power(mbs: Any, t: float) -> float:
        moment, speed = now(mbs, t)
        return moment * speed

    return power
