"""Settings of the plain engine that can be wrong, and the parameters of the system."""

from __future__ import annotations

from typing import NamedTuple

from reference_model.systems import DiscOnDisc


class Make(NamedTuple):
    """Settings of the engine; each default is right, and any other value is one mistake."""

    friction: float = 1.0  # factor of friction; a negative one accelerates the slip
    creep_speed: float = 0.0  # slip speed in m/s of full friction during stick, if larger than ε
    static_ratio: float = 1.0  # holding force of friction during stick, divided by μN
    release_delay: float = 0.0  # in s
    release_late: float = 0.0  # relative to the duration of stick
    weakening: float = 0.0  # relative loss of the friction force per 1 m/s of slip speed
    stronger_beside: float = 0.0  # relative gain of the friction force at |y| > x
    sides: int = 0  # of the polygon around the friction circle that replaces it; 0 for the circle
    relative: float = 1.0  # 1 for friction against the relative velocity, 0 against the absolute one
    about_anchor: bool = False  # whether the master disc turns about the point of relaxed springs
    moment: float = 1.0  # factor of the moment of friction
    moment_of_slip: float = 1.0  # factor of the moment of a ring whose centre slips faster than its rim
    uncoupled: bool = False  # whether friction resists slip and spin of a ring independently
    points_lag: float = 0.0  # delay in s of the points' directions behind the disc's angle
    damping_on_slip: bool = False  # whether dampers act on the velocity relative to the master disc
    anchor_turns: bool = False  # whether the springs turn with the master disc
    stiffer_in_y: float = 0.0  # relative excess of the stiffness in y
    hardening_power: float = 2.0  # exponent of the deflection in the hardening force
    stop_pulls: bool = False  # whether the stop also acts within its gap
    stop_on_one_side: bool = False  # whether the stop is missing at deflections of negative x
    coriolis: float = 1.0  # factor of 2ρ̇ψ̇ in the tangential acceleration
    energy_gain: float = 0.0  # relative energy gain per cycle of a vibration at the natural frequency
    order: int = 0  # 1 or 4 of an explicit method instead of LSODA (0)
    step: float = 0.0  # fixed step in s of the explicit method


RIGHT = Make()


class Numbers(NamedTuple):
    """Parameters of a system; ``points`` is 0 for the continuous ring and 1 for a pin, whose radius is 0."""

    mass: float
    inertia: float
    stiffness: float
    damping: float
    friction: float
    omega: float
    offset: float
    hardening: float
    stop_gap: float
    stop_stiffness: float
    radius: float
    shaft_damping: float
    shaft_speed: float
    points: int

    @classmethod
    def of(cls, system):
        """Return the parameters of ``system``; a pin has the inertia 1 and no radius or shaft."""
        names = (
            "mass", "polar_inertia", "stiffness", "damping", "friction_force", "disc_speed", "offset", "hardening",
            "stop_gap", "stop_stiffness", "contact_radius", "shaft_damping", "shaft_speed",
        )  # fmt: skip
        values = (getattr(system, name, 1.0 if name == "polar_inertia" else 0.0) for name in names)
        points = (system.contact_points or 0) if isinstance(system, DiscOnDisc) else 1
        return cls(*values, points)


def steepest(numbers):
    """Return the largest deceleration of slip by friction, in m/s²."""
    return numbers.friction * (1.0 / numbers.mass + numbers.radius**2 / numbers.inertia)
