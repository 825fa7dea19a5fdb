"""An assembled model with the sensors of its body."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

IN_MEMORY: dict[str, Any] = {"storeInternal": True, "writeToFile": False}
"""Options of a sensor that stores its values for ``mbs.GetSensorStoredData`` and writes no file."""


@dataclass(frozen=True)
class Model:
    """An assembled model of a system, with sensors for the state of one body.

    Parameters
    ----------
    container, mbs : SystemContainer, MainSystem
        ``container`` owns ``mbs`` and must live as long.
    first, size : int
        The body's coordinates in the state are the coordinates first, ..., first + size − 1 of ``mbs``.
    sensors : tuple
        Sensors for the coordinates of the body's node and their first and second time derivatives at every step.

    """

    container: Any
    mbs: Any
    first: int
    size: int
    sensors: tuple[Any, Any, Any]
