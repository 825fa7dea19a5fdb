"""Units that make a motion of order 1, and the scales that determine the steps and tolerances of a run.

Tolerances therefore do not depend on SI units. The scales are in the units of ``system`` and ``state``.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from exudyn_models.forces.radial_springs import Law, elastic_energy, secant_stiffness
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


@dataclass(frozen=True)
class Scales:
    """Scales of a run.

    ``time`` is the result of ``time_scale``; ``motion``, in m and m/s, is the scale of DOPRI5's error: at least 1, or
    the size of the motion; ``angle_rounding`` the rounding error in rad of the angle of a disc; ``force`` > 0 the
    scale of Newton's residual, the smaller of forces in N and moments in N m.
    """

    time: float
    motion: float
    angle_rounding: float
    force: float

    @classmethod
    def of(cls, system: System, state: FloatArray, span: float) -> Scales:
        """Return the scales for the motion of ``system`` from ``state``, shape (4,) or (6,), over ``span`` (s)."""
        return cls(
            time_scale(system, state, span),
            _size_of_motion(system, state),
            _angle_rounding(system, state, span),
            _size_of_forces(system, state),
        )


def time_scale(system: System, state: FloatArray, span: float) -> float:
    """Return the time scale of the motion in s: the shortest of 1/k, 1/|ω|, m/β and ``span``.

    A disc adds its spin, the speed of its shaft, and J/b. For a hardening support k belongs to the largest deflection
    that the initial energy allows. A stop counts as touched.
    """
    stiffest = hardened_stiffness(system, state) + system.stop_stiffness
    rates = [math.sqrt(stiffest / system.mass), abs(system.disc_speed), system.damping / system.mass]
    if isinstance(system, DiscOnDisc):
        rates += [abs(system.shaft_speed), abs(state[5]), system.shaft_damping / system.polar_inertia]
    rate = max(rates)
    return min(1.0 / rate, span) if rate > 0.0 else span


def hardened_stiffness(system: System, state: FloatArray) -> float:
    """Return the largest stiffness in N/m that the springs reach with the initial energy."""
    # C·d²/2 + C₃·d⁴/4 = E gives C₃·d² = √(C² + 4·C₃·E) − C.
    root = math.sqrt(system.stiffness**2 + 4.0 * system.hardening * support_energy(system, state))
    return system.stiffness + 3.0 * (root - system.stiffness)


def support_energy(system: System, state: FloatArray) -> float:
    """Return the energy in J of the centre's motion and of its support."""
    position, velocity = (complex(*half[:2]) for half in state.reshape(2, -1).tolist())
    return system.mass * abs(velocity) ** 2 / 2.0 + elastic_energy(
        abs(position - system.offset) ** 2, _law_of(system)
    )


def _size_of_motion(system: System, state: FloatArray) -> float:
    """Return the largest of 1, distances in m and speeds in m/s.

    A disc adds its spin and the speeds of shaft and master, but not its angle, whose origin is arbitrary.
    """
    position, velocity = state.reshape(2, -1)
    sizes = [1.0, math.hypot(*position[:2]), abs(system.offset), math.hypot(*velocity[:2])]
    if isinstance(system, DiscOnDisc):
        sizes += [abs(velocity[2]), abs(system.disc_speed), abs(system.shaft_speed)]
    return float(max(sizes))


def _angle_rounding(system: System, state: FloatArray, span: float) -> float:
    if not isinstance(system, DiscOnDisc):
        return 0.0
    spin = max(abs(state[5]), abs(system.disc_speed), abs(system.shaft_speed))
    return float(np.spacing(abs(state[2]) + spin * span))


def _size_of_forces(system: System, state: FloatArray) -> float:
    position, velocity = state.reshape(2, -1)
    deflection = math.hypot(*position[:2]) + abs(system.offset)
    spring = secant_stiffness(deflection**2, _law_of(system)) * deflection
    force = system.friction_force + spring + system.damping * math.hypot(*velocity[:2])
    moment = 0.0
    if isinstance(system, DiscOnDisc):
        moment = system.friction_force * system.contact_radius + system.shaft_damping * abs(
            system.shaft_speed - velocity[2]
        )
    return float(min((size for size in (force, moment) if size > 0.0), default=system.mass))


def _law_of(system: System) -> Law:
    return (
        system.stiffness,
        system.hardening,
        system.stop_gap,
        system.stop_stiffness,
        system.damping,
    )
