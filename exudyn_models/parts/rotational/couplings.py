"""Connectors of couplings between rotors on one axis, and their handle.

A coupling is a massless ``ObjectGenericODE2`` over the nodes of its rotors. Its constraints act on the coordinates of
this object.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any, Literal, get_args

import exudyn as exu
import numpy as np

from exudyn_models.forces.axial_pairs import RowLaw
from exudyn_models.parts.connector import add_connector
from exudyn_models.solver.contacts import Coupling, motion_of, register
from exudyn_models.solver.items import CURRENT, IN_MEMORY, add_integrals, items, node_sensor
from exudyn_models.solver.jumps import watch_powers
from exudyn_models.solver.rows.backlash import Backlash
from exudyn_models.solver.rows.laws import MeshLaw, RotaryLaw
from reference_model.systems import FloatArray, require_choice, shown

Quantity = Literal["moment", "friction", "twist", "relative_spin", "mode", "power", "heat"]


@dataclass(frozen=True, eq=False)
class RotorCoupling:
    """Handle of a coupling; ``item`` is the ``ObjectIndex`` of its connector in ``mbs``, ``nodes`` are its rotors."""

    mbs: Any
    item: Any
    nodes: tuple[Any, ...]
    _law: RotaryLaw = field(repr=False)
    _coupling: Coupling = field(repr=False)

    def add_sensor(self, quantity: Quantity, **options: Any) -> Any:
        """Add a sensor to the model, before it is assembled; return its ``SensorIndex``.

        - ``"moment"``: T of a gear or differential, or the moment of others on the second rotor, in N m.
        - ``"friction"``: friction of a mesh on the first rotor in N m, 0 for others.
        - ``"twist"``, ``"relative_spin"``: the angle in rad and the rate in rad/s of the slip: first rotor minus
          carrier, left minus right, driven minus driver, or second minus first rotor of a spring.
        - ``"mode"``: 0 locked, 1 or −1 slipping, or pressed, forward or backward, 2 open.
        - ``"power"``, ``"heat"``: lost power in W, and its integral since the start in J.

        ``options`` are those of Exudyn's sensors. Raises ``ValueError`` for other quantities.
        """
        require_choice("quantity", quantity, get_args(Quantity))
        options = IN_MEMORY | options
        if quantity == "heat":

            def rate(mbs: Any, t: float, item: int, heat: Any) -> list[float]:
                return [self.power(mbs, t)]

            watch_powers(rate, ["heat"])
            node = add_integrals(self.mbs, rate, [0.0])
            return node_sensor(self.mbs, node, exu.OutputVariableType.Coordinates, **options)

        def value(mbs: Any, t: float, sensors: Any, factors: Any, configuration: Any) -> list[float]:
            twist, spin = self._motion()
            moment, friction = self._law.moment_and_friction(twist, spin)
            return [
                {
                    "moment": moment,
                    "friction": friction,
                    "twist": twist,
                    "relative_spin": spin,
                    "mode": float(self._law.mode_at(twist, spin)),
                    "power": self._law.lost_power(twist, spin),
                }[quantity]
            ]

        return self.mbs.AddSensor(items.SensorUserFunction(sensorUserFunction=value, **options))

    @property
    def source(self) -> tuple[RowLaw | None, Callable[[], float]]:
        """Law and present moment in N m for a contact that this part loads."""
        law = None if isinstance(self._law, Backlash) else self._law
        return law, lambda: self._law.moment_and_friction(*self._motion())[0]

    def power(self, mbs: Any, t: float) -> float:
        """Return the lost power in W, in the form that ``add_energy_balance`` expects."""
        return self._law.lost_power(*self._motion())

    def stored_energy(self, mbs: Any) -> float:
        """Return the energy of a spring in J, in the form that ``add_energy_balance`` expects."""
        return self._law.energy(self._motion()[0])

    def _motion(self) -> tuple[float, float]:
        q, q_t = motion_of(self.mbs, self._coupling, self.item, CURRENT)
        return self._law.twist(q), self._law.slip(q, q_t)


def rotors_of(mbs: Any, **rotors: Any) -> dict[str, Any]:
    """Return the nodes of rotors, by the names of arguments: nodes or objects on one axis; None is the ground.

    Raises ``ValueError`` if one is not a rotor, or two are equal.
    """
    nodes: dict[str, Any] = {}
    for name, rotor in rotors.items():
        node = rotor
        try:
            if isinstance(rotor, exu.ObjectIndex):  # type: ignore[attr-defined]
                node = mbs.GetObjectParameter(rotor, "nodeNumber")
            is_rotor = node is None or mbs.GetNode(node)["nodeType"] == "1D"
        except (exu.ExudynError, TypeError, ValueError):
            is_rotor = False
        if not is_rotor:
            raise ValueError(
                f"{name} = {shown(rotor)}: it must be a Node1D or an ObjectRotationalMass1D of this model, or None "
                "for the ground"
            )
        if node is not None and int(node) in {int(other) for other in nodes.values() if other is not None}:
            raise ValueError(f"{name} = {shown(rotor)}: a coupling is between different rotors")
        nodes[name] = node
    return nodes


def weights_of(nodes: Sequence[Any], weights: Sequence[float]) -> FloatArray:
    """Return the weights of the nodes that are not the ground."""
    return np.array([weight for node, weight in zip(nodes, weights, strict=True) if node is not None], float)


def add_coupling(mbs: Any, nodes: Sequence[Any], law: RotaryLaw) -> RotorCoupling:
    """Add a coupling with a law to a model; return its handle. ``nodes`` may contain None for the ground."""
    coupling = Coupling(stick=law)
    register(mbs, coupling)
    turning = tuple(node for node in nodes if node is not None)
    item = add_connector(mbs, turning, law.force, law.jacobian, coupling.name)
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
    return RotorCoupling(mbs, item, turning, law, coupling)


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
