"""Names, units and symbols of a sweep's quantities and results, and the axes of its planes."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass, fields
from typing import NamedTuple

import numpy as np

from compare.engines import one_of
from reference_model.systems import COLUMNS, FloatArray, System, number_in_text

# --- Names, units and symbols

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
    """A result of each trajectory: data type, unit and meaning."""

    dtype: str
    unit: str
    meaning: str


RESULTS = {
    "end": Result("u1", "", "end of the trajectory"),
    "time": Result("f8", "s", "time at which the end was certain, or the duration"),
    "states": Result("f8", "", "state at that time"),
    "least_radius": Result("f8", "m", "least distance from the axis in the end state"),
    "largest_radius": Result("f8", "m", "largest distance from the axis in the end state"),
    "slip_power": Result("f8", "W", "mean power of friction in the end state"),
    "steps": Result("i8", "", "steps of the integrator"),
}
"""Results of a trajectory, named as in :class:`reference_model.ensemble.Ensemble`."""


def components(system: System) -> dict[str, str]:
    """Return the components of the initial state with units."""
    return dict(COLUMNS[type(system)])


def parameters(system: System) -> dict[str, str]:
    """Return the parameters that can be swept with units."""
    return {field.name: _PARAMETERS[field.name][1] for field in fields(system) if field.name in _PARAMETERS}


def units(system: System) -> dict[str, str]:
    """Return the units of all quantities that can be swept."""
    return components(system) | parameters(system)


def symbol(name: str) -> str:
    """Return the paper's symbol, in LaTeX."""
    return _COMPONENTS[name] if name in _COMPONENTS else _PARAMETERS[name][0]


# --- Axes

MOST_POINTS = 100_000


@dataclass(frozen=True)
class Axis:
    """Equally spaced values of a component of the state or of a parameter, in its SI unit.

    Raises ``ValueError`` unless low < high are finite and ``points`` lies between 2 and 100,000.
    """

    name: str
    low: float
    high: float
    points: int

    def __post_init__(self) -> None:
        if not self.low < self.high:
            raise ValueError(
                f"axis {self.name} from {self.low:g} to {self.high:g}: the lower end must be less than the upper end"
            )
        if not math.isfinite(self.high - self.low):
            raise ValueError(f"axis {self.name} from {self.low:g} to {self.high:g}: the range must be finite")
        if not 2 <= self.points <= MOST_POINTS:
            raise ValueError(f"axis {self.name} with {self.points} points: it must have 2 to {MOST_POINTS}")

    @classmethod
    def parse(cls, text: str, kind: str, names: Iterable[str]) -> Axis:
        """Return the axis of a text "NAME=LOW:HIGH:POINTS"; raise ``ValueError`` for any other text.

        ``names`` are the allowed names; ``kind`` describes them in the message.
        """
        name, _, numbers = text.partition("=")
        parts = numbers.split(":")
        if len(parts) != 3:
            raise ValueError(f"axis {text!r}: write it as NAME=LOW:HIGH:POINTS")
        name = one_of(kind, name.strip(), names)
        low, high = (number_in_text(name, part) for part in parts[:2])
        points = number_in_text(name, parts[2])
        if not points.is_integer():
            raise ValueError(f"axis {text!r}: the number of points must be a whole number")
        return cls(name, low, high, int(points))

    @property
    def values(self) -> FloatArray:
        """All values, shape (points,)."""
        return np.linspace(self.low, self.high, self.points)
