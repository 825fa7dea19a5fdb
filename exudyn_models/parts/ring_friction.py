"""Dry friction between two bodies on a ring, at points or on an annulus, for pins, discs and drivetrains.

*Contact.* It is a circle about the disc's node or marker, n points on it that turn with the disc (point i at the
angle φ + 2πi/n, with equal shares of the normal load N), points anywhere with any shares, or an annulus under a
pressure. Friction is Coulomb's above the slip speed ε and viscous below.

*Bodies.* The nodes are ``KINDS``; Euler parameters need an implicit solver. A ``Node1D`` turns about the z-axis of
its ``ObjectRotationalMass1D``, which must be added first, or else about the global z-axis. The ground is a master at
rest. ``computeMassMatrixInversePerBody`` must stay False, because nodes are shared with their bodies.

The axis of the contact is the z-axis of the master's body, through its node, or the z-axis of the ground. A
``MarkerBodyRigid`` moves the contact on its body to the marker. Rotations turn it like ``rotationMarker0`` and
``rotationMarker1`` of Exudyn's joints; the x-axis on the disc points to the first contact point. The plane of contact
passes through the disc's node or marker, across this axis; a small tilt of the disc is neglected. The load acts only
through friction; it does not press the bodies together.

*Functions.* Coefficient and load may be functions of any of these arguments, by name and in any order:

- ``time`` in s,
- ``radius`` in m, the distance of the contact's centre from the master's axis,
- ``slip_speed`` in m/s, the mean slip speed P of the contact,
- ``relative_spin`` in rad/s, S = φ̇ − ω, positive if the disc is faster.

They may read sensors of ``mbs``, but only the slip and heat sensors of this contact. The Jacobian includes their
derivatives with respect to all arguments except time. It does not include dependencies through sensors.

*Exact stick.* Without ε, constraints hold the slip at zero until the load exceeds static friction. This requires
``solve_dynamic`` with an implicit solver. Switching times are as accurate as the steps. A contact on one axis that
reverses twice within a step goes undetected. Several points stick separately, each with its own slip speed, unless
joints hold the disc on the contact's axis.
"""

import math
from collections.abc import Iterable, Sequence
from typing import Any, Protocol

import numpy as np

from exudyn_models.forces.axial_pairs import ON_ONE_AXIS, AxialStick, on_one_axis
from exudyn_models.forces.friction_laws import CONTINUOUS, NONE_HELD, mean_radius
from exudyn_models.forces.friction_laws import Contact as Geometry
from exudyn_models.forces.laws.places import places_in, ring_places, table_of
from exudyn_models.forces.laws.pressures import Pressure, density_of
from exudyn_models.forces.load_and_coefficient import Coefficient, LoadAndCoefficient, NumberOrFunction
from exudyn_models.forces.slip_kinematics import GROUND, Kinds
from exudyn_models.forces.user_functions import force_and_jacobian
from exudyn_models.parts.connector import add_friction_connector, rotor_markers
from exudyn_models.parts.friction_sensors import RingFriction
from exudyn_models.parts.mounts import Side, check_axes, checked_sides, kinds_at, nodes_and_kinds
from exudyn_models.parts.rotational.couplings import RotorCoupling
from exudyn_models.parts.thermal_node import ThermalNode
from exudyn_models.solver.contacts import Contact
from exudyn_models.solver.items import items
from exudyn_models.solver.rows.moment_loads import MomentLoadedStick, SelfEnergisingStick
from exudyn_models.solver.stick.planar_stick import PlanarStick
from exudyn_models.solver.stick.point_sticks import PointSticks
from reference_model.systems import (
    MOST_COUNT,
    FloatArray,
    Place,
    checked_places,
    finite_number,
    finite_numbers,
    positive_number,
    require_whole,
    shown,
)

UNREGULARISED = 1e-200
"""Value of ε in m/s for exact stick, far below any slip of a sliding contact."""


ContactPoints = int | Iterable[Place]
"""Number of points on a circle, or x (m), y (m) and share of the load of each point."""


