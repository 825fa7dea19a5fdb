"""Normal load and friction coefficient of a contact, whose product is the friction force."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from functools import cache
from typing import Any, TypeAlias, cast

import numpy as np

from exudyn_models.forces.friction_laws import NONE_HELD, Contact
from exudyn_models.forces.jit import entry_point
from exudyn_models.forces.laws.curves import curve_of_table
from exudyn_models.forces.laws.functions import LawFunction, checked_not_negative, law_function
from exudyn_models.forces.laws.places import ring_places, table_of
from exudyn_models.forces.laws.product import (
    LAW,
    Law,
    friction_force_slopes,
    friction_force_under,
    law_of,
)
from reference_model.systems import FloatArray, finite_number

NumberOrFunction: TypeAlias = float | Callable[..., float]
"""A load or coefficient; a function takes any of ``ARGUMENTS``."""

Coefficient: TypeAlias = NumberOrFunction | Sequence[Sequence[float]] | FloatArray
"""A coefficient, which may also be a table for ``curve_of_table``."""


class LoadAndCoefficient:
    """Friction coefficient μ and normal load N (in N) of a contact, which may be changed between runs.

    They are those of ``add_ring_friction``, for ``plates`` equal contacts; ``static_ratio`` is static divided by
    sliding friction. The μN of ``contact`` is ignored. Raises ``ValueError`` if a number is out of range or a
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
        numbers = (factor for factor in (coefficient, load) if isinstance(factor, float))
        constant = math.prod(numbers, start=self._plates)
        functions = [factor if isinstance(factor, LawFunction) else None for factor in (coefficient, load)]
        self._reads = {name for function in functions if function for name in function.arguments}
        curve = coefficient if isinstance(coefficient, np.ndarray) else None
        if self.static_ratio > 1.0 or curve is not None:
            self._reads.add("slip_speed")
        self.depends_on_motion = not self._reads <= {"time"}
        self.depends_on_radius = "radius" in self._reads
        self.depends_on_direction = "relative_spin" in self._reads
        self.depends_on_slip = not self._reads <= {"time", "radius"}
        #: Whether it calls no Python function.
        self.compiled = all(function is None or function.address != 0.0 for function in functions)
        is_number = not self._reads and functions == [None, None]
        #: The contact with its μN, or None if μN is not constant.
        self.contact = _with(self.geometry, constant) if is_number else None
        #: The law of μN, or None if it is constant.
        self.law: Law | None = None if is_number else law_of(constant, self.static_ratio, curve, *functions)

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

    def friction_force(self, t: float, radius: float, slip_speed: float, relative_spin: float) -> float:
        """Return the friction force μN in N of all plates for a motion as in ``ARGUMENTS``."""
        if self.contact is not None:
            return self.contact[2]
        motion = t, radius, slip_speed, relative_spin
        return cast(float, _of_python()(self.law, self.geometry[3], *motion))

    def friction_force_slopes(
        self, t: float, radius: float, slip_speed: float, relative_spin: float
    ) -> FloatArray:
        """Return ∂(μN)/∂(radius, slip speed, relative spin) in N/m, N s/m and N s, shape (3,)."""
        if self.law is None:
            return np.zeros(3)
        fixed = self.law, self.geometry[3], self.contact_radius
        return np.array(_slopes()(*fixed, t, radius, slip_speed, relative_spin))


def _with(contact: Contact, friction: float) -> Contact:
    radius, points, _, epsilon, held, inner = contact
    return radius, points, friction, epsilon, held, inner


@cache
def _of_python() -> Callable[..., Any]:
    return entry_point(friction_force_under, LAW, *[float] * 5)


@cache
def _slopes() -> Callable[..., Any]:
    return entry_point(friction_force_slopes, LAW, *[float] * 6)


def _coefficient(value: Coefficient) -> float | LawFunction | FloatArray:
    name = "friction_coefficient"
    if isinstance(value, (list, tuple)) or (isinstance(value, np.ndarray) and value.ndim > 0):
        return curve_of_table(name, value)
    return _number_or_function(name, cast(NumberOrFunction, value), "")


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
