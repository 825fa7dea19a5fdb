"""Settings of the plain engine that can be wrong, and the parameters of the system."""

from __future__ import annotations

from typing import NamedTuple

from reference_model.systems import DiscOnDisc, System


class Make(NamedTuple):
    """Settings of the engine; each default is right, and any other value is one mistake.

    Parameters
    ----------
    friction : float
        Factor of the friction force and moment; a negative factor accelerates the slip.
    slip_width : float
        Lower limit of ε in m/s, for any tolerance.
    creep_speed : float
        Slip speed in m/s of full friction during stick, if larger than ε.
    static_ratio : float
        Holding force of friction during stick, over μN.
    release_delay : float
        Delay of the release in s.
    release_late : float
        Delay of the release relative to the duration of stick.
    weakening : float
        Relative loss of the friction force per 1 m/s of slip speed.
    stronger_beside : float
        Relative gain of the friction force at |y| > x.
    sides, circumscribed, first_side : int, bool, float
        Number of sides of the polygon that replaces the friction circle (0: circle), True if it encloses the circle,
        and direction in rad of the middle of its first side.
    relative : float
        1 for friction against the velocity relative to the master disc, 0 against the absolute velocity.
    about_anchor : bool
        True to compute the velocity of the master disc about the point of relaxed springs.
    spin_in_slip : float
        Factor of the spin in the slip of a contact on a circle.
    moment : float
        Factor of the moment of friction.
    moment_of_slip : float
        Factor of the moment of a ring whose centre slips faster than its rim.
    uncoupled : bool
        True if friction resists slip and spin of a ring independently.
    points_turn : float
        Factor of the disc's angle in the angle of its contact points.
    points_lag : float
        Delay in s of the points' directions behind the disc's angle.
    damping_on_slip : bool
        True if the dampers act on the velocity relative to the master disc.
    anchor : complex
        Direction of the offset.
    anchor_turns : bool
        True if the springs turn with the master disc.
    stiffer_in_y : float
        Relative excess of the stiffness in y.
    hardening_power : float
        Exponent of the deflection in the hardening force.
    stop_pulls : bool
        True if the stop also acts within its gap.
    stop_on_one_side : bool
        True if the stop is missing at deflections of negative x.
    coriolis : float
        Factor of 2ρ̇ψ̇ in the tangential acceleration.
    energy_gain : float
        Relative energy gain per cycle of a vibration at the natural frequency.
    order, step : int, float
        Order (1 or 4) and fixed step in s of an explicit method instead of LSODA (0).

    """

    friction: float = 1.0
    slip_width: float = 0.0
    creep_speed: float = 0.0
    static_ratio: float = 1.0
    release_delay: float = 0.0
    release_late: float = 0.0
    weakening: float = 0.0
    stronger_beside: float = 0.0
    sides: int = 0
    circumscribed: bool = False
    first_side: float = 0.0
    relative: float = 1.0
    about_anchor: bool = False
    spin_in_slip: float = 1.0
    moment: float = 1.0
    moment_of_slip: float = 1.0
    uncoupled: bool = False
    points_turn: float = 1.0
    points_lag: float = 0.0
    damping_on_slip: bool = False
    anchor: complex = 1.0 + 0.0j
    anchor_turns: bool = False
    stiffer_in_y: float = 0.0
    hardening_power: float = 2.0
    stop_pulls: bool = False
    stop_on_one_side: bool = False
    coriolis: float = 1.0
    energy_gain: float = 0.0
    order: int = 0
    step: float = 0.0


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
    def of(cls, system: System) -> Numbers:
        """Return the parameters of ``system``; a pin has the inertia 1 and no radius or shaft."""
        names = (
            "mass", "polar_inertia", "stiffness", "damping", "friction_force", "disc_speed", "offset", "hardening",
            "stop_gap", "stop_stiffness", "contact_radius", "shaft_damping", "shaft_speed",
        )  # fmt: skip
        values = (getattr(system, name, 1.0 if name == "polar_inertia" else 0.0) for name in names)
        points = (system.contact_points or 0) if isinstance(system, DiscOnDisc) else 1
        return cls(*values, points)


def steepest(numbers: Numbers) -> float:
    """Return the largest deceleration of slip by friction, in m/s²."""
    return numbers.friction * (1.0 / numbers.mass + numbers.radius**2 / numbers.inertia)
