"""Coefficients and loads as functions: their arguments and checks of their results."""

import inspect
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import cast

import numba
import numba.core.errors
import numba.extending

from reference_model.systems import finite_number

ARGUMENTS = {"time": "s", "radius": "m", "slip_speed": "m/s", "relative_spin": "rad/s"}
"""Possible arguments of a coefficient or load, with units; see ``ring_friction`` for their meaning."""


@dataclass(frozen=True, eq=False)
class LawFunction:
    """A coefficient or load that is a function of some ``arguments``; ``unit`` is the unit of its result.

    ``of_motion`` takes all ``ARGUMENTS``, ``function`` only its own. Their results are not checked.
    """

    name: str
    unit: str
    arguments: tuple[str, ...]
    of_motion: Callable[[float, float, float, float], float]
    function: Callable[..., float]

    def checked(self, result: object, *motion: float) -> float:
        """Return a result as a float; raise ``ValueError`` with the ``motion`` unless it is finite and >= 0."""
        told = [
            f"{argument} = {value:.9g} {ARGUMENTS[argument]}"
            for argument, value in zip(ARGUMENTS, motion, strict=True)
            if argument == "time" or argument in self.arguments
        ]
        return checked_not_negative(f"{self.name}({', '.join(told)})", cast(float, result), self.unit)


def law_function(name: str, function: Callable[..., float], unit: str) -> LawFunction:
    """Return a coefficient or load named ``name``; raise ``ValueError`` if ``function`` is not valid."""
    arguments = _arguments(name, function)
    if numba.extending.is_jitted(function):
        try:
            function.compile((numba.float64,) * len(arguments))
        except numba.core.errors.NumbaError as error:
            raise ValueError(
                f"{name} is a numba function that cannot be compiled for floats: {error}"
            ) from error
    by_name = ", ".join(f"{argument}={argument}" for argument in arguments)
    of_motion = eval(f"lambda {', '.join(ARGUMENTS)}: function({by_name})", {"function": function})
    parameters = list(inspect.signature(function).parameters.values())[: len(arguments)]
    by_position = [one.name for one in parameters if one.kind == one.POSITIONAL_OR_KEYWORD]
    if by_position != list(arguments):
        function = eval(f"lambda {', '.join(arguments)}: function({by_name})", {"function": function})
    return LawFunction(name, unit, arguments, of_motion, function)


def checked_not_negative(name: str, value: float, unit: str) -> float:
    """Return ``value`` as a float; raise ``ValueError`` unless it is finite and >= 0."""
    number = finite_number(name, value)
    if number < 0.0:
        raise ValueError(f"{name} = {number:g}{unit}: it must be >= 0")
    return number


def _arguments(name: str, function: Callable[..., float]) -> tuple[str, ...]:
    """Return which ``ARGUMENTS`` a function takes, in their order."""
    allowed = f"only arguments named {', '.join(ARGUMENTS)}, for example `lambda time: ...`"
    try:
        parameters = list(inspect.signature(function).parameters.values())
    except (TypeError, ValueError):
        raise ValueError(
            f"{name} = {function!r}: it has no readable signature; it may take {allowed}"
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
            hint = (
                "; a coefficient may take temperature with a thermal_node"
                if parameter.name == "temperature"
                else ""
            )
            raise ValueError(f"{name} takes `{parameter}`: a function may take {allowed}{hint}")
    return tuple(argument for argument in ARGUMENTS if argument in taken)
