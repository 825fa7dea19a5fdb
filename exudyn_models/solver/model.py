"""An assembled model, as a run takes it, and what its sensors keep."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

IN_MEMORY: dict[str, Any] = {"storeInternal": True, "writeToFile": False}
"""Options of a sensor that keeps its values for ``mbs.GetSensorStoredData`` and writes no file."""


@dataclass(frozen=True)
class Model:
    """An assembled model of a system, of which the state of one body is recorded.

    Parameters
    ----------
    container, mbs : SystemContainer, MainSystem
        ``container`` owns ``mbs`` and must live as long.
    first, size : int
        The body's coordinates that belong to the state: ``mbs``'s coordinates first, ..., first + size − 1.
    sensors : tuple
        They store the coordinates of the body's node and their first and second time derivatives at every step.

    """

    container: Any
    mbs: Any
    first: int
    size: int
    sensors: tuple[Any, Any, Any]
