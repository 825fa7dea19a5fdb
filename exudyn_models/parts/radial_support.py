"""The elastic support of a disc, on the ground or on a body: a spring that may harden, a stop and a damper.

At the deflection w, d = |w|, it pulls the disc back with C·d + C₃·d³ + C_s·max(0, d − gap), and damps with β·ẇ. On a
body it turns with it: w and ẇ are those that an observer on the body sees, so that a motion of both as one rigid body
does nothing, and the damper only takes energy. ẇ is the slip J(q)·q̇ of ``slip_kinematics``; Jᵀ puts the whole reaction
on the body, the moment −d×F included, as friction does.

A support that is linear and on the ground is Exudyn's own ``CartesianSpringDamper``, which takes a tenth of the time
of a Python function. Any other is an ``ObjectGenericODE2`` without mass.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any, Literal, cast, get_args

import exudyn as exu
import exudyn.itemInterface
import numpy as np

from exudyn_models.forces.any_pair import ForceFunction, JacobianFunction
from exudyn_models.forces.jit import compiled, taking_lists
from exudyn_models.forces.load_and_coefficient import checked_not_negative
from exudyn_models.forces.slip_kinematics import (
    IMAGINARY_STEP,
    PLANAR,
    ROTATION_VECTOR,
    ROTOR,
    SIZES,
    TAIT_BRYAN,
    TRANSLATIONS,
    Kinds,
    place_of_disc,
    slip_jacobian,
)
from exudyn_models.parts.ring_friction import checked_kind
from reference_model.systems import FloatArray, finite_number

items: Any = exudyn.itemInterface  # its type hints do not fit its own calls

Law = tuple[float, float, float, float, float]
"""C (N/m), C₃ (N/m³), gap (m), C_s (N/m) and β (N s/m)."""

Offset = tuple[float, float]

ON_GROUND, ON_ROTOR = SIZES[PLANAR], TRANSLATIONS[PLANAR]
"""Of the coordinates of a planar base those that the model has not: a rotor is one without x and y."""

Quantity = Literal["deflection", "force", "stored_energy", "power"]


@dataclass(frozen=True, eq=False)
class RadialSupport:
    """A support that ``add_radial_support`` has added to a model.

    Parameters
    ----------
    mbs : exudyn MainSystem
        The model.
    item : ObjectIndex
        Of the connector.
    nodes : tuple of NodeIndex
        Of the base, but on the ground, and of the disc.

    """

    mbs: Any
    item: Any
    nodes: tuple[Any, ...]
    _kinds: Kinds = field(repr=False)
    _reference: FloatArray = field(repr=False)
    _offset: Offset = field(repr=False)
    _law: Law = field(repr=False)

    def power(self, mbs: Any, t: float) -> float:
        """Return what the damper turns into heat at the current motion, in W, as ``add_energy_balance`` takes it."""
        if (
            len(self.nodes) == 1
        ):  # on the ground, seen at every evaluation: ẇ is the velocity of the disc's node
            vx, vy, *_ = mbs.GetNodeOutput(self.nodes[0], exu.OutputVariableType.Coordinates_t).tolist()
            return float(self._law[4] * (vx * vx + vy * vy))
        return self._state(mbs)[3]

    def stored_energy(self, mbs: Any) -> float:
        """Return what springs and stop hold at the current motion, in J, as ``add_energy_balance`` takes it."""
        return self._state(mbs)[2]

    def add_sensor(self, quantity: Quantity, **options: Any) -> Any:
        """Add a sensor to the model, before it is assembled; return its ``SensorIndex``.

        - ``"deflection"``: w in m, two components in the axes of the base.
        - ``"force"``: on the disc in N, three components in global axes.
        - ``"stored_energy"``: of springs and stop, in J.
        - ``"power"``: what the damper turns into heat, in W.

        ``options`` are those of Exudyn's sensors. Without any the sensor stores its values for
        ``mbs.GetSensorStoredData`` and writes no file.

        Raises
        ------
        ValueError
            If there is no such quantity.

        """
        quantities = get_args(Quantity)
        if quantity not in quantities:
            raise ValueError(f"quantity = {quantity!r}: it must be one of {', '.join(quantities)}")
        place = quantities.index(quantity)

        def values(mbs: Any, t: float, sensors: Any, factors: Any, configuration: Any) -> list[float]:
            return cast(list[float], np.atleast_1d(self._state(mbs, configuration)[place]).tolist())

        options = {"storeInternal": True, "writeToFile": False} | options
        return self.mbs.AddSensor(items.SensorUserFunction(sensorUserFunction=values, **options))

    def _state(
        self, mbs: Any, configuration: Any = exu.ConfigurationType.Current
    ) -> tuple[FloatArray, FloatArray, float, float]:
        """Return deflection, force on the disc in global axes, stored energy and power of the damper."""
        q, q_t = (
            np.hstack([mbs.GetNodeOutput(node, variable, configuration) for node in self.nodes])
            for variable in (exu.OutputVariableType.Coordinates, exu.OutputVariableType.Coordinates_t)
        )
        hidden = np.zeros(len(self._reference) - len(q))
        coordinates, velocities = self._reference + np.hstack((hidden, q)), np.hstack((hidden, q_t))
        to_slip, axes, _ = slip_jacobian(self._kinds, coordinates)
        w = np.array(place_of_disc(self._kinds, coordinates, axes)) - self._offset
        square, rate, damping = float(w @ w), to_slip[:2] @ velocities, self._law[4]
        force = axes[:, :2] @ (-secant_stiffness(square, self._law) * w - damping * rate)
        return w, force, potential(square, self._law), damping * float(rate @ rate)


def add_radial_support(
    mbs: Any,
    base_node: Any,
    disc_node: Any,
    *,
    stiffness: float,
    damping: float = 0.0,
    hardening: float = 0.0,
    stop_gap: float = 0.0,
    stop_stiffness: float = 0.0,
    offset: Sequence[float] = (0.0, 0.0),
) -> RadialSupport:
    """Add springs, a stop and a damper that hold the node of a disc to the ground or to another body.

    On the ground they act in the global x-y plane, on a body across its z-axis and turn with it, as an elastic shaft
    does. They are relaxed where the disc's node is at ``offset``, and press in every radial direction alike; nothing
    holds the disc along the axis or against tilting. ``computeMassMatrixInversePerBody`` must stay False unless the
    support is linear and on the ground, because its nodes are shared with their bodies.

    Parameters
    ----------
    mbs : exudyn MainSystem
        Not yet assembled, with the nodes.
    base_node : NodeIndex or None
        None for the ground. Else a ``Node1D``, which turns about the z-axis through the global origin, a
        ``NodeRigidBody2D``, a ``NodeRigidBodyRotVecLG`` or a ``NodeRigidBodyRxyz``.
    disc_node : NodeIndex
        One of those, but not a ``Node1D``.
    stiffness : float
        C in N/m, >= 0.
    damping : float
        β in N s/m, >= 0.
    hardening : float
        C₃ in N/m³, >= 0.
    stop_gap : float
        Play in m before the stop, >= 0.
    stop_stiffness : float
        C_s in N/m, >= 0; 0 for no stop.
    offset : two floats
        In m; in the axes of the base and from its node, which is the origin for a ``Node1D`` and the ground.

    Raises
    ------
    ValueError
        If a number is out of its range or a node is of a kind that can't be used.

    """
    law: Law = (
        checked_not_negative("stiffness", stiffness, " N/m"),
        checked_not_negative("hardening", hardening, " N/m³"),
        checked_not_negative("stop_gap", stop_gap, " m"),
        checked_not_negative("stop_stiffness", stop_stiffness, " N/m"),
        checked_not_negative("damping", damping, " N s/m"),
    )
    place = _checked_offset(offset)
    disc = checked_kind("disc_node", mbs, disc_node, (PLANAR, ROTATION_VECTOR, TAIT_BRYAN))
    base = PLANAR if base_node is None else checked_kind("base_node", mbs, base_node)
    if base_node is not None and int(base_node) == int(disc_node):
        raise ValueError(f"disc_node {int(disc_node)} is the base_node too: a support takes two bodies")
    nodes = (disc_node,) if base_node is None else (base_node, disc_node)
    hidden = ON_GROUND if base_node is None else ON_ROTOR if base == ROTOR else 0
    kinds = (PLANAR if base == ROTOR else base), disc
    own = [mbs.GetNodeParameter(node, "referenceCoordinates") for node in nodes]
    reference = np.hstack([np.zeros(hidden), *own])
    if base_node is None and hardening == 0.0 and stop_stiffness == 0.0:
        item = _add_springs(mbs, disc_node, place, law)
    else:
        if kinds[0] == PLANAR:
            force = _force_on_flat_base(hidden, reference, place, law)
        else:
            force = _force_on_any_base(kinds, reference, place, law)
        size = len(reference) - hidden
        item = mbs.AddObject(
            items.ObjectGenericODE2(
                nodeNumbers=list(nodes),
                massMatrix=np.zeros((size, size)),
                forceUserFunction=force,
                jacobianUserFunction=_jacobian(hidden, kinds, reference, place, law),
            )
        )
    return RadialSupport(mbs, item, nodes, kinds, reference, place, law)


def _checked_offset(offset: Sequence[float]) -> Offset:
    try:
        x, y = offset
    except (TypeError, ValueError):
        raise ValueError(f"offset = {offset!r}: it must be two numbers, x and y in m") from None
    return finite_number("offset[0]", x), finite_number("offset[1]", y)


def _add_springs(mbs: Any, node: Any, offset: Offset, law: Law) -> Any:
    """Add Exudyn's own springs and dampers from the ground to ``node``; return their ``ObjectIndex``."""
    stiffness, *_, damping = law
    ground = mbs.AddObject(items.ObjectGround(referencePosition=[*offset, 0.0]))
    return mbs.AddObject(
        items.CartesianSpringDamper(
            markerNumbers=[
                mbs.AddMarker(items.MarkerBodyPosition(bodyNumber=ground)),
                mbs.AddMarker(items.MarkerNodePosition(nodeNumber=node)),
            ],
            stiffness=[stiffness, stiffness, 0.0],
            damping=[damping, damping, 0.0],
        )
    )


