"""Units of length, time and mass that make a motion of order one, so tolerances do not depend on SI scales."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from exudyn_models.paper.scales import hardened_stiffness
from reference_model.systems import DiscOnDisc, FloatArray, System

RIM_SHARE = 1e-4
"""Smallest length in contact radii: rounding of the rim's speed, 1e-16·R·ω, must stay well below ε."""


@dataclass(frozen=True)
class Units:
    """Units of length in m, time in s and mass in kg."""

    length: float
    time: float
    mass: float

    @classmethod
    def of(cls, system: System, state: FloatArray) -> Units:
        """Return the units for the motion of ``system`` from ``state``, shape (4,) or (6,).

        Time is scaled by the faster of springs and master disc; without them by a stop, by the dampers, or by how
        fast friction stops the slip. Length is scaled by the position of the centre and the distances that its speed
        and friction cover in the unit of time, so a fast spin does not hide its motion.
        """
        velocities = system.state_size // 2
        push = system.friction_force / system.mass
        speed = math.hypot(*state[velocities : velocities + 2])
        place = max(math.hypot(*state[:2]), abs(system.offset))
        slip, decay, radius = speed, system.damping / system.mass, 0.0
        if isinstance(system, DiscOnDisc):
            radius = system.contact_radius
            slip = math.hypot(speed, radius * (state[5] - system.disc_speed))
            decay = max(decay, system.shaft_damping / system.polar_inertia)
        spring = math.sqrt(hardened_stiffness(system, state) / system.mass)
        rate = max(spring, abs(system.disc_speed)) or math.sqrt(system.stop_stiffness / system.mass) or decay
        if rate == 0.0:
            rate = push / slip if push > 0.0 < slip else 1.0
        length = max(place, speed / rate, push / rate**2, RIM_SHARE * radius)
        return cls(length if length > 0.0 else 1.0, 1.0 / rate, system.mass)

    @property
    def speed(self) -> float:
        """Unit of speed in m/s."""
        return self.length / self.time

    def of_system(self, system: System) -> System:
        """Return ``system`` in these units."""
        stiffness, damping = self.time**2 / self.mass, self.time / self.mass
        changes: dict[str, Any] = {
            "mass": system.mass / self.mass,
            "stiffness": stiffness * system.stiffness,
            "damping": damping * system.damping,
            "friction_force": stiffness / self.length * system.friction_force,
            "disc_speed": self.time * system.disc_speed,
            "offset": system.offset / self.length,
            "hardening": stiffness * self.length**2 * system.hardening,
            "stop_gap": system.stop_gap / self.length,
            "stop_stiffness": stiffness * system.stop_stiffness,
        }
        if isinstance(system, DiscOnDisc):
            changes |= {
                "polar_inertia": system.polar_inertia / self.mass / self.length**2,
                "contact_radius": system.contact_radius / self.length,
                "shaft_damping": damping / self.length**2 * system.shaft_damping,
                "shaft_speed": self.time * system.shaft_speed,
            }
        return replace(system, **changes)

    def of_states(self, size: int) -> FloatArray:
        """Return the units of the ``size`` components of a state."""
        places = [self.length, self.length, 1.0][: size // 2]
        return np.array([*places, *(place / self.time for place in places)])
