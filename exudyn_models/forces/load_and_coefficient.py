"""Normal load and friction coefficient of a contact, numbers or functions, whose product is the friction force."""

from __future__ import annotations

import inspect
import math
from collections.abc import Callable
from functools import partial
from typing import TypeAlias

import numpy as np

from exudyn_models.forces.friction_laws import Contact
from reference_model.systems import FloatArray, finite_number

NumberOrFunction: TypeAlias = float | Callable[..., float]
"""A load or coefficient; a function takes any of ``ARGUMENTS``, by name."""

Factor: TypeAlias = Callable[[float, float, float], float]
"""μ or N as a function of all of ``ARGUMENTS``."""

ARGUMENTS = {"time": "s", "radius": "m", "slip_speed": "m/s"}
"""What a coefficient or load may depend on, with its unit.

``radius`` is the distance of the disc's node from the master's axis, ``slip_speed`` the mean slip speed P.
"""

DIFFERENCE = 1e-5
"""Relative step of the central differences that give the slopes of μN over radius and slip speed."""


class LoadAndCoefficient:
    """Friction coefficient μ and normal load N of a contact, which may be changed between two runs.

    Parameters
    ----------
    contact : Contact
        Its μN counts nothing.
    friction_coefficient : float or callable
        μ >= 0, or as a function of any of ``ARGUMENTS``.
    normal_load : float or callable
        N in N, >= 0, or as such a function.

    Raises
    ------
    ValueError
        If a number is negative or not finite or a function takes other arguments, and in a run if a function
        returns such a number.

    """

    def __init__(
        self, contact: Contact, friction_coefficient: NumberOrFunction, normal_load: NumberOrFunction
    ) -> None:
        self._contact = contact
        self.contact_radius = contact[0]
        self.change(friction_coefficient, normal_load)

    def change(self, friction_coefficient: NumberOrFunction, normal_load: NumberOrFunction) -> None:
        """Replace both."""
        coefficient, its_arguments = _factor("friction_coefficient", friction_coefficient, "")
        load, loads_arguments = _factor("normal_load", normal_load, " N")
        self.friction_coefficient, self.normal_load = friction_coefficient, normal_load
        self._coefficient, self._load = coefficient, load
        reads = {*its_arguments, *loads_arguments}
        self._by_radius, self._by_slip_speed = "radius" in reads, "slip_speed" in reads
        self.depends_on_motion = self._by_radius or self._by_slip_speed
        #: The contact with its μN, or None where that is no number.
        self.contact = (
            None
            if callable(friction_coefficient) or callable(normal_load)
            else self._with(self.friction_force(math.nan, math.nan, math.nan))
        )

    def contact_at(self, t: float) -> Contact:
        """Return the contact with μN at the time t (s), or with 1 N in its place if that depends on the motion."""
        return self._with(1.0 if self.depends_on_motion else self.friction_force(t, math.nan, math.nan))

    def friction_force(self, t: float, radius: float, slip_speed: float) -> float:
        """Return the friction force μN in N at a time in s, a radius in m and a mean slip speed in m/s."""
        return self._coefficient(t, radius, slip_speed) * self._load(t, radius, slip_speed)

    def friction_force_slopes(self, t: float, radius: float, slip_speed: float) -> FloatArray:
        """Return the derivatives of μN by the radius in N/m and by the slip speed in N s/m, shape (2,)."""
        result = np.zeros(2)
        if self._by_radius and radius > 0.0:  # on the axis the radius itself has no derivative
            result[0] = _slope(
                lambda r: self.friction_force(t, r, slip_speed), radius, max(radius, self.contact_radius)
            )
        if self._by_slip_speed:
            result[1] = _slope(
                lambda v: self.friction_force(t, radius, v), slip_speed, max(slip_speed, self._contact[3])
            )
        return result

    def _with(self, friction: float) -> Contact:
        radius, points, _, epsilon, held, inner = self._contact
        return radius, points, friction, epsilon, held, inner


def _factor(name: str, value: NumberOrFunction, unit: str) -> tuple[Factor, tuple[str, ...]]:
    """Return a coefficient or load as a function of all ``ARGUMENTS``, and which of them it depends on."""
    if not callable(value):
        number = checked_not_negative(name, value, unit)
        return lambda time, radius, slip_speed: number, ()
    function, arguments = value, _arguments(name, value)
    call = _CALLS[arguments]

    # This runs at every evaluation: a good value passes quickly.
    def factor(time: float, radius: float, slip_speed: float) -> float:
        result = call(function, time, radius, slip_speed)
        if isinstance(result, (float, int)) and 0.0 <= result < math.inf:
            return float(result)  # a NumPy number would make all later arithmetic NumPy's, which is slower
        known = zip(ARGUMENTS.items(), (time, radius, slip_speed), strict=True)
        told = [
            f"{argument} = {given:.9g} {unit_of_it}"
            for (argument, unit_of_it), given in known
            if argument == "time" or argument in arguments
        ]
        return checked_not_negative(f"{name}({', '.join(told)})", result, unit)

    return factor, arguments


_CALLS: dict[tuple[str, ...], Callable[[Callable[..., float], float, float, float], float]] = {
    (): lambda f, t, r, v: f(),
    ("time",): lambda f, t, r, v: f(time=t),
    ("radius",): lambda f, t, r, v: f(radius=r),
    ("slip_speed",): lambda f, t, r, v: f(slip_speed=v),
    ("time", "radius"): lambda f, t, r, v: f(time=t, radius=r),
    ("time", "slip_speed"): lambda f, t, r, v: f(time=t, slip_speed=v),
    ("radius", "slip_speed"): lambda f, t, r, v: f(radius=r, slip_speed=v),
    ("time", "radius", "slip_speed"): lambda f, t, r, v: f(time=t, radius=r, slip_speed=v),
}


def _arguments(name: str, function: Callable[..., float]) -> tuple[str, ...]:
    """Return which of ``ARGUMENTS`` a function takes, in their order; raise ``ValueError`` if it needs others."""
    allowed = f"any of {', '.join(ARGUMENTS)} by these names, as `lambda time: ...` does"
    try:
        parameters = inspect.signature(function).parameters.values()
    except (TypeError, ValueError):
        raise ValueError(
            f"{name} = {function!r}: its arguments can't be seen; it must take {allowed}"
        ) from None
    fixed = function.keywords if isinstance(function, partial) else {}
    taken = set()
    for parameter in parameters:
        if parameter.name in ARGUMENTS and parameter.kind in (
            parameter.POSITIONAL_OR_KEYWORD,
            parameter.KEYWORD_ONLY,
        ):
            if parameter.name not in fixed:
                taken.add(parameter.name)
        elif parameter.default is parameter.empty:  # *arguments and **options have none
            raise ValueError(f"{name} takes `{parameter}`: a function must take {allowed}")
    return tuple(name for name in ARGUMENTS if name in taken)


def _slope(function: Callable[[float], float], value: float, scale: float) -> float:
    """Return the derivative of a function of numbers >= 0 by a difference over 1e-5 of ``scale`` to either side."""
    low, high = max(0.0, value - DIFFERENCE * scale), value + DIFFERENCE * scale
    return (function(high) - function(low)) / (high - low)


def checked_not_negative(name: str, value: float, unit: str) -> float:
    """Return ``value`` as a float; raise ``ValueError`` if it is not a finite number >= 0."""
    number = finite_number(name, value)
    if number < 0.0:
        raise ValueError(f"{name} = {number:g}{unit}: it must be >= 0")
    return number
