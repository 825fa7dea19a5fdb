"""Temperature of a part that friction heats: a heat capacity with a conductance to its surroundings.

C·Ṫ = ΣP − G·(T − T₀), with the powers P of all contacts that heat it. The lost heat is a second coordinate, so
solvers keep the linear invariant C·(T − T_start) + loss = heat to rounding.
"""

import inspect
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property
from itertools import count
from typing import Any

import exudyn as exu

from exudyn_models.forces.laws.functions import checked_not_negative
from exudyn_models.forces.load_and_coefficient import Coefficient
from exudyn_models.solver.items import CURRENT, add_integrals, at_assembly, node_sensor
from reference_model.systems import finite_number, positive_number, require_kind

ARGUMENT = "temperature"

_NUMBERS = count()


@dataclass(frozen=True, eq=False)
class ThermalNode:
    """Handle of a heat capacity added by ``add_thermal_node``, for ``add_ring_friction``.

    ``node`` has two first-order coordinates: T, and the heat in J lost to the surroundings. ``heat_capacity`` C is in
    J/K, ``conductance`` G in W/K, and T₀ of the ``surroundings`` in the unit of the temperature.
    """

    mbs: Any
    node: Any
    heat_capacity: float
    conductance: float
    surroundings: float
    _sources: list[Callable[[Any, float], float]] = field(repr=False)
    _name: str = field(repr=False)

    def temperature(self, mbs: Any) -> float:
        """Return T in the current motion of the assembled model."""
        return float(mbs.systemData.GetODE1Coordinates(CURRENT, False)[self._place])

    def stored_energy(self, mbs: Any) -> float:
        """Return C·(T − T₀) in J, for ``add_energy_balance``."""
        return self.heat_capacity * (self.temperature(mbs) - self.surroundings)

    def power(self, mbs: Any, t: float) -> float:
        """Return the power lost to the surroundings in W, for ``add_energy_balance``."""
        return self.conductance * (self.temperature(mbs) - self.surroundings)

    def add_sensor(self, **options: Any) -> Any:
        """Add a sensor of T and of the heat in J lost to the surroundings; return its ``SensorIndex``.

        ``options`` are options of Exudyn's sensors; by default they store values for ``mbs.GetSensorStoredData``.
        """
        return node_sensor(self.mbs, self.node, exu.OutputVariableType.Coordinates, **options)

    def heated_by(self, power: Callable[[Any, float], float]) -> None:
        """Add a heating power in W, a function of ``mbs`` and the time in s, such as ``RingFriction.power``."""
        self._sources.append(power)

    def with_temperature(self, coefficient: Coefficient) -> Coefficient:
        """Return the ``coefficient``; if it is a function of ``temperature``, this node's temperature is used."""
        if not callable(coefficient):
            return coefficient
        try:
            signature = inspect.signature(coefficient)
        except (TypeError, ValueError):  # reported by a later check of its arguments
            return coefficient
        if ARGUMENT not in signature.parameters:
            return coefficient

        def at_temperature(*values: float, **named: float) -> float:
            return coefficient(*values, **named, temperature=self.temperature(self.mbs))

        rest = [one for name, one in signature.parameters.items() if name != ARGUMENT]
        by_name = [
            one.replace(kind=one.KEYWORD_ONLY) for one in rest if one.kind == one.POSITIONAL_OR_KEYWORD
        ]
        others = [one for one in rest if one.kind != one.POSITIONAL_OR_KEYWORD]
        at_temperature.__signature__ = signature.replace(  # type: ignore[attr-defined]
            parameters=sorted([*by_name, *others], key=lambda one: one.kind)
        )
        return at_temperature

    @cached_property  # deletions may change the node's number, not its name
    def _place(self) -> int:
        return int(self.mbs.systemData.GetNodeLTGODE1(self.mbs.GetNodeNumber(self._name))[0])


def add_thermal_node(
    mbs: Any,
    *,
    heat_capacity: float,
    conductance: float = 0.0,
    surroundings: float = 20.0,
    start: float | None = None,
) -> ThermalNode:
    """Add a temperature to ``mbs`` before assembly; return a handle, the ``thermal_node`` of ``add_ring_friction``.

    ``heat_capacity`` C > 0 is in J/K, ``conductance`` G >= 0 in W/K. ``surroundings`` T₀ and ``start``, by default
    T₀, are both in °C or both in K. Raises ``ValueError`` if a number is out of range.
    """
    require_kind("mbs", mbs, exu.MainSystem)
    capacity = positive_number("heat_capacity", heat_capacity, "J/K")
    loss = checked_not_negative("conductance", conductance, " W/K")
    outside = finite_number("surroundings", surroundings)
    first = outside if start is None else finite_number("start", start)
    sources: list[Callable[[Any, float], float]] = []

    def rates(mbs: Any, t: float, item: int, state: Any) -> list[float]:
        to_outside = loss * (state[0] - outside)
        return [(sum(source(mbs, t) for source in sources) - to_outside) / capacity, to_outside]

    name = f"thermal node {next(_NUMBERS)}"
    node = add_integrals(mbs, rates, [first, 0.0], name)
    thermal = ThermalNode(mbs, node, capacity, loss, outside, sources, name)
    at_assembly(mbs, lambda: thermal.__dict__.pop("_place", None))
    return thermal
