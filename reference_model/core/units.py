"""Units that make a motion of order 1, and unknowns in these units relative to the master disc."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from reference_model.support import Support
from reference_model.systems import DiscOnDisc, FloatArray, System


@dataclass(frozen=True)
class Units:
    """Units of length in m and of time in s."""

    length: float
    time: float

    @property
    def speed(self) -> float:
        """Unit of speed in m/s."""
        return self.length / self.time

    @classmethod
    def of(cls, system: System, state: FloatArray) -> Units:
        """Return the units for the motion of ``system`` from ``state``.

        The faster of springs and master disc scales time, otherwise the dampers or the decay of slip. The motion of
        the centre scales length, because a fast spin must not hide it. Hardening and a stop shorten both units by the
        same factor if the motion may reach them.
        """
        velocities = system.state_size // 2
        friction = system.friction_force / system.mass
        speed = math.hypot(*state[velocities : velocities + 2])
        slip = speed
        decay = system.damping / system.mass
        if isinstance(system, DiscOnDisc):
            gyration = math.sqrt(system.polar_inertia / system.mass)
            slip = math.hypot(speed, gyration * (state[5] - system.disc_speed))
            decay = max(decay, system.shaft_damping / system.polar_inertia)
        rate = max(system.natural_frequency, abs(system.disc_speed)) or decay
        place = max(math.hypot(*state[:2]), abs(system.offset))
        support = Support.of(system).scaled(1.0 / system.mass)
        hard = 0.0
        if not support.linear:
            # The largest deflection that the speed or friction can cause.
            reach = max(place, support.circle(speed**2), support.deflection(friction))
            hard = math.sqrt(support.tangent(reach)) if reach < math.inf else 0.0
        if rate == 0.0:
            rate = hard or (friction / slip if friction > 0.0 < slip else 1.0)
        length = max(place, speed / rate, friction / rate**2)
        faster = max(hard / rate, 1.0)
        return cls((length if length > 0.0 else 1.0) / faster, 1.0 / (faster * rate))

    def springs(self, system: System) -> float:
        """Return the natural frequency of linear springs in these units; else 1."""
        if system.stiffness == 0.0 or not Support.of(system).linear:
            return 1.0
        return system.natural_frequency * self.time


@dataclass(frozen=True)
class Frame:
    """Conversion between states in SI units and scaled unknowns relative to the master disc.

    ``lengths`` are the units of x, y (m) and the angle (rad), ``speeds`` the units of the relative velocities; for φ̇
    − ω the unit of r = κ(φ̇ − ω) in rad/s.
    """

    disc_speed: float
    lengths: FloatArray
    speeds: FloatArray

    @classmethod
    def of(cls, system: System, unit: Units) -> Frame:
        """Return the conversion for these units."""
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
        """Return states in SI units, shape (..., 4 or 6)."""
        place, relative = np.split(unknowns, 2, axis=-1)
        place = place * self.lengths
        return np.concatenate((place, relative * self.speeds + self._carried(place)), axis=-1)

    def _carried(self, place: FloatArray) -> FloatArray:
        result = np.full_like(place, self.disc_speed)
        result[..., 0] = -self.disc_speed * place[..., 1]
        result[..., 1] = self.disc_speed * place[..., 0]
        return result
