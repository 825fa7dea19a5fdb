"""Normal load and friction coefficient of a contact, numbers or functions, whose product is the friction force."""

from __future__ import annotations

import inspect
import math
from collections.abc import Callable, Sequence
from functools import partial
from typing import TypeAlias, cast

import numpy as np

from exudyn_models.forces.friction_curves import curve_of_table, peak_over_sliding
from exudyn_models.forces.friction_laws import Contact
from reference_model.systems import FloatArray, finite_number

NumberOrFunction: TypeAlias = float | Callable[..., float]
"""A load or coefficient; a function takes any of ``ARGUMENTS``, by name."""

Coefficient: TypeAlias = NumberOrFunction | Sequence[Sequence[float]] | FloatArray
"""A coefficient, also as a table for ``curve_of_table``."""

Factor: TypeAlias = Callable[[float, float, float, float], float]
"""μ or N as a function of all of ``ARGUMENTS``."""

ARGUMENTS = {"time": "s", "radius": "m", "slip_speed": "m/s", "relative_spin": "rad/s"}
"""What a coefficient or load may depend on, with its unit.

``radius`` is the distance of the disc's node from the master's axis, ``slip_speed`` the mean slip speed P,
``relative_spin`` S, that of the disc less that of the master.
"""

DIFFERENCE = 1e-5
"""Relative step of the central differences that give the slopes of μN over all of the motion."""


class LoadAndCoefficient:
    """Friction coefficient μ and normal load N of a contact, which may be changed between two runs.

    Parameters
    ----------
    contact : Contact
        Its μN counts nothing.
    friction_coefficient : float, table or callable
        μ >= 0, or as a table over P, or as a function of any of ``ARGUMENTS``.
    normal_load : float or callable
        N in N, >= 0, or as such a function.
    static_ratio : float
        Static over sliding friction, >= 1, see ``peak_over_sliding``.
    plates : int
        Contacts alike, >= 1, that all carry N.

    Raises
    ------
    ValueError
        If a number is negative or not finite or a function takes other arguments, and in a run if a function
        returns such a number.

    """

    def __init__(
        self,
        contact: Contact,
        friction_coefficient: Coefficient,
        normal_load: NumberOrFunction,
        static_ratio: float = 1.0,
        plates: int = 1,
    ) -> None:
        #: The contact with 1 N in place of its μN.
        self.geometry = _with(contact, 1.0)
        self.contact_radius = contact[0]
        self._static_ratio, self._plates = _checked_static_ratio(static_ratio), _checked_plates(plates)
        self.change(friction_coefficient, normal_load)

    def change(self, friction_coefficient: Coefficient, normal_load: NumberOrFunction) -> None:
        """Replace both."""
        coefficient, its_arguments = _coefficient(friction_coefficient)
        load, loads_arguments = _factor("normal_load", normal_load, " N")
        self.friction_coefficient, self.normal_load = friction_coefficient, normal_load
        factors = coefficient, load
        self._functions = [factor for factor in factors if callable(factor)]
        self._constant = math.prod((factor for factor in factors if not callable(factor)), start=self._plates)
        self._reads = {*its_arguments, *loads_arguments}
        if self._static_ratio > 1.0:
            self._reads.add("slip_speed")
        self.depends_on_motion = not self._reads <= {"time"}
        #: The contact with its μN, or None where that is no number.
        self.contact = None if self._functions or self._reads else _with(self.geometry, self._constant)

    def contact_at(self, t: float) -> Contact:
        """Return the contact with μN at the time t (s), or with 1 N in its place if that depends on the motion."""
        if self.depends_on_motion:
            return self.geometry
        return _with(self.geometry, self.friction_force(t, math.nan, math.nan, math.nan))

    def friction_force(self, t: float, radius: float, slip_speed: float, relative_spin: float) -> float:
        """Return the friction force μN in N, of all plates, at a time in s and a motion as ``ARGUMENTS`` tell it."""
        force = self._constant
        for function in self._functions:
            force *= function(t, radius, slip_speed, relative_spin)
        if self._static_ratio > 1.0:
            force *= peak_over_sliding(slip_speed / self.geometry[3], self._static_ratio)
        return force

    def friction_force_slopes(
        self, t: float, radius: float, slip_speed: float, relative_spin: float
    ) -> FloatArray:
        """Return the derivatives of μN by radius (N/m), slip speed (N s/m) and relative spin (N s), shape (3,)."""
        rim, epsilon = self.contact_radius, self.geometry[3]
        motion = {"radius": radius, "slip_speed": slip_speed, "relative_spin": relative_spin}
        scales = (
            max(radius, rim),
            max(slip_speed, epsilon),
            max(abs(relative_spin), epsilon / rim if rim else 1.0),
        )
        result = np.zeros(3)
        for i, (name, scale) in enumerate(zip(motion, scales, strict=True)):
            if name in self._reads and (name != "radius" or radius > 0.0):  # on the axis it has no derivative
                low, high = motion[name] - DIFFERENCE * scale, motion[name] + DIFFERENCE * scale
                if name != "relative_spin":
                    low = max(0.0, low)
                change = self.friction_force(t, **motion | {name: high})
                change -= self.friction_force(t, **motion | {name: low})
                result[i] = change / (high - low)
        return result


