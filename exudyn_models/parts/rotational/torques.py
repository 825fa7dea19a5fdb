"""Torques that depend on the motion of rotors: engines, road loads and torque converters."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any, Literal, TypeAlias, get_args

import numpy as np

from exudyn_models.forces.slip_kinematics import Floats
from exudyn_models.parts.connector import add_connector
from exudyn_models.parts.rotational.couplings import Freedom, RotorCoupling, freedoms_of, nodes_of, places_of
from exudyn_models.parts.rotational.sliders import add_slider_friction
from exudyn_models.solver.items import CURRENT, IN_MEMORY, items
from reference_model.systems import (
    LEAST,
    FloatArray,
    checked_parameter,
    finite_number,
    finite_numbers,
    positive_number,
    real_numbers,
    require_callable,
    require_choice,
    shown,
)

Torque: TypeAlias = Callable[[float, float, float], float]
"""Function of time (s), angle (rad) and speed (rad/s) of a shaft; returns a torque in N m."""

Torques: TypeAlias = Callable[[float, Floats, Floats], Sequence[float]]
"""Function of time and of the angles and speeds of several shafts; returns their torques."""

CHANGE = 1e-6
"""Change of angles and speeds for the differences of torques, relative to 1 or their size."""

GRAVITY = 9.81
"""Acceleration in m/s²."""

Quantity = Literal["torque", "power"]


@dataclass(frozen=True, eq=False)
class RotorTorques:
    """Handle of torques on rotors; ``item`` is the ``ObjectIndex`` of their connector in ``mbs``."""

    mbs: Any
    item: Any
    _torques: Torques = field(repr=False)
    _freedoms: tuple[Freedom, ...] = field(repr=False)

    def add_sensor(self, quantity: Quantity, **options: Any) -> Any:
        """Add a sensor of the ``"torque"`` on each rotor in N m, or of ``"power"`` in W; return its ``SensorIndex``.

        ``options`` are those of Exudyn's sensors. Raises ``ValueError`` for other quantities.
        """
        require_choice("quantity", quantity, get_args(Quantity))

        def value(mbs: Any, t: float, sensors: Any, factors: Any, configuration: Any) -> list[float]:
            return list(self._torques(t, *self.motion())) if quantity == "torque" else [self.power(mbs, t)]

        return self.mbs.AddSensor(items.SensorUserFunction(sensorUserFunction=value, **IN_MEMORY | options))

    def power(self, mbs: Any, t: float) -> float:
        """Return the supplied power in W, a gain in an energy balance."""
        angles, speeds = self.motion()
        return float(np.dot(self._torques(t, angles, speeds), speeds))

    def lost_power(self, mbs: Any, t: float) -> float:
        """Return the removed power in W, a loss in an energy balance."""
        return -self.power(mbs, t)

    def motion(self) -> tuple[Floats, Floats]:
        """Return the present angles and speeds of the rotors."""
        data, starts = self.mbs.systemData, [self.mbs.GetNodeODE2Index(one.node) for one in self._freedoms]
        places = [start + one.coordinate for start, one in zip(starts, self._freedoms, strict=True)]
        q, q_t = data.GetODE2Coordinates(CURRENT, False), data.GetODE2Coordinates_t(CURRENT, False)
        return q[places].tolist(), q_t[places].tolist()


def add_torques(mbs: Any, torques: Torques, **rotors: Any) -> RotorTorques:
    """Add torques that depend on the motion of ``rotors``, by the names of arguments; return their handle."""
    freedoms = freedoms_of(mbs, **rotors)
    if None in freedoms:
        name = list(rotors)[freedoms.index(None)]
        raise ValueError(f"{name} = None: a torque must act on a rotor, not on the ground")
    own = tuple(one for one in freedoms if one is not None)
    places = places_of(own)

    def at(t: float, q: Floats, q_t: Floats) -> Sequence[float]:
        return torques(t, [q[place] for place in places], [q_t[place] for place in places])

    def force(mbs: Any, t: float, item: int, q: Floats, q_t: Floats) -> list[float]:
        found = [0.0] * len(q)
        for place, torque in zip(places, at(t, q, q_t), strict=True):
            found[place] = torque
        return found

    def jacobian(
        mbs: Any, t: float, item: int, q: Floats, q_t: Floats, position_factor: float, velocity_factor: float
    ) -> FloatArray:
        motion, found = np.array((q, q_t), float), np.zeros((len(q), len(q)))
        for row, factor in enumerate((position_factor, velocity_factor)):
            for place in places:
                change = np.zeros_like(motion)
                change[row, place] = CHANGE * max(1.0, abs(motion[row, place]))
                more, less = (np.array(at(t, *(motion + way * change).tolist())) for way in (1.0, -1.0))
                found[places, place] -= factor * (more - less) / (2.0 * change[row, place])
        return found

    return RotorTorques(mbs, add_connector(mbs, nodes_of(own), force, jacobian), torques, own)


def add_torque(mbs: Any, rotor: Any, torque: Torque) -> RotorTorques:
    """Add a torque on a rotor, a function of ``time``, ``angle`` and ``speed``; return its handle.

    ``rotor`` is one of ``add_gear``, or a slider for a force. ``torque_table`` and ``four_cylinder`` return torques.
    """
    require_callable("torque", torque, "time", "angle", "speed")

    def torques(t: float, angles: Floats, speeds: Floats) -> Sequence[float]:
        found = torque(t, angles[0], speeds[0])
        if not np.isfinite(found):
            raise ValueError(f"torque({t:g}, {angles[0]:g}, {speeds[0]:g}) = {found:g}: it must be finite")
        return [found]

    return add_torques(mbs, torques, rotor=rotor)


def torque_table(
    table: Sequence[Sequence[float]] | FloatArray, throttle: float | Callable[[float], float] = 1.0
) -> Torque:
    """Return the torque of an engine or motor by a table against speed, for ``add_torque``.

    Rows contain the speed in rad/s, increasing, the torque in N m at full load and, by default 0, without load. They
    are linear between and constant beyond the rows. ``throttle``, from 0 to 1 or a function of time, is the share of
    full load.
    """
    rows = _checked_rows("table", finite_numbers("table", table), (2, 3))
    speeds, full, idle = rows[:, 0], rows[:, 1], rows[:, 2] if rows.shape[1] == 3 else np.zeros(len(rows))
    if not callable(throttle):
        throttle = finite_number("throttle", throttle)
        if not 0.0 <= throttle <= 1.0:
            raise ValueError(f"throttle = {throttle:g}: it must be from 0 to 1")

    def torque(time: float, angle: float, speed: float) -> float:
        least, most = np.interp(speed, speeds, idle), np.interp(speed, speeds, full)
        share = throttle(time) if callable(throttle) else throttle
        return float(least + share * (most - least))

    return torque


def add_torque_converter(
    mbs: Any, impeller: Any, turbine: Any, *, table: Sequence[Sequence[float]] | FloatArray
) -> RotorTorques:
    """Add a torque converter whose stator stands on the ground; return its handle.

    Rows of the ``table`` contain the speed ratio ν = ω_turbine/ω_impeller, from 0 to 1, the factor K = ω/√T of the
    impeller in rad/s/√(N m), inf without torque, and the ratio of the turbine's torque to that of the impeller. 1/K²
    and the torque ratio are linear between the rows. The impeller loses T = ω|ω|/K². A faster turbine drives it as a
    fluid coupling with the factor K(1/ν). If the turbine turns backward even faster, the torque ratio approaches 1. A
    lock-up clutch is ``add_ring_friction`` between both rotors.
    """
    ratios, factors, gains = _checked_rows("table", real_numbers("table", table), (3,)).T
    if not (ratios[0] >= 0.0 and ratios[-1] <= 1.0 and factors.min() > 0.0 and gains.min() > 0.0):
        raise ValueError(
            f"table = {shown(table)}: speed ratios must be from 0 to 1, and factors and torque ratios > 0"
        )
    capacities = 1.0 / factors**2

    def torques(t: float, angles: Floats, speeds: Floats) -> Sequence[float]:
        pump, driven = speeds
        if abs(driven) > abs(pump):
            moment = float(np.interp(pump / driven, ratios, capacities)) * driven * abs(driven)
            return moment, -moment * float(np.interp(-pump / driven, (0.0, 1.0), (1.0, gains[0])))
        ratio = driven / pump if pump else 0.0
        moment = float(np.interp(ratio, ratios, capacities)) * pump * abs(pump)
        return -moment, moment * float(np.interp(ratio, ratios, gains))

    return add_torques(mbs, torques, impeller=impeller, turbine=turbine)


@dataclass(frozen=True, eq=False)
class RoadLoad:
    """Handle of the resistance of a vehicle: ``rolling`` friction, and the ``force`` of air and slope."""

    rolling: RotorCoupling
    force: RotorTorques

    def power(self, mbs: Any, t: float) -> float:
        """Return the power in W that the road load removes, a loss in an energy balance."""
        return self.rolling.power(mbs, t) - self.force.power(mbs, t)


def add_road_load(
    mbs: Any,
    vehicle: Any,
    *,
    mass: float,
    rolling: float = 0.0,
    drag_area: float = 0.0,
    slope: float | Callable[[float], float] = 0.0,
    air_density: float = 1.2,
    radius: float = 1.0,
) -> RoadLoad:
    """Add rolling resistance, drag and slope to a vehicle; return their handle.

    Rolling resistance sticks exactly: a vehicle stays at rest on a slope that it does not exceed.

    Parameters
    ----------
    mbs, vehicle : MainSystem, then NodeIndex, ObjectIndex or MarkerIndex
        Model, not yet assembled, and an ``ObjectMass1D`` or a rotor that represents the vehicle.
    mass : float
        Mass in kg that the road carries, > 0.
    rolling, drag_area, air_density : float
        Coefficient of rolling resistance, drag coefficient times area in m², and density in kg/m³, >= 0.
    slope : float or callable
        Angle of the slope in rad, or a function of the position in m.
    radius : float
        Way per angle in m if the vehicle is a rotor, 1 for an ``ObjectMass1D``.

    """
    mass, radius = checked_parameter("mass", mass, "kg", LEAST), positive_number("radius", radius, "m")
    rolling = checked_parameter("rolling", rolling, "", 0.0)
    drag = checked_parameter("drag_area", drag_area, "m²", 0.0) / 2.0
    drag *= checked_parameter("air_density", air_density, "kg/m³", 0.0)
    weight, fixed = mass * GRAVITY, None if callable(slope) else finite_number("slope", slope)
    if fixed is not None and abs(fixed) >= math.pi / 2.0:
        raise ValueError(f"slope = {fixed:g} rad: it must lie between -pi/2 and pi/2")

    def angle_at(position: float) -> float:
        return slope(position) if callable(slope) else float(fixed or 0.0)

    def resistance(time: float, angle: float, speed: float) -> float:
        way = radius * speed
        return -radius * (drag * way * abs(way) + weight * math.sin(angle_at(radius * angle)))

    force = add_torque(mbs, vehicle, resistance)

    def load(time: float) -> float:
        return weight * math.cos(angle_at(radius * force.motion()[0][0]))

    friction = add_slider_friction(
        mbs,
        None,
        vehicle,
        friction_coefficient=rolling,
        normal_load=load if callable(slope) else weight * math.cos(angle_at(0.0)),
        second_radius=radius,
    )
    return RoadLoad(friction, force)


def _checked_rows(name: str, rows: FloatArray, columns: Sequence[int]) -> FloatArray:
    if (
        rows.ndim != 2
        or rows.shape[1] not in columns
        or len(rows) < 2
        or not (np.diff(rows[:, 0]) > 0.0).all()
    ):
        widths = " or ".join(map(str, columns))
        raise ValueError(
            f"{name} = {shown(rows)}: it must have at least two rows of {widths} numbers, and its first column must "
            "increase"
        )
    return rows
