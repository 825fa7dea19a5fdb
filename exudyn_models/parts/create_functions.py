"""``mbs.CreateRingFriction``, ``mbs.CreateGear`` and so on: the parts as functions in Exudyn's style."""

import inspect
import re
from collections.abc import Callable
from typing import Any

import exudyn as exu

from exudyn_models.parts.radial_support import add_radial_support
from exudyn_models.parts.ring_friction import add_ring_friction
from exudyn_models.parts.rotational.gears import add_differential, add_gear, add_planetary
from exudyn_models.parts.rotational.one_way_clutch import add_one_way_clutch
from exudyn_models.parts.rotational.sliders import add_slider_friction, add_tyre
from exudyn_models.parts.rotational.torques import add_road_load, add_torque_converter
from exudyn_models.parts.rotational.torsional_spring import add_torsional_spring

PARTS: tuple[Callable[..., Any], ...] = (
    add_ring_friction,
    add_radial_support,
    add_gear,
    add_planetary,
    add_differential,
    add_one_way_clutch,
    add_torsional_spring,
    add_slider_friction,
    add_tyre,
    add_road_load,
    add_torque_converter,
)
"""Functions whose positional arguments are ``mbs`` and bodies."""


def _camel(name: str) -> str:
    return re.sub("_(.)", lambda match: match[1].upper(), name)


def _created(add: Callable[..., Any]) -> Callable[..., Any]:
    """Return a part as a method with ``bodyNumbers`` and the arguments of ``add`` in Exudyn's spelling."""
    mbs, *others = inspect.signature(add).parameters.values()
    bodies = [one.name for one in others if one.kind is one.POSITIONAL_OR_KEYWORD]
    options = {_camel(one.name): one for one in others if one.kind is one.KEYWORD_ONLY}

    def create(mbs: Any, bodyNumbers: Any, **given: Any) -> Any:
        if not isinstance(bodyNumbers, (list, tuple)) or len(bodyNumbers) != len(bodies):
            count = {1: "one body", 2: "two bodies", 3: "three bodies"}[len(bodies)]
            raise ValueError(
                f"bodyNumbers = {bodyNumbers!r}: it must be a list of {count}, {', '.join(bodies)}"
            )
        if unknown := [name for name in given if name not in options]:
            raise TypeError(f"{unknown[0]} is not an argument; these are {', '.join(options)}")
        return add(mbs, *bodyNumbers, **{options[name].name: value for name, value in given.items()})

    both = [mbs, mbs.replace(name="bodyNumbers")]
    both += [one.replace(name=name) for name, one in options.items()]
    create.__name__ = create.__qualname__ = _camel(f"create_{add.__name__.removeprefix('add_')}").replace(
        "c", "C", 1
    )
    create.__doc__ = (
        f"Add a part as ``{add.__name__}`` does, between the bodies {', '.join(bodies)}; return its handle.\n\n"
        "An Exudyn ground, or None, is at rest. Other arguments and errors are those of that function."
    )
    vars(create)["__signature__"] = inspect.Signature(both)
    return create


for _add in PARTS:
    _method = _created(_add)
    setattr(exu.MainSystem, _method.__name__, _method)
