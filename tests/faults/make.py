"""What the plain engine is made of: the parts that can be wrong, and the numbers of the system."""

from __future__ import annotations

from typing import NamedTuple

from reference_model.systems import DiscOnDisc, System


class Make(NamedTuple):
    """How the engine is made: each default is right, and each other value is one mistake.

    Parameters
    ----------
    friction : float
        Factor of the friction force and of its moment; along the slip where it is negative.
    slip_width : float
        ε in m/s is no smaller than this, whatever the tolerance.
    creep_speed : float
        Slip speed in m/s at which friction is full in stick, if that is more than ε.
    static_ratio : float
        What friction in stick can hold, over μN.
    release_delay : float
        Time in s by which stick goes on when friction can no longer hold.
    release_late : float
        Share of its time by which stick goes on when friction can no longer hold.
    weakening : float
        Share of the friction force that is lost by 1 m/s of slip speed.
    stronger_beside : float
        Share by which friction is stronger where |y| > x.
    sides, circumscribed, first_side : int, bool, float
        Number of sides of the polygon that bounds the friction force in place of the circle (0), whether it lies
        around the circle or inside, and the direction in rad of the middle of its first side.
    relative : float
        1 for friction against the velocity relative to the master disc, 0 against that of the body.
    about_anchor : bool
        Whether the velocity of the master disc is reckoned from the point at which the springs are relaxed.
    spin_in_slip : float
        Share of the spin that the slip of a contact on a circle takes part in.
    moment : float
        Factor of the moment of friction.
    moment_of_slip : float
        Factor of the moment of a ring whose centre slips faster than its rim.
    uncoupled : bool
        Whether slip and spin of a ring are resisted each as if the other were not there.
    points_turn : float
        Share of its angle by which the contact of a disc turns with it.
    points_lag : float
        Time in s by which the points' directions are behind the disc's angle.
    damping_on_slip : bool
        Whether the dampers act against the velocity relative to the master disc.
    anchor : complex
        Direction in which the offset lies.
    anchor_turns : bool
        Whether the springs turn with the master disc.
    stiffer_in_y : float
        Share by which the spring of the y axis is stiffer.
    hardening_power : float
        Of the deflection, to which the hardening is proportional.
    stop_pulls : bool
        Whether the stop acts inside of its gap too.
    stop_on_one_side : bool
        Whether there is no stop at deflections of negative x.
    coriolis : float
        Share of 2ρ̇ψ̇ in the tangential acceleration.
    energy_gain : float
        Share of its energy that a vibration at the natural frequency gains in a cycle.
    order, step : int, float
        Fixed step in s of an explicit method of order 1 or 4 in place of LSODA (0).

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
    """The parameters of a system; ``points`` is 0 for the continuous ring and 1 for a pin, whose radius is 0."""

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
        """Return those of ``system``."""
        disc = system if isinstance(system, DiscOnDisc) else None
        return cls(
            system.mass,
            disc.polar_inertia if disc else 1.0,
            system.stiffness,
            system.damping,
            system.friction_force,
            system.disc_speed,
            system.offset,
            system.hardening,
            system.stop_gap,
            system.stop_stiffness,
            disc.contact_radius if disc else 0.0,
            disc.shaft_damping if disc else 0.0,
            disc.shaft_speed if disc else 0.0,
            (disc.contact_points or 0) if disc else 1,
        )


def steepest(numbers: Numbers) -> float:
    """Return the greatest deceleration of slip by friction, in m/s²."""
    return numbers.friction * (1.0 / numbers.mass + numbers.radius**2 / numbers.inertia)
