"""Declared ranges of an engine, which limit the motions that it is asked for."""

from __future__ import annotations

import functools
import math
from collections.abc import Mapping
from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import ArrayLike

from compare.output.outside_text import one_of
from reference_model.systems import FloatArray, System, finite_number
from reference_model.systems.joint import AnySystem, FrictionJoint
from reference_model.trajectory import SimulationError

ROUNDING = 1e-9  # relative excess over a limit that is only rounding
ROUGH = 1e-6  # tolerance of the reference for the extent of a motion


@dataclass(frozen=True)
class Ranges:
    """Largest coordinate (m), speed (m/s) and time (s) of a motion, and smallest and largest mass (kg).

    Only the time limits a joint. Raises ``ValueError`` if a limit is not positive, or the masses do not increase.
    """

    coordinate: float = math.inf
    speed: float = math.inf
    time: float = math.inf
    mass: tuple[float, float] = (0.0, math.inf)

    @classmethod
    def of(cls, declared: Ranges | Mapping[str, object]) -> Ranges:
        """Return the ranges of a mapping with the names above as keys; raise ``ValueError`` if it is invalid."""
        if isinstance(declared, Ranges):
            return declared
        if not isinstance(declared, Mapping):
            raise TypeError(f"ranges = {declared!r}: expected a mapping such as {{'coordinate': 20.0}}")
        found: dict[str, object] = {}
        for name, limit in declared.items():
            one_of("range", name, [field.name for field in fields(cls)])
            if name == "mass":
                if not isinstance(limit, list | tuple) or len(limit) != len(cls.mass):
                    raise ValueError(
                        f"ranges: mass = {limit!r}: expected the smallest and the largest mass in kg"
                    )
                found[name] = tuple(finite_number(name, one) for one in limit)
            else:
                found[name] = finite_number(name, limit)
        return cls(**found)  # type: ignore[arg-type]

    def __post_init__(self) -> None:
        for name in ("coordinate", "speed", "time"):
            if getattr(self, name) <= 0.0:
                raise ValueError(f"ranges: {name} = {getattr(self, name):g}: it must be > 0")
        if not 0.0 <= self.mass[0] < self.mass[1]:
            raise ValueError(
                f"ranges: mass = {self.mass[0]:g}, {self.mass[1]:g} kg: they must be >= 0 and increase"
            )

    def excess(self, system: AnySystem, initial_state: ArrayLike, times: ArrayLike) -> str:
        """Return how the exact motion leaves the ranges, in words, or ""."""
        if self == EVERYWHERE:
            return ""
        state, asked = np.asarray(initial_state, dtype=float), np.asarray(times, dtype=float)
        latest = float(np.max(np.abs(asked)))
        if latest > self.time * (1.0 + ROUNDING):
            return f"times up to {self.time:g} s, not {latest:g} s"
        if isinstance(system, FrictionJoint):
            return ""
        if not self.mass[0] <= system.mass <= self.mass[1]:
            return f"masses from {self.mass[0]:g} to {self.mass[1]:g} kg, not {system.mass:g} kg"
        if math.isinf(self.coordinate) and math.isinf(self.speed):
            return ""
        farthest, fastest = _extent(system, tuple(state.tolist()), tuple(asked.tolist()))
        if farthest > self.coordinate * (1.0 + ROUNDING):
            return f"coordinates up to {self.coordinate:g} m, not {farthest:.3g} m"
        if fastest > self.speed * (1.0 + ROUNDING):
            return f"speeds up to {self.speed:g} m/s, not {fastest:.3g} m/s"
        return ""


EVERYWHERE = Ranges()
"""The ranges of an engine without declared ranges."""


@functools.lru_cache(maxsize=512)  # each motion is requested at several tolerances
def _extent(
    system: System, initial_state: tuple[float, ...], times: tuple[float, ...]
) -> tuple[float, float]:
    """Return the largest distance from the origin in m and speed in m/s at the ``times``."""
    import reference_model

    try:
        states = reference_model.simulate(system, initial_state, times, tolerance=ROUGH).states
    except SimulationError:
        states = np.array([initial_state])
    half = states.shape[1] // 2
    return _longest(states[:, :2]), _longest(states[:, half : half + 2])


def _longest(vectors: FloatArray) -> float:
    return float(np.max(np.hypot(*vectors.T)))