def _force_on_flat_base(hidden: int, reference: FloatArray, offset: Offset, law: Law) -> ForceFunction:
    """Return the force where the base only turns about the z-axis; its first ``hidden`` coordinates are zero."""
    xb, yb, angle, x, y, *tilts = reference.tolist()
    parameters = [*law, *offset, x - xb, y - yb, angle]
    size = len(reference) - hidden
    evaluate = taking_lists(_ON_FLAT_BASES[hidden], len(parameters), size, size)
    rest = (0.0,) * len(tilts)

    def force(mbs: Any, t: float, item: int, q: Sequence[float], q_t: Sequence[float]) -> Sequence[float]:
        forces: tuple[float, ...] = evaluate(parameters, q, q_t)
        return forces + rest

    return force


def _force_on_any_base(kinds: Kinds, reference: FloatArray, offset: Offset, law: Law) -> ForceFunction:
    def force(mbs: Any, t: float, item: int, q: Sequence[float], q_t: Sequence[float]) -> list[float]:
        forces = support_on_nodes(kinds, reference + q, np.array(q_t), offset, law)
        return cast(list[float], forces.tolist())

    return force


def _jacobian(hidden: int, kinds: Kinds, reference: FloatArray, offset: Offset, law: Law) -> JacobianFunction:
    """Return the Jacobian over all coordinates of base and disc but the first ``hidden``, which are zero."""

    def jacobian(
        mbs: Any,
        t: float,
        item: int,
        q: Sequence[float],
        q_t: Sequence[float],
        position_factor: float,
        velocity_factor: float,
    ) -> FloatArray:
        zeros, factors = np.zeros(hidden), (position_factor, velocity_factor)
        coordinates, velocities = reference + np.hstack((zeros, q)), np.hstack((zeros, q_t))
        derivatives = support_derivatives_on_nodes(kinds, coordinates, velocities, *factors, offset, law)
        return -derivatives[hidden:, hidden:]  # Exudyn takes those of the left-hand side

    return jacobian


