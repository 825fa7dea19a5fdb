"""Units of length and time that make a motion of order one."""

from __future__ import annotations

import math
from dataclasses import dataclass

from reference_model.motion.disc_equations import DiscMotion
from reference_model.motion.pin_equations import SlipMotion
from reference_model.support import Support
from reference_model.systems import DiscOnDisc, FloatArray, System


@dataclass(frozen=True)
class Units:
    """Units of length in m and of time in s."""

    length: float
    time: float

    @property
    def speed(self) -> float:
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

    def of_pin(self, motion: SlipMotion) -> SlipMotion:
        return SlipMotion(
            damping=motion.damping * self.time,
            support=motion.support.scaled(self.time**2, self.length),
            friction=motion.friction * self.time**2 / self.length,
            disc_speed=motion.disc_speed * self.time,
        )

    def of_disc(self, motion: DiscMotion) -> DiscMotion:
        return DiscMotion(
            centre=self.of_pin(motion.centre),
            gyration=motion.gyration / self.length,
            shaft_rate=motion.shaft_rate * self.time,
            lag=motion.lag / self.speed,
            contact=motion.contact,
            length=motion.length * self.length,
        )