class AddFriction(Protocol):
    """Function that adds friction between two discs to a model, as ``add_ring_friction`` does."""

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
    load_gain: float | Sequence[float] = 0.0,
    load_part: Any = None,
) -> RingFriction:
    """Add friction between a master disc and a disc to a model; return a handle with the connector and its sensors.

    The module describes contact, bodies, functions and exact stick, ``friction_laws`` the equations. Raises
    ``ValueError`` for an invalid argument or body, or an axis of the contact across a body's.

    Parameters
    ----------
    mbs, master_node, disc_node : MainSystem, then NodeIndex, ObjectIndex or MarkerIndex
        Model, not yet assembled, and its bodies. None as the master is the ground.
    contact_radius, inner_radius, outer_radius : float
        Radius R >= 0 of a circle in m, 0 for a pin; or 0 <= inner < outer, the radii of an annulus in m.
    friction_coefficient : float, table of shape (n, 2) or callable
        μ >= 0; rows of slip speed in m/s, the first 0, and μ, linear between and beyond them; or a function.
    normal_load : float or callable
        Axial force N >= 0 in N, or a function. All ``plates`` >= 1 pairs of faces in series carry it.
    regularisation : float, optional
        ε > 0 in m/s. If None, the contact sticks exactly.
    contact_points : int, sequence of (float, float, float) or None
        n >= 1 points on the circle; or x, y in m and load share of at least two points, without radii.
    static_ratio : float
        Static divided by sliding friction, >= 1; friction falls between ε and 2ε, an effect of first order in ε.
    pressure : {"uniform", "wear"} or callable
        Pressure of an annulus: uniform, ∝ 1/r, or a smooth function >= 0 of r in m, in any unit.
    thermal_node : ThermalNode, optional
        Heat capacity that friction heats. μ may then also be a function of ``temperature``.
    held : int, optional
        Number i + 1 of a point, about which the disc pivots, whose friction is viscous at any slip.
    master_rotation, disc_rotation : array of shape (3, 3), optional
        Axes of the contact as columns in the axes of each body. Default: the axes of the bodies.
    load_gain : float or (float, float)
        g in 1/m of a load N + g·|T|, for rotors that stick exactly; or two, for T > 0 and for T < 0.
    load_part : RingFriction or RotorCoupling, optional
        Part that transmits the moment T. Default: this contact itself, where T is the moment on the disc.

    """
    radii = contact_radius, inner_radius, outer_radius
    geometry = _checked_geometry(*radii, regularisation, contact_points, held, pressure)
    coefficient = _with_temperature(friction_coefficient, thermal_node)
    factors = LoadAndCoefficient(geometry, coefficient, normal_load, static_ratio, plates)
    sides = checked_sides(mbs, master_node, disc_node, rotations=(master_rotation, disc_rotation))
    growth = checked_growth(mbs, load_gain, load_part)
    return _add_friction(mbs, sides, factors, regularisation is None, thermal_node, growth)


def _with_temperature(coefficient: Coefficient, thermal_node: ThermalNode | None) -> Coefficient:
    if thermal_node is None:
        return coefficient
    if not isinstance(thermal_node, ThermalNode):
        raise ValueError(f"thermal_node = {shown(thermal_node)}: it must be a result of add_thermal_node")
    return thermal_node.with_temperature(coefficient)


def checked_growth(mbs: Any, gain: float | Sequence[float], part: Any) -> dict[str, Any]:
    """Return the arguments of a law whose load grows with a moment, or none."""
    gains = finite_numbers("load_gain", gain)
    if gains.shape not in ((), (2,)) or (part is not None and gains.min() < 0.0):
        raise ValueError(f"load_gain = {shown(gain)}: it must be one or two numbers, >= 0 with a load_part")
    growth = dict[str, Any](gains=tuple(np.broadcast_to(gains, 2).tolist()))
    if part is None:
        return growth if gains.any() else {}
    if not isinstance(part, (RingFriction, RotorCoupling)) or part.mbs is not mbs or part.source is None:
        raise ValueError(
            f"load_part = {shown(part)}: it must be a handle of add_ring_friction between rotors on one axis, or of "
            "a coupling, in this model"
        )
    law, present = part.source
    return growth | {"part": law, "present": present}


def law_on_axis(growth: dict[str, Any]) -> type[AxialStick]:
    """Return the law of friction on one axis, whose load may grow with a moment."""
    if "part" in growth:
        return MomentLoadedStick
    return SelfEnergisingStick if growth else AxialStick


def _add_friction(
    mbs: Any,
    sides: tuple[Side, Side],
    factors: LoadAndCoefficient,
    sticks: bool,
    thermal: ThermalNode | None,
    growth: dict[str, Any],
) -> RingFriction:
    if factors.contact_radius > 0.0:  # a pin exerts no moment
        check_axes(mbs, *sides)
    nodes, kinds = nodes_and_kinds(*sides)
    if growth and not (sticks and kinds in ON_ONE_AXIS):
        raise ValueError("load_gain: it needs rotors on one axis, or the ground, and no regularisation")
    reference = np.hstack([mbs.GetNodeParameter(node, "referenceCoordinates") for node in nodes])
    pins = _pins(mbs, sides, kinds, factors) if sticks else []
    contact = (
        _sticking(kinds, reference, factors, pins, growth)
        if sticks
        else _regularised(kinds, reference, factors)
    )
    item = add_friction_connector(mbs, nodes, contact)
    if contact.stick is not None:
        contact.stick.use(_add_locks(mbs, nodes, contact, contact.stick))
    friction = RingFriction(mbs, item, nodes, contact, thermal)
    if thermal is not None:
        thermal.heated_by(friction.power)
    return friction


def _regularised(kinds: Kinds, reference: FloatArray, factors: LoadAndCoefficient) -> Contact:
    force, jacobian = force_and_jacobian(kinds, reference, factors)
    functions = {"force": force, "jacobian": jacobian}
    turns = on_one_axis(kinds, factors) and mean_radius(factors.geometry) > 0.0
    return Contact(kinds, reference, factors, functions, None, turns and not factors.depends_on_motion)