def _with(contact: Contact, friction: float) -> Contact:
    radius, points, _, epsilon, held, inner = contact
    return radius, points, friction, epsilon, held, inner


def _coefficient(value: Coefficient) -> tuple[float | Factor, tuple[str, ...]]:
    """Return a coefficient as a number or a function of all ``ARGUMENTS``, and which of them it depends on."""
    name = "friction_coefficient"
    table = isinstance(value, (list, tuple)) or (isinstance(value, np.ndarray) and value.ndim > 0)
    return _factor(name, curve_of_table(name, value) if table else cast(NumberOrFunction, value), "")


def _checked_static_ratio(value: float) -> float:
    ratio = finite_number("static_ratio", value)
    if ratio < 1.0:
        raise ValueError(f"static_ratio = {ratio:g}: it must be >= 1, static over sliding friction")
    return ratio


def _checked_plates(value: int) -> float:
    number = finite_number("plates", value)
    if number < 1.0 or number != int(number):
        raise ValueError(f"plates = {number:g}: it must be a whole number >= 1")
    return number


def _factor(name: str, value: NumberOrFunction, unit: str) -> tuple[float | Factor, tuple[str, ...]]:
    """Return a coefficient or load as a number or a function of all ``ARGUMENTS``, and which it depends on."""
    if not callable(value):
        return checked_not_negative(name, value, unit), ()
    function, arguments = value, _arguments(name, value)
    call = _CALLS.get(arguments) or partial(_call, arguments)

    # This runs at every evaluation: a good value passes quickly.
    def factor(time: float, radius: float, slip_speed: float, relative_spin: float) -> float:
        result = call(function, time, radius, slip_speed, relative_spin)
        if isinstance(result, (float, int)) and 0.0 <= result < math.inf:
            return float(result)  # a NumPy number would make all later arithmetic NumPy's, which is slower
        known = zip(ARGUMENTS.items(), (time, radius, slip_speed, relative_spin), strict=True)
        told = [
            f"{argument} = {given:.9g} {unit_of_it}"
            for (argument, unit_of_it), given in known
            if argument == "time" or argument in arguments
        ]
        return checked_not_negative(f"{name}({', '.join(told)})", result, unit)

    return factor, arguments


def _call(
    arguments: tuple[str, ...], f: Callable[..., float], t: float, r: float, v: float, s: float
) -> float:
    """Call a function with any ``arguments``."""
    known = {"time": t, "radius": r, "slip_speed": v, "relative_spin": s}
    return f(**{name: known[name] for name in arguments})


_CALLS: dict[tuple[str, ...], Callable[[Callable[..., float], float, float, float, float], float]] = {
    (): lambda f, t, r, v, s: f(),
    ("time",): lambda f, t, r, v, s: f(time=t),
    ("radius",): lambda f, t, r, v, s: f(radius=r),
    ("slip_speed",): lambda f, t, r, v, s: f(slip_speed=v),
    ("time", "radius"): lambda f, t, r, v, s: f(time=t, radius=r),
    ("time", "slip_speed"): lambda f, t, r, v, s: f(time=t, slip_speed=v),
    ("radius", "slip_speed"): lambda f, t, r, v, s: f(radius=r, slip_speed=v),
    ("time", "radius", "slip_speed"): lambda f, t, r, v, s: f(time=t, radius=r, slip_speed=v),
    ("relative_spin",): lambda f, t, r, v, s: f(relative_spin=s),
}
"""What is quicker than ``_call``, for the arguments that are usual."""


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


def checked_not_negative(name: str, value: float, unit: str) -> float:
    """Return ``value`` as a float; raise ``ValueError`` if it is not a finite number >= 0."""
    number = finite_number(name, value)
    if number < 0.0:
        raise ValueError(f"{name} = {number:g}{unit}: it must be >= 0")
    return number
