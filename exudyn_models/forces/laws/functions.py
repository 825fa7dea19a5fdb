"""Coefficients and loads as functions: their arguments and checks of their results."""

import inspect
from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass
from functools import cache, partial
from typing import Any

import numba
import numba.core.errors
import numba.extending

from exudyn_models.forces.laws.calls import address_of
from reference_model.systems import finite_number

ARGUMENTS = {"time": "s", "radius": "m", "slip_speed": "m/s", "relative_spin": "rad/s"}
"""Possible arguments of a coefficient or load, with units; see ``ring_friction`` for their meaning."""

Checked = Callable[[float, float, float, float], float]
"""A coefficient or load as a function of all ``ARGUMENTS`` that raises ``ValueError`` for an invalid result."""


@dataclass(frozen=True, eq=False)
class LawFunction:
    """A coefficient or load that is a function of ``arguments``, in the order of ``ARGUMENTS``, for compiled code.

    ``positional`` takes only these arguments, ``checked`` all ``ARGUMENTS``. ``address`` is the address of the
    machine code, 0 for a Python function.
    """

    arguments: tuple[str, ...]
    positional: Callable[..., float]
    checked: Checked
    address: float

    @property
    def places(self) -> float:
        """The ``arguments`` as a bit mask."""
        return bits_of(self.arguments)


def bits_of(arguments: Collection[str]) -> float:
    """Encode a subset of ``ARGUMENTS`` as a bit mask."""
    return float(sum(1 << i for i, name in enumerate(ARGUMENTS) if name in arguments))


def law_function(name: str, function: Callable[..., float], unit: str) -> LawFunction:
    """Return a coefficient or load named ``name``; raise ``ValueError`` if ``function`` is not valid."""
    arguments, in_order = _arguments(name, function)
    positional = function if in_order else partial(_call_by_name, arguments, function)

    def checked(*known: float) -> float:
        given = dict(zip(ARGUMENTS, known, strict=True))
        result = positional(*(given[argument] for argument in arguments))
        told = [
            f"{argument} = {value:.9g} {ARGUMENTS[argument]}"
            for argument, value in given.items()
            if argument == "time" or argument in arguments
        ]
        return checked_not_negative(f"{name}({', '.join(told)})", result, unit)

    if not (in_order and numba.extending.is_jitted(function)):
        return LawFunction(arguments, positional, checked, 0.0)
    try:
        address = address_of(_of_four(function, arguments))
    except numba.core.errors.NumbaError as error:
        raise ValueError(f"{name} is a numba function that cannot be compiled for floats: {error}") from error
    return LawFunction(arguments, positional, checked, address)


def checked_not_negative(name: str, value: float, unit: str) -> float:
    """Return ``value`` as a float; raise ``ValueError`` unless it is finite and >= 0."""
    number = finite_number(name, value)
    if number < 0.0:
        raise ValueError(f"{name} = {number:g}{unit}: it must be >= 0")
    return number


def _call_by_name(arguments: Sequence[str], function: Callable[..., float], *given: float) -> float:
    return function(**dict(zip(arguments, given, strict=True)))


def _arguments(name: str, function: Callable[..., float]) -> tuple[tuple[str, ...], bool]:
    """Return which ``ARGUMENTS`` a function takes, and whether in that order."""
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
    arguments = tuple(argument for argument in ARGUMENTS if argument in taken)
    first = parameters[: len(arguments)]
    positional = all(parameter.kind == parameter.POSITIONAL_OR_KEYWORD for parameter in first)
    return arguments, positional and tuple(parameter.name for parameter in first) == arguments


@cache  # machine code must persist while it may be called
def _of_four(function: Any, arguments: tuple[str, ...]) -> Any:
    places = tuple(list(ARGUMENTS).index(argument) for argument in arguments)
    adapt = _OF_FOUR[len(places)]

    def of_four(t: float, r: float, v: float, s: float) -> float:
        return adapt(function, (t, r, v, s), places)  # type: ignore[no-any-return]

    return numba.njit("float64(float64, float64, float64, float64)")(of_four)


_OF_FOUR = [
    numba.njit(adapt)
    for adapt in (
        lambda f, k, i: f(),
        lambda f, k, i: f(k[i[0]]),
        lambda f, k, i: f(k[i[0]], k[i[1]]),
        lambda f, k, i: f(k[i[0]], k[i[1]], k[i[2]]),
        lambda f, k, i: f(k[i[0]], k[i[1]], k[i[2]], k[i[3]]),
    )
]
"""Calls of functions of zero to four arguments with the numbers at given places."""
