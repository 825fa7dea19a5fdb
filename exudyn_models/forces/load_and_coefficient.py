"""Normal load and friction coefficient of a contact, whose product is the friction force."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import TypeAlias, cast

import numpy as np

from exudyn_models.forces.friction_laws import NONE_HELD, Contact
from exudyn_models.forces.laws.curves import curve_of_table, peak_over_sliding
from exudyn_models.forces.laws.functions import ARGUMENTS, LawFunction, checked_not_negative, law_function
from exudyn_models.forces.laws.places import ring_places, table_of
from reference_model.systems import FloatArray, finite_number

NumberOrFunction: TypeAlias = float | Callable[..., float]
"""A load or coefficient; a function takes any of ``ARGUMENTS``."""

Coefficient: TypeAlias = NumberOrFunction | Sequence[Sequence[float]] | FloatArray
"""A coefficient, which may also be a table for ``curve_of_table``."""

DIFFERENCE = 1e-5
"""Relative step of the central differences of μN."""

SLOWEST = 1e-9
"""Slip speed in m/s below which this step stays constant."""

AT_REST = 1e-200
"""Relative spin in rad/s of a contact at rest that is about to slide."""


class LoadAndCoefficient:
    """Friction coefficient μ and normal load N (in N) of a contact, which may be changed between runs.

    They have the meaning of ``add_ring_friction``, for ``plates`` equal contacts; ``static_ratio`` is static divided
    by sliding friction. The μN of ``contact`` is ignored. Raises ``ValueError`` if a number is out of range or a
    function takes other arguments; in a run, if a function returns an invalid number.
    """

    def __init__(
        self,
        contact: Contact,
        friction_coefficient: Coefficient,
        normal_load: NumberOrFunction,
        static_ratio: float = 1.0,
        plates: int = 1,
    ) -> None:
        #: The contact with 1 N in place of μN.
        self.geometry = _with(contact, 1.0)
        self.contact_radius = contact[0]
        self.static_ratio, self._plates = _checked_static_ratio(static_ratio), _checked_plates(plates)
        self.change(friction_coefficient, normal_load)

    def change(self, friction_coefficient: Coefficient, normal_load: NumberOrFunction) -> None:
        """Replace both."""
        coefficient = _coefficient(friction_coefficient)
        load = _number_or_function("normal_load", normal_load, " N")
        self.friction_coefficient, self.normal_load = friction_coefficient, normal_load
        factors = [factor for factor in (coefficient, load) if isinstance(factor, LawFunction)]
        numbers = (factor for factor in (coefficient, load) if isinstance(factor, float))
        self._constant, self._factors = math.prod(numbers, start=self._plates), factors
        if self.static_ratio > 1.0:
            factors.append(_of_slip_speed(self._peak))
        self._reads = {name for factor in factors for name in factor.arguments}
        self.depends_on_motion = not self._reads <= {"time"}
        self.depends_on_radius = "radius" in self._reads
        self.depends_on_direction = "relative_spin" in self._reads
        self.depends_on_slip = not self._reads <= {"time", "radius"}
        #: The contact with its μN, or None if μN is not constant.
        self.contact = None if factors else _with(self.geometry, self._constant)

    def _peak(self, slip_speed: float) -> float:
        return peak_over_sliding(slip_speed / self.geometry[3], self.static_ratio)

    def without_peak(self) -> LoadAndCoefficient:
        """Return the sliding friction alone."""
        return LoadAndCoefficient(
            self.geometry, self.friction_coefficient, self.normal_load, plates=int(self._plates)
        )

    def per_newton(self) -> LoadAndCoefficient:
        """Return the sliding friction under 1 N."""
        return LoadAndCoefficient(self.geometry, self.friction_coefficient, 1.0, plates=int(self._plates))

    def at_pins(self, shares: FloatArray) -> list[LoadAndCoefficient]:
        """Return the sliding friction of pins that carry these ``shares`` of the load, shape (n,)."""
        pin = 0.0, 1, 1.0, self.geometry[3], NONE_HELD, table_of(ring_places(0.0, 1))
        pins = []
        for share in shares.tolist():
            pins.append(LoadAndCoefficient(pin, self.friction_coefficient, self.normal_load))
            pins[-1]._plates = share * self._plates
            pins[-1].change(self.friction_coefficient, self.normal_load)
        return pins

    def contact_at(self, t: float) -> Contact:
        """Return the contact with μN at the time t (s), or with 1 N if μN depends on the motion."""
        if self.depends_on_motion:
            return self.geometry
        return _with(self.geometry, self.friction_force(t, math.nan, math.nan, math.nan))

    @property
    def of_time(self) -> tuple[float, LawFunction] | None:
        """A number and a function of time whose product is μN, or None if it is not such a product."""
        if len(self._factors) == 1 and self._factors[0].arguments == ("time",):
            return self._constant, self._factors[0]
        return None

    def friction_force(self, t: float, radius: float, slip_speed: float, relative_spin: float) -> float:
        """Return the friction force μN in N of all plates for a motion as in ``ARGUMENTS``."""
        force = self._constant
        for factor in self._factors:
            result = factor.of_motion(t, radius, slip_speed, relative_spin)
            if type(result) is not float or not 0.0 <= result < math.inf:
                result = factor.checked(result, t, radius, slip_speed, relative_spin)
            force *= result
        return force

    def friction_force_slopes(
        self, t: float, radius: float, slip_speed: float, relative_spin: float
    ) -> tuple[float, float, float]:
        """Return ∂(μN)/∂(radius, slip speed, relative spin) in N/m, N s/m and N s, by central differences."""
        motion, slopes = [radius, slip_speed, relative_spin], [0.0, 0.0, 0.0]
        rim, slowest = self.contact_radius, max(self.geometry[3], SLOWEST)
        least = rim, slowest, slowest / rim if rim > 0.0 else 1.0
        for i, name in enumerate(list(ARGUMENTS)[1:]):
            value = motion[i]
            if name not in self._reads or (name == "radius" and value == 0.0):  # no slope on the axis
                continue
            step = DIFFERENCE * max(abs(value), least[i])
            low, high = value - step, value + step
            if value >= 0.0:  # the coefficient may jump at rest
                low = max(AT_REST, low)
            else:
                high = min(-AT_REST, high)
            for end, sign in ((low, -1.0), (high, 1.0)):
                motion[i] = end
                slopes[i] += sign * self.friction_force(t, motion[0], motion[1], motion[2]) / (high - low)
            motion[i] = value
        return slopes[0], slopes[1], slopes[2]


def _with(contact: Contact, friction: float) -> Contact:
    radius, points, _, epsilon, held, inner = contact
    return radius, points, friction, epsilon, held, inner


def _coefficient(value: Coefficient) -> float | LawFunction:
    name = "friction_coefficient"
    if isinstance(value, (list, tuple)) or (isinstance(value, np.ndarray) and value.ndim > 0):
        return _of_slip_speed(curve_of_table(name, value))
    return _number_or_function(name, cast(NumberOrFunction, value), "")


def _of_slip_speed(coefficient: Callable[[float], float]) -> LawFunction:
    return LawFunction(
        "friction_coefficient", "", ("slip_speed",), lambda t, r, v, s: coefficient(v), coefficient
    )


def _number_or_function(name: str, value: NumberOrFunction, unit: str) -> float | LawFunction:
    return law_function(name, value, unit) if callable(value) else checked_not_negative(name, value, unit)


def _checked_static_ratio(value: float) -> float:
    ratio = finite_number("static_ratio", value)
    if ratio < 1.0:
        raise ValueError(f"static_ratio = {ratio:g}: static divided by sliding friction must be >= 1")
    return ratio


def _checked_plates(value: int) -> float:
    number = finite_number("plates", value)
    if number < 1.0 or number != int(number):
        raise ValueError(f"plates = {number:g}: it must be a whole number >= 1")
    return number
