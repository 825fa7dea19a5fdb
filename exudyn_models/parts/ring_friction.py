"""Dry friction between two bodies on a ring or at points of it: one connector for pins, discs and drivetrains.

It applies the full reaction to the master, see ``connector``. The law is in ``friction_laws``, the handle returned by
``add_ring_friction`` in ``friction_sensors``.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from functools import partial
from typing import Any, Protocol

import exudyn.itemInterface
import numpy as np

from exudyn_models.forces.axial_pairs import ON_ONE_AXIS, AxialStick
from exudyn_models.forces.friction_laws import CONTINUOUS, NONE_HELD, Contact
from exudyn_models.forces.laws.places import ring_places, table_of
from exudyn_models.forces.laws.pressures import Pressure, density_of
from exudyn_models.forces.load_and_coefficient import Coefficient, LoadAndCoefficient, NumberOrFunction
from exudyn_models.forces.slip_kinematics import Kinds
from exudyn_models.forces.user_functions import force_and_jacobian
from exudyn_models.parts.connector import add_connector
from exudyn_models.parts.friction_sensors import RingFriction
from exudyn_models.parts.mounts import check_axes, checked_sides, nodes_and_kinds
from exudyn_models.parts.thermal_node import ThermalNode
from exudyn_models.solver.stick.planar_stick import PlanarStick
from reference_model.systems import FloatArray, Place, checked_places, finite_number, positive_number

items: Any = exudyn.itemInterface  # its type hints do not fit its own calls

UNREGULARISED = 1e-200
"""Value of ε in m/s for exact stick, far below any slip of a sliding contact."""


ContactPoints = int | Iterable[Place]
"""Number of points on a circle, or x (m), y (m) and share of the load of each point."""


class AddFriction(Protocol):
    """Adds friction between two discs to a model, as ``add_ring_friction`` does."""

    def __call__(
        self,
        mbs: Any,
        master_node: Any,
        disc_node: Any,
        *,
        contact_radius: float,
        friction_coefficient: float,
        normal_load: float,
        regularisation: float,
        contact_points: ContactPoints | None = None,
    ) -> Any:
        """Add the connector or connectors."""
        ...


def add_ring_friction(
    mbs: Any,
    master_node: Any,
    disc_node: Any,
    *,
    contact_radius: float | None = None,
    inner_radius: float | None = None,
    outer_radius: float | None = None,
    friction_coefficient: Coefficient,
    normal_load: NumberOrFunction,
    regularisation: float | None = None,
    contact_points: ContactPoints | None = None,
    static_ratio: float = 1.0,
    plates: int = 1,
    pressure: Pressure = "uniform",
    thermal_node: ThermalNode | None = None,
    held: int | None = None,
    master_rotation: Any = None,
    disc_rotation: Any = None,
) -> RingFriction:
    """Add friction between a disc and a master disc to ``mbs``; return a handle with the connector and its sensors.

    The contact is a circle of ``contact_radius`` about the disc's node or marker, or ``contact_points`` points on it
    that turn with the disc: point i at the angle φ + 2πi/n, each with an equal share of the normal load N. Points may
    also lie anywhere and carry unequal shares. Or the contact is the annulus between ``inner_radius`` and
    ``outer_radius`` under a ``pressure``. The law is that of ``friction_laws``: Coulomb friction above the slip speed
    ε, viscous below.

    Either node is a ``Node1D``, a ``NodeRigidBody2D``, a ``NodeRigidBodyRotVecLG``, a ``NodeRigidBodyRxyz`` or, for
    implicit solvers, a ``NodeRigidBodyEP``, the default of Exudyn's ``CreateRigidBody``. A ``Node1D`` turns about the
    z-axis of its ``ObjectRotationalMass1D``, which must be added first, or else about the global z-axis. The ground
    is a master at rest, for example for a brake or bearing friction.

    The axis of the contact is the z-axis of the master's body, through its node, or that of the ground. A
    ``MarkerBodyRigid`` moves the contact on its body to the marker, and ``master_rotation`` turns the axis. The plane
    of contact passes through the disc's node or marker, across this axis. A small tilt of the disc is neglected. The
    load acts only through friction and presses nothing together. ``computeMassMatrixInversePerBody`` must stay False,
    because the nodes are shared with their bodies; otherwise Exudyn raises an error.

    Coefficient and load are numbers, or functions of any of these arguments, by name and in any order:

    - ``time`` in s,
    - ``radius`` in m, the distance of the contact's centre from the master's axis,
    - ``slip_speed`` in m/s, the mean slip speed P of the contact,
    - ``relative_spin`` in rad/s, S = φ̇ − ω, positive if the disc is faster,

    for example ``lambda time: ...`` or ``lambda radius, slip_speed: ...``. They may read sensors of ``mbs``, as a
    controller does, but of this contact only the sensors of slip and heat. The Jacobian contains their derivatives by
    all arguments except the time, and none through sensors.

    Without ``regularisation`` the contact sticks exactly: constraints hold the slip until the load exceeds the static
    friction. This requires ``solve_dynamic`` with an implicit solver. The contact does not creep, and the steps can
    be as large as the motion allows. Switching times have the accuracy of the solver's steps. On one axis a contact
    that reverses twice within one step is not detected.

    A static solver keeps the initial velocities of the nodes, so it finds the equilibrium of a disc on a turning
    master.

    Parameters
    ----------
    mbs : exudyn MainSystem
        The model, not yet assembled, with both nodes.
    master_node : NodeIndex or ObjectIndex or MarkerIndex or None
        Node or body of the master, a ``MarkerBodyRigid`` or ``MarkerNodeRigid`` on it, or an ``ObjectGround``; None
        for the ground with the global axes. An index of another model counts as an index in this one.
    disc_node : NodeIndex or ObjectIndex or MarkerIndex
        Node, body or marker of the disc.
    contact_radius : float
        R in m, >= 0; 0 for a pin.
    inner_radius, outer_radius : float
        In place of ``contact_radius``: 0 <= ``inner_radius`` < ``outer_radius``, in m.
    friction_coefficient : float, table or callable
        μ >= 0; a function that returns it, such as a Stribeck curve of the slip speed; or rows of slip speed in m/s
        and μ, the first at 0, linear between the rows and beyond the last one, but not below 0.
    normal_load : float or callable
        Axial force N in N, >= 0, or a function that returns it. All ``plates`` carry it.
    regularisation : float, optional
        ε in m/s, > 0. If None, the contact sticks exactly.
    contact_points : int, sequence of (float, float, float) or None
        n >= 1 points on the circle, or None for the whole circle or annulus. In place of ``contact_radius``: x and y
        of at least two points in m, in the axes of the disc, and their shares of the load, such as a
        ``reference_model.Points``.
    static_ratio : float
        Static over sliding friction, >= 1. Friction holds up to ``static_ratio``·μN and falls to μN between the slip
        speeds ε and 2ε; the effect of this width is of first order in ε.
    plates : int
        Number of pairs of faces in series, >= 1, a factor of friction.
    pressure : {"uniform", "wear"} or callable
        Pressure of an annulus: uniform; ∝ 1/r, as in evenly worn linings; or a smooth function of the radius in m
        that returns it >= 0 in any unit, since the load determines its size.
    thermal_node : ThermalNode, optional
        Heat capacity from ``add_thermal_node`` that friction heats. The coefficient may then also be a function of
        ``temperature``, which is evaluated in Python.
    held : int, optional
        i + 1 for a point i whose friction is viscous at any slip, to model one about which the disc pivots.
    master_rotation, disc_rotation : array of shape (3, 3), optional
        Axes of the contact on either body as columns, in the axes of the body, like ``rotationMarker0`` and
        ``rotationMarker1`` of Exudyn's joints. The third one is the axis of the contact, and the x-axis on the disc
        points to the first contact point. Default: the axes of the bodies.

    Raises
    ------
    ValueError
        If a number is out of range, a function takes other arguments, a node is not in ``mbs`` or of an unsupported
        kind, or points between bodies that can slide sideways have no regularisation. Also if the axis of the contact
        lies across that of a body, which then exerts no moment. If a function returns an invalid number in a run,
        Exudyn raises an ``ExudynError`` with its time and arguments.

    """
    contact = _checked_geometry(
        contact_radius, inner_radius, outer_radius, regularisation, contact_points, held, pressure
    )
    coefficient = friction_coefficient
    if thermal_node is not None:
        if not isinstance(thermal_node, ThermalNode):
            raise ValueError(f"thermal_node = {thermal_node!r}: it must be a result of add_thermal_node")
        coefficient = thermal_node.with_temperature(coefficient)
    factors = LoadAndCoefficient(contact, coefficient, normal_load, static_ratio, plates)
    sides = checked_sides(mbs, master_node, disc_node, rotations=(master_rotation, disc_rotation))
    if contact[0] > 0.0:  # a pin exerts no moment
        check_axes(mbs, *sides)
    nodes, kinds = nodes_and_kinds(*sides)
    reference = np.hstack([mbs.GetNodeParameter(node, "referenceCoordinates") for node in nodes])
    stick = None
    if regularisation is None:
        factors = LoadAndCoefficient(contact, coefficient, normal_load, plates=plates)
        stick = _exact_stick(kinds, reference, factors, static_ratio)
    force, jacobian = (
        (stick.force, stick.jacobian) if stick else force_and_jacobian(kinds, reference, factors)
    )
    item = add_connector(mbs, nodes, force, jacobian)
    if stick is not None:
        stick.locks = _add_locks(mbs, nodes, stick)
    functions = {"force": force, "jacobian": jacobian}
    friction = RingFriction(mbs, item, nodes, kinds, reference, factors, functions, thermal_node, stick)
    if thermal_node is not None:
        thermal_node.heated_by(friction.power)
    return friction


def _exact_stick(
    kinds: Kinds, reference: FloatArray, factors: LoadAndCoefficient, static_ratio: float
) -> AxialStick:
    if kinds in ON_ONE_AXIS:
        return AxialStick(kinds, reference, factors, static_ratio)
    if factors.geometry[1] > 1:
        raise ValueError(
            f"contact_points = {factors.geometry[1]}: each point may stick alone, so points on bodies that can slide "
            "sideways need a regularisation; leave contact_points out for a circle"
        )
    sliding = force_and_jacobian(kinds, reference, factors)
    return PlanarStick(kinds, reference, factors, static_ratio, sliding=sliding)


def _add_locks(mbs: Any, nodes: Sequence[Any], stick: AxialStick) -> tuple[int, ...]:
    """Add the inactive constraints on the slip of both nodes, one for each direction; return their object numbers."""
    if len(nodes) == 1:
        nodes = [mbs.AddNode(items.NodePointGround()), *nodes]
    if not isinstance(stick, PlanarStick):
        markers = [mbs.AddMarker(items.MarkerNodeCoordinate(nodeNumber=node, coordinate=0)) for node in nodes]
        lock = items.ObjectConnectorCoordinate(
            markerNumbers=markers, velocityLevel=True, activeConnector=False
        )
        return (int(mbs.AddObject(lock)),)
    markers = [mbs.AddMarker(items.MarkerNodeCoordinates(nodeNumber=node)) for node in nodes]
    locks = (
        items.ObjectConnectorCoordinateVector(
            markerNumbers=markers,
            scalingMarker0=np.zeros((1, 1)),  # one equation
            velocityLevel=True,
            constraintUserFunction=partial(stick.constraint, i),
            jacobianUserFunction=partial(stick.constraint_jacobian, i),
            activeConnector=False,
        )
        for i in range(3)
    )
    return tuple(int(mbs.AddObject(lock)) for lock in locks)


def _checked_geometry(
    contact_radius: float | None,
    inner_radius: float | None,
    outer_radius: float | None,
    regularisation: float | None,
    contact_points: ContactPoints | None,
    held: int | None,
    pressure: Pressure,
) -> Contact:
    """Return the contact, with 1 N in place of μN; raise ``ValueError`` if it is invalid."""
    regularisation = UNREGULARISED if regularisation is None else regularisation
    if inner_radius is None and outer_radius is None:
        radius, places, epsilon = checked_contact(regularisation, contact_radius, contact_points)
        points, last = (CONTINUOUS, radius) if places is None else (len(places), table_of(places))
        if pressure != "uniform":
            raise ValueError(
                f"pressure = {pressure!r}: it needs an annulus, with inner_radius and outer_radius"
            )
    else:
        last, radius = _checked_annulus(inner_radius, outer_radius, contact_radius, contact_points)
        points = density_of(pressure, last, radius)
        epsilon = positive_number("regularisation", regularisation, "m/s")
    if held is not None and held not in range(1, 1 + points):  # a whole circle has none
        raise ValueError(
            f"held = {held}: it must be from 1 to the number of points, {contact_points}, or None"
        )
    return radius, points, 1.0, epsilon, NONE_HELD if held is None else int(held) - 1, last


def checked_contact(
    regularisation: float, contact_radius: float | None, contact_points: ContactPoints | None
) -> tuple[float, tuple[Place, ...] | None, float]:
    """Return R, places, None for the whole circle, and ε; raise ``ValueError`` if one is out of range."""
    epsilon = positive_number("regularisation", regularisation, "m/s")
    if isinstance(contact_points, Iterable):
        places = checked_places("contact_points", contact_points)
        if contact_radius is not None:
            raise ValueError(
                f"contact_radius = {contact_radius}: it cannot be combined with places of points"
            )
        return max(math.hypot(x, y) for x, y, _ in places), places, epsilon
    radius = finite_number("contact_radius", contact_radius)
    if radius < 0.0:
        raise ValueError(f"contact_radius = {radius:g} m: it must be >= 0")
    if radius == 0.0 and contact_points is None:
        contact_points = 1  # a pin
    if contact_points is None:
        return radius, None, epsilon
    if isinstance(contact_points, bool) or contact_points != int(contact_points) or contact_points < 1:
        raise ValueError(
            f"contact_points = {contact_points}: it must be a whole number >= 1, places of points, or None for the "
            "continuous ring"
        )
    return radius, ring_places(radius, int(contact_points) if radius > 0.0 else 1), epsilon


def _checked_annulus(
    inner_radius: float | None,
    outer_radius: float | None,
    contact_radius: float | None,
    contact_points: ContactPoints | None,
) -> tuple[float, float]:
    for name, value in (("contact_radius", contact_radius), ("contact_points", contact_points)):
        if value is not None:
            raise ValueError(f"{name} = {value}: it cannot be combined with inner_radius and outer_radius")
    inner, outer = finite_number("inner_radius", inner_radius), finite_number("outer_radius", outer_radius)
    if inner < 0.0:
        raise ValueError(f"inner_radius = {inner:g} m: it must be >= 0")
    if outer <= inner:
        raise ValueError(f"outer_radius = {outer:g} m: it must be > inner_radius = {inner:g} m")
    return inner, outer
