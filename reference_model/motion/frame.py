"""Scaled unknowns relative to the master disc."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from reference_model.motion.nondimensional import Units
from reference_model.systems import DiscOnDisc, FloatArray, System


@dataclass(frozen=True)
class Frame:
    """Conversion between states in SI units and scaled unknowns relative to the master disc.

    ``lengths`` are the units of x, y (m) and the angle (rad), ``speeds`` those of the relative velocities; for φ̇ − ω
    the unit of r = κ(φ̇ − ω) in rad/s.
    """

    disc_speed: float
    lengths: FloatArray
    speeds: FloatArray

    @classmethod
    def of(cls, system: System, unit: Units) -> Frame:
        lengths, speeds = [unit.length] * 2, [unit.speed] * 2
        if isinstance(system, DiscOnDisc):
            lengths.append(1.0)
            speeds.append(unit.speed / math.sqrt(system.polar_inertia / system.mass))
        return cls(system.disc_speed, np.array(lengths), np.array(speeds))

    def unknowns(self, state: FloatArray) -> list[float]:
        """Return the unknowns; a body that moves with the master disc to rounding error is treated as sticking."""
        place, velocity = np.split(state, 2)
        carried = self._carried(place)
        relative = velocity - carried
        rounding = 4.0 * np.finfo(float).eps
        if math.hypot(*relative[:2]) <= rounding * math.hypot(*carried[:2]):
            relative[:2] = 0.0
        if np.all(abs(relative[2:]) <= rounding * abs(self.disc_speed)):
            relative[2:] = 0.0
        return [*(place / self.lengths).tolist(), *(relative / self.speeds).tolist()]

    def states(self, unknowns: FloatArray) -> FloatArray:
        place, relative = np.split(unknowns, 2, axis=-1)
        place = place * self.lengths
        return np.concatenate((place, relative * self.speeds + self._carried(place)), axis=-1)

    def _carried(self, place: FloatArray) -> FloatArray:
        result = np.full_like(place, self.disc_speed)
        result[..., 0] = -self.disc_speed * place[..., 1]
        result[..., 1] = self.disc_speed * place[..., 0]
        return result