def _pins(mbs: Any, sides: tuple[Side, Side], kinds: Kinds, factors: LoadAndCoefficient) -> list[Kinds]:
    """Return the kinds of pins at the contact's points, if each of them may stick alone, else an empty list."""
    radius, points, _, _, held, table = factors.geometry
    if held != NONE_HELD:
        raise ValueError(
            f"contact_points = {points}: points of which one is held (held = {held + 1}) need a regularisation, "
            "because friction of the held point is viscous; without it every point sticks and slides by itself"
        )
    if points <= CONTINUOUS or radius == 0.0 or kinds in ON_ONE_AXIS:
        return []
    return kinds_at(mbs, *sides, places_in(table))


def _sticking(
    kinds: Kinds,
    reference: FloatArray,
    factors: LoadAndCoefficient,
    pins: Sequence[Kinds],
    growth: dict[str, Any],
) -> Contact:
    ratio, factors = factors.static_ratio, factors.without_peak()
    options: dict[str, Any] = {"reference": reference, "static_ratio": ratio}
    stick: AxialStick
    if pins and kinds not in ON_ONE_AXIS:
        stick = PointSticks.at(pins, kinds, reference, factors, ratio)
    elif kinds in ON_ONE_AXIS:
        weights = np.array([1.0] if kinds[0] == GROUND else [-1.0, 1.0])
        stick = law_on_axis(growth)(kinds, factors, weights=weights, **options, **growth)
    else:
        stick = PlanarStick(kinds, factors, **options)
    return Contact(
        kinds, reference, factors, {"force": stick.force, "jacobian": stick.jacobian}, stick, False
    )


def _add_locks(mbs: Any, nodes: Sequence[Any], contact: Contact, stick: AxialStick) -> tuple[int, ...]:
    parts = [part for part in stick.parts if isinstance(part, PlanarStick)]
    if not parts:
        lock = items.ObjectConnectorCoordinate(
            name=contact.lock_name(0),
            markerNumbers=rotor_markers(mbs, nodes),
            velocityLevel=True,
            activeConnector=False,
        )
        return (int(mbs.AddObject(lock)),)
    if len(nodes) == 1:
        nodes = [mbs.AddNode(items.NodePointGround()), *nodes]
    markers = [mbs.AddMarker(items.MarkerNodeCoordinates(nodeNumber=node)) for node in nodes]
    parts_and_locks = [(part, lock) for part in parts for lock in range(part.lock_count)]
    locks = (
        items.ObjectConnectorCoordinateVector(
            name=contact.lock_name(number),
            markerNumbers=markers,
            velocityLevel=True,
            activeConnector=False,
            **part.lock_options(lock),
        )
        for number, (part, lock) in enumerate(parts_and_locks)
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
) -> Geometry:
    regularisation = UNREGULARISED if regularisation is None else regularisation
    if inner_radius is None and outer_radius is None:
        radius, places, epsilon = checked_contact(regularisation, contact_radius, contact_points)
        points, last = (CONTINUOUS, radius) if places is None else (len(places), table_of(places))
        if not isinstance(pressure, str) or pressure != "uniform":
            raise ValueError(
                f"pressure = {pressure!r}: it needs an annulus, with inner_radius and outer_radius"
            )
    else:
        last, radius = _checked_annulus(inner_radius, outer_radius, contact_radius, contact_points)
        points = density_of(pressure, last, radius)
        epsilon = positive_number("regularisation", regularisation, "m/s")
    if held is not None and points > 0:
        require_whole("held", held, least=1, most=points)
    elif held is not None:
        raise ValueError(f"held = {shown(held)}: it must be None without contact points")
    return radius, points, 1.0, epsilon, NONE_HELD if held is None else int(held) - 1, last


def checked_contact(
    regularisation: float, contact_radius: float | None, contact_points: ContactPoints | None
) -> tuple[float, tuple[Place, ...] | None, float]:
    """Return R, places (None for the whole circle) and ε; raise ``ValueError`` if one is out of range."""
    epsilon = positive_number("regularisation", regularisation, "m/s")
    if isinstance(contact_points, Iterable):
        places = checked_places("contact_points", contact_points)
        if contact_radius is not None:
            raise ValueError(
                f"contact_radius = {contact_radius}: it cannot be combined with a list of points; leave it out"
            )
        return max(math.hypot(x, y) for x, y, _ in places), places, epsilon
    if contact_radius is None:
        raise ValueError(
            "contact_radius = None: pass contact_radius, both radii of an annulus, or a list of points"
        )
    radius = finite_number("contact_radius", contact_radius)
    if radius < 0.0:
        raise ValueError(f"contact_radius = {radius:g} m: it must be >= 0")
    if radius == 0.0 and contact_points is None:
        contact_points = 1
    if contact_points is None:
        return radius, None, epsilon
    number = finite_number("contact_points", contact_points)
    if not (number.is_integer() and 1 <= number <= MOST_COUNT):
        raise ValueError(
            f"contact_points = {contact_points}: it must be a whole number >= 1, a list of (x, y, share), or None "
            "for the continuous ring"
        )
    return radius, ring_places(radius, int(number) if radius > 0.0 else 1), epsilon


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
