"""What a sweep varies and what it finds: names, units, symbols."""

from __future__ import annotations

from dataclasses import fields
from typing import NamedTuple

from reference_model.systems import COLUMNS, System

_PARAMETERS = {
    "mass": ("m", "kg"),
    "polar_inertia": ("J", "kg m²"),
    "stiffness": ("C", "N/m"),
    "damping": (r"\beta", "N s/m"),
    "friction_force": (r"\mu N", "N"),
    "disc_speed": (r"\omega", "rad/s"),
    "offset": ("X_0", "m"),
    "contact_radius": ("R", "m"),
    "shaft_damping": ("b", "N m s/rad"),
    "shaft_speed": (r"\Omega", "rad/s"),
}
_COMPONENTS = {
    "x": "x",
    "y": "y",
    "angle": r"\varphi",
    "vx": r"\dot x",
    "vy": r"\dot y",
    "spin": r"\dot\varphi",
}


class Result(NamedTuple):
    """A number that is known of every trajectory: how it is stored, its unit, and what it is."""

    dtype: str
    unit: str
    meaning: str


RESULTS = {
    "end": Result("u1", "", "what the trajectory ends as"),
    "time": Result("f8", "s", "when the end was certain, or the duration"),
    "states": Result("f8", "", "state at that time"),
    "least_radius": Result("f8", "m", "least distance from the axis in the end state"),
    "largest_radius": Result("f8", "m", "largest distance from the axis in the end state"),
    "slip_power": Result("f8", "W", "mean power of friction in the end state"),
    "steps": Result("i8", "", "steps of the integrator"),
}
"""As :class:`reference_model.ensemble.Ensemble` calls them."""


def components(system: System) -> dict[str, str]:
    """Return the components of the state at time 0 with their units."""
    return dict(COLUMNS[type(system)])


def parameters(system: System) -> dict[str, str]:
    """Return the parameters that can be swept with their units."""
    return {field.name: _PARAMETERS[field.name][1] for field in fields(system) if field.name in _PARAMETERS}


def units(system: System) -> dict[str, str]:
    """Return the units of all that can be swept."""
    return components(system) | parameters(system)


def symbol(name: str) -> str:
    """Return the paper's symbol, for a figure."""
    return _COMPONENTS[name] if name in _COMPONENTS else _PARAMETERS[name][0]
