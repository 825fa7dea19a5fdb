"""Exudyn's items, and functions that add frequently used items."""

from collections.abc import Callable, Sequence
from functools import wraps
from typing import Any

import exudyn as exu
import exudyn.itemInterface

items: Any = exudyn.itemInterface  # its type hints reject valid calls

CURRENT = exu.ConfigurationType.Current

IN_MEMORY: dict[str, Any] = {"storeInternal": True, "writeToFile": False}
"""Options of a sensor that stores its values in memory only."""


_AT_ASSEMBLY = "called at assembly"

_models: Any = exu.MainSystem
_assemble = _models.Assemble


# Exudyn has no hook for assembly, so its method is wrapped.
@wraps(_assemble)
def _call_and_assemble(mbs: Any) -> None:
    for function in mbs.sys.get(_AT_ASSEMBLY, ()):
        function()
    _assemble(mbs)


_models.Assemble = _call_and_assemble


def at_assembly(mbs: Any, function: Callable[[], None]) -> None:
    """Call ``function`` before each ``mbs.Assemble``, which may renumber coordinates."""
    mbs.sys.setdefault(_AT_ASSEMBLY, []).append(function)


def add_rotor(mbs: Any, inertia: float, speed: float, angle: float = 0.0) -> Any:
    """Add a rotor (inertia in kg m²) on the global z-axis; return its ``NodeIndex``."""
    node = mbs.AddNode(
        items.Node1D(referenceCoordinates=[0.0], initialCoordinates=[angle], initialVelocities=[speed])
    )
    mbs.AddObject(items.ObjectRotationalMass1D(nodeNumber=node, inertia=inertia))
    return node


def coordinate_marker(mbs: Any, node: Any, coordinate: int = 0) -> Any:
    """Add a marker of a coordinate of a node; None is the ground."""
    node = mbs.AddNode(items.NodePointGround()) if node is None else node
    return mbs.AddMarker(items.MarkerNodeCoordinate(nodeNumber=node, coordinate=coordinate))


def node_sensor(mbs: Any, node: Any, variable: Any, **options: Any) -> Any:
    """Add a sensor of a node."""
    return mbs.AddSensor(
        items.SensorNode(nodeNumber=node, outputVariableType=variable, **IN_MEMORY | options)
    )


def add_integrals(mbs: Any, rates: Callable[..., list[float]], start: Sequence[float], name: str = "") -> Any:
    """Add first-order coordinates with the user function ``rates``; return their ``NodeIndex``."""
    node = mbs.AddNode(
        items.NodeGenericODE1(
            name=name,
            referenceCoordinates=[0.0] * len(start),
            initialCoordinates=list(start),
            numberOfODE1Coordinates=len(start),
        )
    )
    mbs.AddObject(items.ObjectGenericODE1(nodeNumbers=[node], rhsUserFunction=rates))
    return node
