"""Registration of plain functions, which run interpreted until compiled code is asked for."""

from collections.abc import Callable
from typing import Any, TypeVar

Function = TypeVar("Function", bound=Callable[..., Any])

PARTS: list[Callable[..., Any]] = []
"""Functions that compiled code calls."""


def part(function: Function) -> Function:
    """Register ``function``, plain Python on numbers, tuples and arrays, as a part of compiled code."""
    PARTS.append(function)
    return function
