"""The handle of a friction contact in a model, and its sensors."""

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from operator import mul
from typing import Any, Literal, cast, get_args

import exudyn as exu
import numpy as np

from exudyn_models.forces.axial_pairs import ON_ONE_AXIS, SLIDING, RowLaw, constant_law, on_one_axis
from exudyn_models.forces.friction_laws import friction_of, mean_radius, potential_of
from exudyn_models.forces.load_and_coefficient import Coefficient, NumberOrFunction
from exudyn_models.forces.slip_kinematics import Axes, slip_and_place_of_nodes
from exudyn_models.forces.user_functions import force_and_jacobian
from exudyn_models.parts.connector import renew_friction
from exudyn_models.parts.thermal_node import ThermalNode
from exudyn_models.solver.contacts import Contact, coordinates_of, motion_of, places_of, present_item
from exudyn_models.solver.items import CURRENT, IN_MEMORY, items, node_sensor
from exudyn_models.solver.stick.point_sticks import PointSticks
from exudyn_models.solver.works import add_works
from reference_model.systems import FloatArray, require_choice

Quantity = Literal[
    "transmitted_moment",
    "radial_force",
    "centre_slip",
    "rim_slip",
    "relative_spin",
    "capacity_share",
    "mode",
    "power",
    "heat",
]

BACKWARD, LOCKED, FORWARD, OPEN = -1.0, 0.0, 1.0, 2.0
"""Values of the sensor ``"mode"``, as in Modelica's clutches."""

BAND = 0.01
"""Relative half-width of the band around the capacity where the sensor ``"mode"`` keeps its value."""


