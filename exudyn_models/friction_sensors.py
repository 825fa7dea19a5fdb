"""What is to be known of a friction contact in a model: its sensors, and the handle that adds them."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any, Literal, cast, get_args

import exudyn as exu
import exudyn.itemInterface
import numpy as np

from exudyn_models.friction_laws import friction_of_slip, mean_slip_speed
from exudyn_models.slip_map import Kinds, slip_map
from exudyn_models.strength import NumberOrFunction, Strength
from reference_model.systems import FloatArray

items: Any = exudyn.itemInterface  # its type hints do not fit its own calls

Quantity = Literal["transmitted_moment", "radial_force", "centre_slip", "rim_slip", "power", "heat"]


@dataclass(frozen=True, eq=False)
class RingFriction:
    """Friction that ``add_ring_friction`` has added to a model.

    Parameters
    ----------
    mbs : exudyn MainSystem
        The model.
    item : ObjectIndex
        Of the connector.
    nodes : tuple of NodeIndex
        Of master and disc.

    """

    mbs: Any
    item: Any
    nodes: tuple[Any, Any]
    _kinds: Kinds = field(repr=False)
    _reference: FloatArray = field(repr=False)
    _strength: Strength = field(repr=False)

    def change(
        self,
        *,
        friction_coefficient: NumberOrFunction | None = None,
        normal_load: NumberOrFunction | None = None,
    ) -> None:
        """Replace coefficient or load from now on, as ``add_ring_friction`` takes them; None keeps what there is.

        Raises
        ------
        ValueError
            If a number is out of its range; both then stay as they were.

        """
        strength = self._strength
        strength.change(
            strength.friction_coefficient if friction_coefficient is None else friction_coefficient,
            strength.normal_load if normal_load is None else normal_load,
        )

    def add_sensor(self, quantity: Quantity, **options: Any) -> Any:
        """Add a sensor to the model, before it is assembled; return its ``SensorIndex``.

        - ``"transmitted_moment"``: M on the disc about the master's axis, in N m.
        - ``"radial_force"``: F on the disc in N, three components in global axes.
        - ``"centre_slip"``: |u| of the disc's centre over the master, in m/s.
        - ``"rim_slip"``: R·(φ̇ − ω) of the rim, in m/s, of either sign.
        - ``"power"``: what friction turns into heat, in W.
        - ``"heat"``: its integral since the start, in J, a coordinate that the solver integrates with all others.

        ``options`` are those of Exudyn's sensors. Without any the sensor stores its values for
        ``mbs.GetSensorStoredData`` and writes no file.

        Raises
        ------
        ValueError
            If there is no such quantity.

        """
        if quantity not in get_args(Quantity):
            raise ValueError(f"quantity = {quantity!r}: it must be one of {', '.join(get_args(Quantity))}")
        options = {"storeInternal": True, "writeToFile": False} | options
        if quantity == "heat":
            return self._add_heat(options)
        return self.mbs.AddSensor(
            items.SensorUserFunction(sensorUserFunction=self._sensor_function(quantity), **options)
        )

    def _sensor_function(self, quantity: Quantity) -> Callable[..., list[float]]:
        # Slip is found without the load, so that a load may depend on a sensor of it.
        def values(mbs: Any, t: float, sensors: Any, factors: Any, configuration: Any) -> list[float]:
            slip, angle, axes = self._slip(mbs, configuration)
            if quantity == "centre_slip":
                return [math.hypot(slip[0], slip[1])]
            if quantity == "rim_slip":
                return [self._strength.contact_radius * slip[2]]
            friction = self._friction(t, slip, angle)
            if quantity == "transmitted_moment":
                return [float(friction[2])]
            if quantity == "power":
                return [-float(friction @ slip)]
            return cast(list[float], (axes[:, :2] @ friction[:2]).tolist())

        return values

    def _add_heat(self, options: dict[str, Any]) -> Any:
        def rate(mbs: Any, t: float, item: int, heat: Any) -> list[float]:
            slip, angle, _ = self._slip(mbs, exu.ConfigurationType.Current)
            return [-float(self._friction(t, slip, angle) @ slip)]

        node = self.mbs.AddNode(
            items.NodeGenericODE1(
                referenceCoordinates=[0.0], initialCoordinates=[0.0], numberOfODE1Coordinates=1
            )
        )
        self.mbs.AddObject(items.ObjectGenericODE1(nodeNumbers=[node], rhsUserFunction=rate))
        variable = exu.OutputVariableType.Coordinates
        return self.mbs.AddSensor(items.SensorNode(nodeNumber=node, outputVariableType=variable, **options))

    def _slip(self, mbs: Any, configuration: Any) -> tuple[FloatArray, float, FloatArray]:
        """Return u_x, u_y (m/s) and S (rad/s), the disc's angle, both in the master's axes, and these axes."""
        q, q_t = (
            np.hstack([mbs.GetNodeOutput(node, variable, configuration) for node in self.nodes])
            for variable in (exu.OutputVariableType.Coordinates, exu.OutputVariableType.Coordinates_t)
        )
        to_slip, axes, (cosine, sine) = slip_map(self._kinds, self._reference + q)
        return to_slip @ q_t, math.atan2(sine, cosine), axes

    def _friction(self, t: float, slip: FloatArray, angle: float) -> FloatArray:
        """Return F_x, F_y (N) in the master's axes and M (N m)."""
        arguments = (*slip.tolist(), angle, self._strength.contact_at(t))
        friction = np.array(friction_of_slip(*arguments))
        if self._strength.depends_on_motion:
            friction *= self._strength.coefficient(mean_slip_speed(*arguments))
        return friction
