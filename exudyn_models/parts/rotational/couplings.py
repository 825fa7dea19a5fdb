"""Connectors of couplings between rotors on one axis or sliders, and their handle.

A coupling is a massless ``ObjectGenericODE2`` over the nodes of its rotors. Its constraints act on the coordinates of
this object.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import partial
from itertools import accumulate
from typing import Any, Literal, NamedTuple, get_args

import exudyn as exu
import numpy as np

from exudyn_models.forces.axial_pairs import RowLaw
from exudyn_models.parts.connector import add_connector
from exudyn_models.solver.contacts import Coupling, motion_of, register
from exudyn_models.solver.items import CURRENT, IN_MEMORY, items, node_sensor
from exudyn_models.solver.rows.backlash import Backlash
from exudyn_models.solver.rows.laws import MeshLaw
from exudyn_models.solver.starting_rates import add_works
from reference_model.systems import FloatArray, require_choice, require_kind, shown

FREEDOMS = ("1D", "Point2D", "Point", "RigidBody2D", "RigidBodyRotVecLG", "RigidBodyRxyz", "RigidBodyEP")
"""Kinds of nodes, by Exudyn's names. Up to three of their first coordinates can be freedoms."""

Quantity = Literal["moment", "friction", "twist", "relative_spin", "mode", "power", "heat"]


@dataclass(frozen=True, eq=False)
class RotorCoupling:
    """Handle of a coupling; ``item`` is the ``ObjectIndex`` of its connector between ``nodes`` in ``mbs``."""

    mbs: Any
    item: Any
    nodes: tuple[Any, ...]
    _law: RowLaw = field(repr=False)
    _coupling: Coupling = field(repr=False)

    def add_sensor(self, quantity: Quantity, **options: Any) -> Any:
        """Add a sensor to the model, before it is assembled; return its ``SensorIndex``.

        - ``"moment"``: T of a gear or differential, or the moment of others on the second rotor, in N m.
        - ``"friction"``: friction of a mesh on the first rotor in N m, 0 for others.
        - ``"twist"``, ``"relative_spin"``: the angle in rad and the rate in rad/s of the slip: first rotor minus
          carrier, left minus right, driven minus driver, or second minus first rotor of a spring.
        - ``"mode"``: 0 locked, 1 or −1 slipping, or pressed, forward or backward, 2 open.
        - ``"power"``, ``"heat"``: lost power in W, and its integral since the start in J.

        ``options`` are options of Exudyn's sensors. Raises ``ValueError`` for other quantities.
        """
        require_choice("quantity", quantity, get_args(Quantity))
        options = IN_MEMORY | options
        if quantity == "heat":
            node = add_works(self.mbs, {"heat": self.power})
            return node_sensor(self.mbs, node, exu.OutputVariableType.Coordinates, **options)

        def value(mbs: Any, t: float, sensors: Any, factors: Any, configuration: Any) -> list[float]:
            twist, spin = self._motion()
            moment, friction = self._law.moment_and_friction(t, twist, spin)
            return [
                {
                    "moment": moment,
                    "friction": friction,
                    "twist": twist,
                    "relative_spin": spin,
                    "mode": float(self._law.mode_at(twist, spin)),
                    "power": self._law.lost_power(t, twist, spin),
                }[quantity]
            ]

        return self.mbs.AddSensor(items.SensorUserFunction(sensorUserFunction=value, **options))

    @property
    def source(self) -> tuple[RowLaw | None, Callable[[], float]]:
        """Law and present moment in N m for a contact that this part loads."""
        law = None if isinstance(self._law, Backlash) else self._law
        now = partial(self.mbs.systemData.GetTime, CURRENT)
        return law, lambda: self._law.moment_and_friction(now(), *self._motion())[0]

    def power(self, mbs: Any, t: float) -> float:
        """Return the lost power in W, in the form that ``add_energy_balance`` expects."""
        return self._law.lost_power(t, *self._motion())

    def stored_energy(self, mbs: Any) -> float:
        """Return the energy of a spring in J, in the form that ``add_energy_balance`` expects."""
        return self._law.energy(self._motion()[0])

    def _motion(self) -> tuple[float, float]:
        q, q_t = motion_of(self.mbs, self._coupling, self.item, CURRENT)
        return self._law.twist(q), self._law.slip(q, q_t)


class Freedom(NamedTuple):
    """Coordinate of a node with ``size`` coordinates, and its reference: an angle or a position."""

    node: Any
    coordinate: int
    size: int
    reference: float


