"""Torsional springs with backlash."""

from dataclasses import dataclass, field
from typing import Any, Literal, get_args

from exudyn_models.parts.connector import add_connector
from exudyn_models.parts.rotational.couplings import rotors_of, weights_of
from exudyn_models.solver.contacts import Coupling, motion_of, register
from exudyn_models.solver.items import CURRENT, IN_MEMORY, items
from exudyn_models.solver.rows.backlash import Backlash
from reference_model.systems import finite_number, positive_number, require_choice

Quantity = Literal["moment", "twist", "mode", "power"]


@dataclass(frozen=True, eq=False)
class TorsionalSpring:
    """Handle of a torsional spring; ``item`` is the ``ObjectIndex`` of its connector in ``mbs``."""

    mbs: Any
    item: Any
    _law: Backlash = field(repr=False)
    _coupling: Coupling = field(repr=False)

    def add_sensor(self, quantity: Quantity, **options: Any) -> Any:
        """Add a sensor to the model, before it is assembled; return its ``SensorIndex``.

        - ``"moment"``: moment on the second rotor in N m.
        - ``"twist"``: φ₂ − φ₁ in rad.
        - ``"mode"``: 1 or −1 if a flank is pressed forward or backward, 2 within the clearance.
        - ``"power"``: lost power in W.

        ``options`` are those of Exudyn's sensors. Raises ``ValueError`` for other quantities.
        """
        require_choice("quantity", quantity, get_args(Quantity))

        def value(mbs: Any, t: float, sensors: Any, factors: Any, configuration: Any) -> list[float]:
            twist, rate = self._state()
            law = self._law
            return [
                {
                    "moment": law.moment_at(twist, rate),
                    "twist": twist + law.middle,
                    "mode": float(law.pressed(twist, rate)),
                    "power": law.lost_power(twist, rate),
                }[quantity]
            ]

        return self.mbs.AddSensor(items.SensorUserFunction(sensorUserFunction=value, **IN_MEMORY | options))

    def power(self, mbs: Any, t: float) -> float:
        """Return the lost power in W, in the form that ``add_energy_balance`` expects."""
        return self._law.lost_power(*self._state())

    def stored_energy(self, mbs: Any) -> float:
        """Return the stored energy in J, in the form that ``add_energy_balance`` expects."""
        return self._law.energy(self._state()[0])

    def _state(self) -> tuple[float, float]:
        q, q_t = motion_of(self.mbs, self._coupling, self.item, CURRENT)
        return float(self._law.weights @ q), float(self._law.weights @ q_t)


def add_torsional_spring(
    mbs: Any, first: Any, second: Any, *, stiffness: float, damping: float = 0.0, backlash: float
) -> TorsionalSpring:
    """Add a torsional spring with backlash to a model; return its handle.

    Within the ``backlash``, a total clearance in rad > 0, it transmits nothing. Beyond it, spring (``stiffness`` > 0
    in N m/rad) and damper (``damping`` >= 0 in N m s/rad) push together, but never pull. ``solve_dynamic`` locates
    each contact and separation with implicit solvers. Rotors are those of ``add_gear``.

    Several of them side by side are a clutch damper of several stages, and ``add_ring_friction`` beside them its
    hysteresis.
    """
    nodes = [node for node in rotors_of(mbs, first=first, second=second).values() if node is not None]
    weights = weights_of([first, second], (-1.0, 1.0))
    stiffness, backlash = (
        positive_number("stiffness", stiffness, "N m/rad"),
        positive_number("backlash", backlash, "rad"),
    )
    if (damping := finite_number("damping", damping)) < 0.0:
        raise ValueError(f"damping = {damping:g} N m s/rad: it must be >= 0")
    middle = sum(
        weight * mbs.GetNodeParameter(node, "referenceCoordinates")[0]
        for node, weight in zip(nodes, weights.tolist(), strict=True)
    )
    law = Backlash(weights, stiffness=stiffness, damping=damping, clearance=backlash, middle=middle)
    coupling = Coupling(stick=law)
    register(mbs, coupling)
    item = add_connector(mbs, nodes, law.force, law.jacobian, coupling.name)
    return TorsionalSpring(mbs, item, law, coupling)
