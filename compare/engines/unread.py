"""Parameters that a Python engine never reads, found by recording every access."""

import functools
import inspect
from collections.abc import Callable
from dataclasses import fields
from typing import Any

from reference_model.systems import System

NONLINEAR = {"hardening": ("hardening",), "stop_stiffness": ("stop_stiffness", "stop_gap")}
"""Parameters of nonlinear supports, each known to an engine that reads any of the listed names.

An engine may read the stiffness of a stop only during contact.
"""

SHORT = 1e-3  # duration of the motion in s


def unread(function: Callable[..., Any], system: System, start: object, **accuracy: float) -> tuple[str, ...]:
    """Return the names in ``NONLINEAR`` that are nonzero in ``system`` but never read by ``function``.

    The result is empty if ``function`` is not a Python function or does not answer.
    """
    if not inspect.isfunction(function):  # a program or a file receives all parameters
        return ()
    return _unread(function, system, tuple(start), tuple(accuracy.items()))  # type: ignore[arg-type]


@functools.lru_cache(maxsize=64)
def _unread(
    function: Callable[..., Any],
    system: System,
    start: tuple[float, ...],
    accuracy: tuple[tuple[str, float], ...],
) -> tuple[str, ...]:
    read: set[str] = set()

    class Watched(type(system)):  # type: ignore[misc]  # the class is known only at run time
        def __getattribute__(self, name: str) -> Any:
            read.add(name)
            return super().__getattribute__(name)

    watched = Watched(**{field.name: getattr(system, field.name) for field in fields(system)})
    read.clear()  # the constructor reads everything
    try:
        function(watched, start, [0.0, SHORT], **dict(accuracy))
    except Exception:  # an engine may refuse this motion or this class
        return ()
    if "__dict__" in read:
        return ()
    return tuple(
        name for name, either in NONLINEAR.items() if getattr(system, name) and not read & set(either)
    )
