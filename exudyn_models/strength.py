"""How strong the friction of a contact is: coefficient and normal load, as numbers or functions."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TypeAlias

from exudyn_models.friction_laws import Contact
from reference_model.systems import finite_number

NumberOrFunction: TypeAlias = float | Callable[[float], float]

DIFFERENCE = 1e-5
"""Relative step of the central difference that gives the slope of μ over slip speed."""


class Strength:
    """Friction coefficient μ and normal load N of a contact, which may be changed between two runs.

    Parameters
    ----------
    contact : Contact
        Its μN counts nothing.
    friction_coefficient : float or callable
        μ >= 0, or as a function of the mean slip speed in m/s.
    normal_load : float or callable
        N in N, >= 0, or as a function of time in s.

    Raises
    ------
    ValueError
        If a number is negative or not finite, and in a run if a function returns such a one.

    """

    def __init__(
        self, contact: Contact, friction_coefficient: NumberOrFunction, normal_load: NumberOrFunction
    ) -> None:
        self._contact = contact
        self.contact_radius = contact[0]
        self.change(friction_coefficient, normal_load)

    def change(self, friction_coefficient: NumberOrFunction, normal_load: NumberOrFunction) -> None:
        """Replace both."""
        coefficient, load = (
            value if callable(value) else checked_strength(name, value, unit)
            for name, value, unit in (
                ("friction_coefficient", friction_coefficient, ""),
                ("normal_load", normal_load, " N"),
            )
        )
        self.friction_coefficient, self.normal_load = coefficient, load
        self.depends_on_motion = callable(coefficient)
        #: The contact with its μN, or None where that is no number.
        self.contact = None if callable(coefficient) or callable(load) else self._with(coefficient * load)

    def contact_at(self, t: float) -> Contact:
        """Return the contact with μN at the time t (s), or with N alone if μ depends on the slip speed."""
        coefficient = 1.0 if callable(self.friction_coefficient) else self.friction_coefficient
        return self._with(coefficient * self.load(t))

    def load(self, t: float) -> float:
        """Return N in N at the time t in s."""
        if not callable(self.normal_load):
            return self.normal_load
        return checked_strength(f"normal_load({t:.9g} s)", self.normal_load(t), " N")

    def coefficient(self, slip_speed: float) -> float:
        """Return μ at a mean slip speed in m/s."""
        if not callable(self.friction_coefficient):
            return self.friction_coefficient
        return checked_strength(
            f"friction_coefficient({slip_speed:.9g} m/s)", self.friction_coefficient(slip_speed), ""
        )

    def coefficient_slope(self, slip_speed: float) -> float:
        """Return dμ/dv in s/m at a mean slip speed in m/s."""
        step = DIFFERENCE * max(slip_speed, self._contact[3])
        low, high = max(0.0, slip_speed - step), slip_speed + step
        return (self.coefficient(high) - self.coefficient(low)) / (high - low)

    def _with(self, friction: float) -> Contact:
        radius, points, _, epsilon, held, inner = self._contact
        return radius, points, friction, epsilon, held, inner


def checked_strength(name: str, value: float, unit: str) -> float:
    """Return ``value`` as a float; raise ``ValueError`` if it is not a finite number >= 0."""
    # In a run this is called at every evaluation: a good float passes quickly.
    if type(value) is float and 0.0 <= value < math.inf:
        return value
    number = finite_number(name, value)
    if number < 0.0:
        raise ValueError(f"{name} = {number:g}{unit}: it must be >= 0")
    return number
