"""The elastic support of a disc, on the ground or on a body: a spring that may harden, a stop and a damper.

At the deflection w, d = |w|, it pulls the disc back with C·d + C₃·d³ + C_s·max(0, d − gap), and damps with β·ẇ. On a
body, w and ẇ are relative to the turning body, so a rigid motion of both causes no force. The full reaction acts on
the body, including the moment −d×F.

A linear support on the ground is Exudyn's ``CartesianSpringDamper``, which takes a tenth of the time of a Python
function. Any other support is a massless ``ObjectGenericODE2``.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any, Literal, cast, get_args

import exudyn as exu
import numpy as np

from exudyn_models.forces.laws.functions import checked_not_negative
from exudyn_models.forces.radial_springs import (
    ON_GROUND,
    ON_ROTOR,
    Law,
    Offset,
    elastic_energy,
    secant_stiffness,
    support_functions,
)
from exudyn_models.forces.slip_kinematics import (
    GROUND,
    NO_MOUNTS,
    PLANAR,
    ROTOR,
    SPATIAL,
    Kinds,
    slip_and_place_of_nodes,
)
from exudyn_models.parts.connector import add_connector
from exudyn_models.parts.mounts import checked_sides, nodes_and_kinds
from exudyn_models.solver.contacts import Connector, motion_of, places_of, register_support
from exudyn_models.solver.items import CURRENT, IN_MEMORY, items
from reference_model.systems import FloatArray, finite_numbers, require_choice, shown

Quantity = Literal["deflection", "force", "stored_energy", "power"]


@dataclass(frozen=True, eq=False)
class RadialSupport:
    """Handle of a support added by ``add_radial_support``.

    ``item`` is the ``ObjectIndex`` of its connector in ``mbs``. ``nodes`` are the nodes of the base, unless it is the
    ground, and of the disc.
    """

    mbs: Any
    item: Any
    nodes: tuple[Any, ...]
    _kinds: Kinds = field(repr=False)
    _reference: FloatArray = field(repr=False)
    _offset: Offset = field(repr=False)
    _law: Law = field(repr=False)
    _connector: Connector = field(repr=False)

    def power(self, mbs: Any, t: float) -> float:
        """Return the heating power of the damper in W, for ``add_energy_balance``."""
        # On the ground with the global axes, ẇ is the node's velocity, which costs less.
        if len(self.nodes) == 1 and self._kinds[2] == NO_MOUNTS:
            (place,) = places_of(mbs, self._connector, self.item)
            vx, vy, *_ = mbs.systemData.GetODE2Coordinates_t(CURRENT, False)[place].tolist()
            return float(self._law[4] * (vx * vx + vy * vy))
        return self._state(mbs)[3]

    def stored_energy(self, mbs: Any) -> float:
        """Return the energy of springs and stop in J, for ``add_energy_balance``."""
        return self._state(mbs)[2]

    def add_sensor(self, quantity: Quantity, **options: Any) -> Any:
        """Add a sensor to the model, before it is assembled; return its ``SensorIndex``.

        - ``"deflection"``: w in m, two components in the axes of the base.
        - ``"force"``: force on the disc in N, three components in global axes.
        - ``"stored_energy"``: energy of springs and stop, in J.
        - ``"power"``: heating power of the damper, in W.

        ``options`` are options of Exudyn's sensors; by default they store values for ``mbs.GetSensorStoredData``.
        Raises ``ValueError`` for other quantities.
        """
        quantities = get_args(Quantity)
        require_choice("quantity", quantity, quantities)
        place = quantities.index(quantity)

        def values(mbs: Any, t: float, sensors: Any, factors: Any, configuration: Any) -> list[float]:
            return cast(list[float], np.atleast_1d(self._state(mbs, configuration)[place]).tolist())

        options = IN_MEMORY | options
        return self.mbs.AddSensor(items.SensorUserFunction(sensorUserFunction=values, **options))

    def _state(
        self, mbs: Any, configuration: Any = exu.ConfigurationType.Current
    ) -> tuple[FloatArray, FloatArray, float, float]:
        q, q_t = motion_of(mbs, self._connector, self.item, configuration)
        hidden = np.zeros(len(self._reference) - len(q))
        coordinates, velocities = self._reference + np.hstack((hidden, q)), np.hstack((hidden, q_t))
        to_slip, axes, _, place = slip_and_place_of_nodes(self._kinds, coordinates)
        w = np.array(place) - self._offset
        square, rate, damping = float(w @ w), to_slip[:2] @ velocities, self._law[4]
        force = np.array(axes[:2]).T @ (-secant_stiffness(square, self._law) * w - damping * rate)
        return w, force, elastic_energy(square, self._law), damping * float(rate @ rate)


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

    They act across the z-axis of the base and turn with it, like an elastic shaft, equally in all radial directions.
    They neither hold the disc along the axis nor resist tilting. ``computeMassMatrixInversePerBody`` must stay False,
    because nodes are shared with their bodies, unless the support is linear and on the ground with global axes.

    Parameters
    ----------
    mbs : exudyn MainSystem
        The model, not yet assembled, with the nodes.
    base_node : NodeIndex or ObjectIndex or MarkerIndex or None
        Body as in ``add_ring_friction``, or None or an ``ObjectGround`` for the ground.
    disc_node : NodeIndex or ObjectIndex or MarkerIndex
        Body with any of these nodes, except a ``Node1D``.
    stiffness, damping, hardening : float
        C in N/m, β in N s/m and C₃ in N/m³, >= 0.
    stop_gap, stop_stiffness : float
        Clearance of the stop in m and C_s in N/m, >= 0; C_s = 0 for no stop.
    offset : two floats
        Relaxed position in m, in the axes of the base and from its node or marker. For a ``Node1D`` and the ground,
        from the reference position of the body, or else from the global origin.

    Raises
    ------
    ValueError
        If a number is out of range or a node is of an unsupported kind.

    """
    law = _checked_law(stiffness, hardening, stop_gap, stop_stiffness, damping)
    place = _checked_offset(offset)
    sides = checked_sides(mbs, base_node, disc_node, discs=(PLANAR, *SPATIAL), master="base")
    nodes, pair = nodes_and_kinds(*sides)
    kinds, hidden = _kinds_and_hidden(pair)
    own = [mbs.GetNodeParameter(node, "referenceCoordinates") for node in nodes]
    reference = np.hstack([np.zeros(hidden), *own])
    connector = register_support(mbs)
    if hidden == ON_GROUND and hardening == 0.0 and stop_stiffness == 0.0:
        item = _add_springs(mbs, nodes[0], place, law, connector.name)
    else:
        functions = support_functions(hidden, kinds, reference, place, law)
        item = add_connector(mbs, nodes, *functions, connector.name)
    return RadialSupport(mbs, item, nodes, kinds, reference, place, law, connector)