@compiled
def secant_stiffness(square: float, law: Law) -> float:
    """Return the force of springs and stop over the deflection d, in N/m, from d²."""
    stiffness, hardening, gap, stop, _ = law
    result = stiffness + hardening * square
    if square > gap * gap:
        result += stop * (1.0 - gap / math.sqrt(square))
    return result


@compiled
def secant_slope(square: float, law: Law) -> float:
    """Return twice the derivative of ``secant_stiffness`` by d², in N/m³."""
    _, hardening, gap, stop, _ = law
    result = 2.0 * hardening
    if square > gap * gap:
        result += stop * gap / (square * math.sqrt(square))
    return result


@compiled
def potential(square: float, law: Law) -> float:
    """Return the energy in J of springs and stop at the deflection d, from d²."""
    stiffness, hardening, gap, stop, _ = law
    beyond = max(0.0, math.sqrt(square) - gap)
    return (stiffness * square + hardening * square * square / 2.0 + stop * beyond * beyond) / 2.0


Parameters = Sequence[float]
"""A ``Law``, an ``Offset``, and the reference values of the disc's place relative to the base and of its angle."""


@compiled
def force_on_ground(parameters: Parameters, q: Sequence[float], q_t: Sequence[float]) -> tuple[float, float]:
    """Return the force on a disc (N) from its coordinates and their rates."""
    fx, fy, _ = _in_the_plane(parameters, q[0], q[1], q_t[0], q_t[1], 0.0, 0.0)
    return fx, fy