def freedoms_of(mbs: Any, **rotors: Any) -> list[Freedom | None]:
    """Return the freedoms of rotors and sliders, by the names of arguments; None is the ground.

    Each is a node or object with one coordinate, or a marker of a coordinate of any node except the rotation of a
    body in space. Raises ``ValueError`` for others, and if two are equal.
    """
    require_kind("mbs", mbs, exu.MainSystem)
    found: list[Freedom | None] = []
    for name, rotor in rotors.items():
        try:
            freedom = _freedom_of(mbs, rotor)
        except (exu.ExudynError, IndexError, KeyError, TypeError, ValueError):
            raise ValueError(
                f"{name} = {shown(rotor)}: it must be a Node1D or its object of this model, a MarkerNodeCoordinate "
                "of an angle about a fixed axis or of a position, or None for the ground"
            ) from None
        if freedom is not None and freedom in found:
            raise ValueError(f"{name} = {shown(rotor)}: a coupling is between different rotors")
        found.append(freedom)
    if len(found) > 1 and not any(found):
        raise ValueError(f"{' = '.join(rotors)} = None: at least one must be a rotor, not the ground")
    return found


def _freedom_of(mbs: Any, given: Any) -> Freedom | None:
    if given is None:
        return None
    node, coordinate = given, 0
    if type(given).__name__ == "MarkerIndex":
        marker = mbs.GetMarker(given)
        node, coordinate = marker["nodeNumber"], marker["coordinate"]
    elif type(given).__name__ == "ObjectIndex":
        if mbs.GetObject(given)["objectType"] == "Ground":
            return None
        node = mbs.GetObjectParameter(given, "nodeNumber")
    kind, reference = mbs.GetNode(node)["nodeType"], mbs.GetNodeParameter(node, "referenceCoordinates")
    allowed = 1 if given is node else min(len(reference), 3)
    if kind not in FREEDOMS or (len(reference) > allowed and given is node):
        raise ValueError
    return Freedom(int(node), range(allowed)[coordinate], len(reference), float(reference[coordinate]))


def nodes_of(freedoms: Sequence[Freedom | None]) -> tuple[Any, ...]:
    """Return the nodes of some freedoms."""
    nodes = dict.fromkeys(freedom.node for freedom in freedoms if freedom is not None)
    return tuple(exu.NodeIndex(node) for node in nodes)  # type: ignore[attr-defined]


def places_of(freedoms: Sequence[Freedom]) -> list[int]:
    """Return the places of some freedoms among all coordinates of their nodes."""
    sizes = {freedom.node: freedom.size for freedom in freedoms}
    starts = dict(zip(sizes, accumulate(sizes.values(), initial=0), strict=False))
    return [starts[freedom.node] + freedom.coordinate for freedom in freedoms]


def weights_of(freedoms: Sequence[Freedom | None], weights: Sequence[float]) -> FloatArray:
    """Return the weights of all coordinates of the nodes of some freedoms."""
    own = [one for one in freedoms if one is not None]
    found = np.zeros(sum({freedom.node: freedom.size for freedom in own}.values()))
    found[places_of(own)] = [weight for one, weight in zip(freedoms, weights, strict=True) if one is not None]
    return found


def add_coupling(mbs: Any, freedoms: Sequence[Freedom | None], law: RowLaw) -> RotorCoupling:
    """Add a coupling with a law to a model; return its handle."""
    coupling = Coupling(stick=law)
    register(mbs, coupling)
    nodes = nodes_of(freedoms)
    item = add_connector(mbs, nodes, law.force, law.jacobian, coupling.name)
    gradients = [] if isinstance(law, Backlash) else [law.weights]
    if isinstance(law, MeshLaw):
        gradients = [law.constraint] if law.lossless else [law.weights, law.constraint]
    numbers = [
        add_constraint(mbs, item, gradient, name=coupling.lock_name(i))
        for i, gradient in enumerate(gradients)
    ]
    law.use(numbers)
    for lock in law.locks:
        mbs.SetObjectParameter(lock, "activeConnector", False)
    return RotorCoupling(mbs, item, nodes, law, coupling)


def add_constraint(mbs: Any, item: Any, gradient: FloatArray, name: str) -> int:
    """Add the constraint gradient·ω = 0 of the coordinates of an object; return its number."""
    ground = mbs.AddNode(items.NodePointGround())
    markers = [
        mbs.AddMarker(items.MarkerNodeCoordinates(nodeNumber=ground)),
        mbs.AddMarker(items.MarkerObjectODE2Coordinates(objectNumber=item)),
    ]
    constraint = items.ObjectConnectorCoordinateVector(
        markerNumbers=markers,
        scalingMarker0=np.zeros((1, 0)),
        scalingMarker1=np.array([gradient]),
        velocityLevel=True,
        name=name,
    )
    return int(mbs.AddObject(constraint))