def _checked_law(
    stiffness: float, hardening: float, stop_gap: float, stop_stiffness: float, damping: float
) -> Law:
    return (
        checked_not_negative("stiffness", stiffness, " N/m"),
        checked_not_negative("hardening", hardening, " N/m³"),
        checked_not_negative("stop_gap", stop_gap, " m"),
        checked_not_negative("stop_stiffness", stop_stiffness, " N/m"),
        checked_not_negative("damping", damping, " N s/m"),
    )


def _kinds_and_hidden(kinds: Kinds) -> tuple[Kinds, int]:
    """Return the kinds for compiled code, and how many first coordinates of the base the model omits.

    If there are no mounts, the ground and a rotor count as planar bodies with fixed coordinates.
    """
    base, disc, mounts = kinds
    if mounts != NO_MOUNTS or base not in (GROUND, ROTOR):
        return kinds, 0
    return (PLANAR, disc, NO_MOUNTS), ON_GROUND if base == GROUND else ON_ROTOR


def _checked_offset(offset: Sequence[float]) -> Offset:
    place = finite_numbers("offset", offset)
    if place.shape != (2,):
        raise ValueError(f"offset = {shown(offset)}: it must be two numbers, x and y in m")
    return float(place[0]), float(place[1])


def _add_springs(mbs: Any, node: Any, offset: Offset, law: Law, name: str) -> Any:
    stiffness, *_, damping = law
    ground = mbs.AddObject(items.ObjectGround(referencePosition=[*offset, 0.0]))
    return mbs.AddObject(
        items.CartesianSpringDamper(
            name=name,
            markerNumbers=[
                mbs.AddMarker(items.MarkerBodyPosition(bodyNumber=ground)),
                mbs.AddMarker(items.MarkerNodePosition(nodeNumber=node)),
            ],
            stiffness=[stiffness, stiffness, 0.0],
            damping=[damping, damping, 0.0],
        )
    )