@dataclass(frozen=True, eq=False)
class RingFriction:
    """Handle of a friction contact added by ``add_ring_friction``.

    ``item`` is the ``ObjectIndex`` of its connector in ``mbs``. ``nodes`` are the nodes of the master, unless it is
    the ground, and of the disc.
    """

    mbs: Any
    item: Any
    nodes: tuple[Any, ...]
    _contact: Contact = field(repr=False)
    _thermal: ThermalNode | None = field(default=None, repr=False)

    @property
    def effective_radius(self) -> float:
        """Ratio of moment to friction force in m of a disc that only turns: M = μN·r, of all plates."""
        return mean_radius(self._contact.factors.geometry)

    @property
    def source(self) -> tuple[RowLaw | None, Callable[[], float]] | None:
        """Law and present moment in N m for a contact that this one loads; None unless both turn on one axis."""
        contact, stick, data = self._contact, self._contact.stick, self.mbs.systemData
        if contact.kinds not in ON_ONE_AXIS:
            return None

        def present() -> float:
            t = data.GetTime(CURRENT)
            q, q_t = (values.tolist() for values in motion_of(self.mbs, contact, self.item, CURRENT))
            if stick is not None:
                return stick.moment(t, stick.slip(q, q_t))
            return float(contact.functions["force"](self.mbs, t, 0, q, q_t)[-1])

        return stick, present

    def change(
        self,
        *,
        friction_coefficient: Coefficient | None = None,
        normal_load: NumberOrFunction | None = None,
    ) -> None:
        """Replace coefficient or load from now on, as in ``add_ring_friction``; None keeps the present value.

        Raises ``ValueError`` if a number is out of range; both then stay unchanged.
        """
        contact, factors, stick = self._contact, self._contact.factors, self._contact.stick
        if friction_coefficient is None:
            friction_coefficient = factors.friction_coefficient
        elif self._thermal is not None:
            friction_coefficient = self._thermal.with_temperature(friction_coefficient)
        normal_load = factors.normal_load if normal_load is None else normal_load
        if isinstance(stick, PointSticks):
            stick.check(friction_coefficient, normal_load)
        factors.change(friction_coefficient, normal_load)
        contact.power = None
        if stick is not None:
            stick.renew()
            return
        force, jacobian = force_and_jacobian(contact.kinds, contact.reference, factors)
        contact.functions.update(force=force, jacobian=jacobian)
        renew_friction(self.mbs, present_item(self.mbs, contact, self.item), contact)

    @property
    def dissipation(self) -> tuple[RowLaw | Contact, list[int]] | None:
        """Law or contact that determines ``power`` for ``Works``, and the places of its coordinates."""
        contact, stick = self._contact, self._contact.stick
        if stick is None and not on_one_axis(contact.kinds, contact.factors):
            return contact, coordinates_of(self.mbs, contact, self.item)
        return (stick, coordinates_of(self.mbs, contact, self.item)) if stick and len(stick.weights) else None

    def add_sensor(self, quantity: Quantity, **options: Any) -> Any:
        """Add a sensor to the model, before it is assembled; return its ``SensorIndex``.

        - ``"transmitted_moment"``: M on the disc about the contact's centre, along the master's axis, in N m.
        - ``"radial_force"``: F on the disc in N, three components in global axes.
        - ``"centre_slip"``: |u| of the disc's centre on the master, in m/s.
        - ``"rim_slip"``: R·(φ̇ − ω) of the rim, in m/s, of either sign.
        - ``"relative_spin"``: S = φ̇ − ω in rad/s.
        - ``"capacity_share"``: share of the friction capacity in use: 1 in slip, P/ε in creep, and 0 without
          friction.
        - ``"mode"``: 0 locked, also in creep below capacity; 1 slipping with the disc faster than the master, or
          sideways; −1 slipping with the disc slower; 2 open, without load. Within ``BAND`` of full capacity the mode
          stays as it was, so it does not flicker.
        - ``"power"``: heating power of friction, in W.
        - ``"heat"``: its integral since the start, in J; the solver integrates it with all coordinates.

        ``options`` are options of Exudyn's sensors; by default they store values for ``mbs.GetSensorStoredData``.
        Raises ``ValueError`` for other quantities.
        """
        require_choice("quantity", quantity, get_args(Quantity))
        options = IN_MEMORY | options
        if quantity == "heat":
            node = add_works(self.mbs, {"heat": self.power})
            return node_sensor(self.mbs, node, exu.OutputVariableType.Coordinates, **options)
        return self.mbs.AddSensor(
            items.SensorUserFunction(sensorUserFunction=self._sensor_function(quantity), **options)
        )

    def _sensor_function(self, quantity: Quantity) -> Callable[..., list[float]]:
        asked, mode = False, _Mode()

        # Slip needs no load, so a load may depend on a sensor of slip.
        def values(mbs: Any, t: float, sensors: Any, factors: Any, configuration: Any) -> list[float]:
            nonlocal asked
            slip, angle, radius, axes = self._slip(mbs, configuration)
            if quantity == "centre_slip":
                return [math.hypot(slip[0], slip[1])]
            if quantity == "rim_slip":
                return [self._contact.factors.contact_radius * slip[2]]
            if quantity == "relative_spin":
                return [float(slip[2])]
            if asked:
                raise ValueError(
                    f"normal_load or friction_coefficient depends on the sensor {quantity!r} of the same contact, "
                    "which depends on them; they may depend on centre_slip, rim_slip, relative_spin and heat"
                )
            asked = True
            try:
                if self._contact.stick is not None and quantity == "mode":
                    return [float(self._contact.stick.visible_mode)]
                if self._contact.stick is not None and quantity == "capacity_share":
                    return [self._contact.stick.capacity_share(mbs, t, angle)]
                if quantity in ("capacity_share", "mode"):
                    creep = self._creep(t, slip, angle, radius)
                    return [
                        mode.at(t, creep, float(slip[2])) if quantity == "mode" else min(1.0, creep or 0.0)
                    ]
                stick = self._contact.stick
                friction = (
                    self._friction(t, slip, angle, radius)
                    if stick is None
                    else stick.wrench(mbs, t, slip, radius, angle)
                )
            finally:
                asked = False
            if quantity == "transmitted_moment":
                return [float(friction[2])]
            if quantity == "power":
                return [-float(friction @ slip)]
            return cast(list[float], (np.array(axes[:2]).T @ friction[:2]).tolist())

        return values

    def power(self, mbs: Any, t: float) -> float:
        """Return the heating power of friction in W, in the form that ``add_energy_balance`` expects."""
        return (self._contact.power or self._new_power())(t)

    def _new_power(self) -> Callable[[float], float]:
        """Return the power in W as a function of the time in s, until the next assembly."""
        mbs, contact = self.mbs, self._contact
        first, second, *_ = *places_of(mbs, contact, self.item), None
        get_coordinates = mbs.systemData.GetODE2Coordinates
        get_velocities = mbs.systemData.GetODE2Coordinates_t
        force, pair = contact.functions["force"], len(self.nodes) == 2
        on_axis = on_one_axis(contact.kinds, contact.factors)
        law = constant_law(contact.kinds, contact.factors) if contact.built_in else None
        moment, creep = law or (0.0, 1.0)
        master, disc = first.start, first.stop - 1

        def of_constant_moment(t: float) -> float:
            velocities = get_velocities(CURRENT, False)  # False: no copy
            spin: float = abs(velocities.item(disc) - (velocities.item(master) if pair else 0.0))
            return moment * (spin if spin > creep else spin * spin / creep)

        stick = contact.stick
        weights: list[float] = [] if stick is None else stick.weights.tolist()

        def of_any(t: float) -> float:
            if stick is not None and stick.visible_mode not in SLIDING:
                return 0.0
            values = get_velocities(CURRENT, False)
            velocities = values[first].tolist()
            if second:
                velocities += values[second].tolist()
            if stick is not None and weights:
                return stick.lost_power(t, 0.0, sum(map(mul, weights, velocities)))
            coordinates = velocities  # ignored by rotors on one axis
            if not on_axis:
                values = get_coordinates(CURRENT, False)
                coordinates = values[first].tolist()
                if second:
                    coordinates += values[second].tolist()
            return -float(sum(map(mul, force(mbs, t, 0, coordinates, velocities), velocities)))

        contact.power = of_constant_moment if law and not second else of_any  # at half the cost
        return contact.power

    def _slip(self, mbs: Any, configuration: Any) -> tuple[FloatArray, float, float, Axes]:
        """Return u_x, u_y (m/s), S (rad/s), the disc's angle and radius in the master's axes, and these axes."""
        q, q_t = motion_of(mbs, self._contact, self.item, configuration)
        to_slip, axes, (cosine, sine), (x, y) = slip_and_place_of_nodes(
            self._contact.kinds, self._contact.reference + q
        )
        return to_slip @ q_t, math.atan2(sine, cosine), math.hypot(x, y), axes

    def _creep(self, t: float, slip: FloatArray, angle: float, radius: float) -> float | None:
        """Return P/ε, or None without friction."""
        contact, spin = self._contact.factors.geometry, float(slip[2])
        speed: float = potential_of(float(slip[0]), float(slip[1]), spin, angle, contact)
        if self._contact.factors.friction_force(t, radius, speed, spin) == 0.0:
            return None
        return speed / contact[3]

    def _friction(self, t: float, slip: FloatArray, angle: float, radius: float) -> FloatArray:
        """Return F_x, F_y (N) in the master's axes and M (N m)."""
        arguments = (*slip.tolist(), angle, self._contact.factors.contact_at(t))
        friction = np.array(friction_of(*arguments))
        if self._contact.factors.depends_on_motion:
            friction *= self._contact.factors.friction_force(
                t, radius, potential_of(*arguments), float(slip[2])
            )
        return friction


class _Mode:
    """Mode of a contact, with a memory of earlier times of the run."""

    def __init__(self) -> None:
        self._time, self._slips = math.inf, False

    def at(self, t: float, creep: float | None, spin: float) -> float:
        """Return the mode at the time t (s) from P/ε, None without friction, and S (rad/s)."""
        if t < self._time:  # a new run
            self._slips = creep is not None and creep >= 1.0
        self._time = t
        if creep is None:
            self._slips = True  # when it closes, its slip determines the mode
            return OPEN
        self._slips = creep >= (1.0 - BAND if self._slips else 1.0 + BAND)
        if not self._slips:
            return LOCKED
        return BACKWARD if spin < 0.0 else FORWARD
