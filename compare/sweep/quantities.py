"""What a sweep varies and what it finds: names, units, symbols, and the axes of a plane."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass, fields
from typing import NamedTuple

import numpy as np

from compare.engines import one_of
from reference_model.systems import COLUMNS, FloatArray, System, finite_number

# --- What a sweep varies and what it finds: names, units, symbols.

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


# --- Axes of a plane: a name, a range, and how many values.

MOST_POINTS = 100_000


@dataclass(frozen=True)
class Axis:
    """Values of a component of the state or of a parameter at equal distances.

    Parameters
    ----------
    name : str
        The component or parameter.
    low, high : float
        Its first and last value, in its SI unit; low < high.
    points : int
        Number of values, from 2 to 100,000.

    Raises
    ------
    ValueError
        If the range is empty or not finite, or for another number of points.

    """

    name: str
    low: float
    high: float
    points: int

    def __post_init__(self) -> None:
        """Refuse what has no points."""
        if not self.low < self.high:
            raise ValueError(
                f"axis {self.name} from {self.low:g} to {self.high:g}: the lower end must be less than the upper end"
            )
        if not math.isfinite(self.high - self.low):
            raise ValueError(f"axis {self.name} from {self.low:g} to {self.high:g}: the range must be finite")
        if not 2 <= self.points <= MOST_POINTS:
            raise ValueError(f"axis {self.name} with {self.points} points: there must be 2 to {MOST_POINTS}")

    @classmethod
    def parse(cls, text: str, kind: str, names: Iterable[str]) -> Axis:
        """Return the axis that "NAME=LOW:HIGH:POINTS" says; raise ``ValueError`` for anything else.

        ``names`` are those that are allowed, ``kind`` says what they are.
        """
        name, _, numbers = text.partition("=")
        parts = numbers.split(":")
        if len(parts) != 3:
            raise ValueError(f"axis {text!r}: write it as NAME=LOW:HIGH:POINTS")
        name = one_of(kind, name.strip(), names)
        low, high = (finite_number(name, part) for part in parts[:2])
        try:
            points = int(parts[2])
        except ValueError:
            raise ValueError(f"axis {text!r}: the number of points must be a whole number") from None
        return cls(name, low, high, points)

    @property
    def values(self) -> FloatArray:
        """All values, shape (points,)."""
        return np.linspace(self.low, self.high, self.points)