@compiled
def forces_on_rotor(
    parameters: Parameters, q: Sequence[float], q_t: Sequence[float]
) -> tuple[float, float, float]:
    """Return the moment on a rotor (N m) and the force on a disc (N)."""
    fx, fy, moment = _in_the_plane(parameters, q[1], q[2], q_t[1], q_t[2], q[0], q_t[0])
    return moment, fx, fy


@compiled
def forces_on_planar_base(
    parameters: Parameters, q: Sequence[float], q_t: Sequence[float]
) -> tuple[float, float, float, float, float]:
    """Return force and moment on a planar body, and the force on a disc."""
    dx, dy, dvx, dvy = q[3] - q[0], q[4] - q[1], q_t[3] - q_t[0], q_t[4] - q_t[1]
    fx, fy, moment = _in_the_plane(parameters, dx, dy, dvx, dvy, q[2], q_t[2])
    return -fx, -fy, moment, fx, fy


@compiled
def _in_the_plane(
    parameters: Parameters, x: float, y: float, vx: float, vy: float, angle: float, spin: float
) -> tuple[float, float, float]:
    """Return force on the disc (N) and moment on the base (N m), in global axes.

    From place (m) and velocity (m/s) of the disc relative to the base, and the base's angle (rad) and spin (rad/s).
    """
    stiffness, hardening, gap, stop, damping, offset_x, offset_y, x0, y0, angle0 = parameters
    x, y, cosine, sine = x0 + x, y0 + y, math.cos(angle0 + angle), math.sin(angle0 + angle)
    wx, wy = x - cosine * offset_x + sine * offset_y, y - sine * offset_x - cosine * offset_y
    secant = secant_stiffness(wx * wx + wy * wy, (stiffness, hardening, gap, stop, damping))
    fx, fy = -secant * wx - damping * (vx + spin * y), -secant * wy - damping * (vy - spin * x)
    return fx, fy, y * fx - x * fy


_ON_FLAT_BASES = {ON_GROUND: force_on_ground, ON_ROTOR: forces_on_rotor, 0: forces_on_planar_base}


@compiled
def support_on_nodes(
    kinds: Kinds, coordinates: FloatArray, velocities: FloatArray, offset: Offset, law: Law
) -> FloatArray:
    """Return the generalised forces on both nodes, shape (n,)."""
    to_slip, axes, _ = slip_jacobian(kinds, coordinates)
    x, y = place_of_disc(kinds, coordinates, axes)
    wx, wy = x - offset[0], y - offset[1]
    rate = to_slip @ velocities
    secant = secant_stiffness(wx * wx + wy * wy, law)
    fx, fy = -secant * wx - law[4] * rate[0], -secant * wy - law[4] * rate[1]
    forces: FloatArray = fx * to_slip[0] + fy * to_slip[1]
    return forces


@compiled
def support_derivatives_on_nodes(
    kinds: Kinds,
    coordinates: FloatArray,
    velocities: FloatArray,
    position_factor: float,
    velocity_factor: float,
    offset: Offset,
    law: Law,
) -> FloatArray:
    """Return the derivatives of the generalised forces by coordinates and velocities, weighted and added, (n, n)."""
    to_slip, axes, _ = slip_jacobian(kinds, coordinates)
    w = np.array(place_of_disc(kinds, coordinates, axes)) - np.array(offset)
    rate = to_slip @ velocities
    square, damping = w[0] * w[0] + w[1] * w[1], law[4]
    secant, slope = secant_stiffness(square, law), secant_slope(square, law)
    size = len(coordinates)
    result = np.zeros((size, size))
    for j in range(size):
        stepped = coordinates.astype(np.complex128)
        stepped[j] += 1j * IMAGINARY_STEP
        stepped_map, stepped_axes, _ = slip_jacobian(kinds, stepped)
        shifts = place_of_disc(kinds, stepped, stepped_axes)
        map_change = position_factor * stepped_map.imag / IMAGINARY_STEP
        rate_change = map_change @ velocities + velocity_factor * to_slip[:, j]
        shift = position_factor / IMAGINARY_STEP * np.array([shifts[0].imag, shifts[1].imag])
        along = slope * (w[0] * shift[0] + w[1] * shift[1])
        for i in range(2):
            change = secant * shift[i] + along * w[i] + damping * rate_change[i]
            result[:, j] -= change * to_slip[i] + (secant * w[i] + damping * rate[i]) * map_change[i]
    return result
