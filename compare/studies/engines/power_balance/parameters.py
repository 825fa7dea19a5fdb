"""Motions of every kind that the balance is made for."""

from __future__ import annotations

from dataclasses import dataclass, replace

from compare.claims.error_estimates import WORKING
from compare.claims.paper_parameters import CENTRED, FIG4, FIG5, FIG5_STARTS, FIG11
from reference_model import sticking_radius
from reference_model.formulas.pin import whirl_radius
from reference_model.systems import System

SAMPLE_DISTANCE = 0.02
"""In s: close enough that the balance's quadrature through stick phases is good to 1e-9."""

RESOLUTION = 1e-8
"""Of the energy that is turned over."""


@dataclass(frozen=True)
class Motion:
    """A kind of motion.

    Parameters
    ----------
    system, start, source
        Parameters, the state at the start, and where they come from.
    until, step : float
        Length and distance of samples in s.
    tolerance : float
        At which it is measured.
    drawn : bool
        Whether the figure shows it.
    contact_alone : bool
        Whether it is asked of an engine of which only the contact is its own, see ``Engine.contact_only``.

    """

    system: System
    start: tuple[float, ...]
    until: float
    source: str
    tolerance: float = WORKING
    step: float = SAMPLE_DISTANCE
    drawn: bool = False
    contact_alone: bool = False


def all_motions() -> dict[str, Motion]:
    """Return the motions by the words in which the claims name them."""
    return motions_of_the_pin() | motions_of_the_disc()


def motions_of_the_pin() -> dict[str, Motion]:
    """Return the motions of a pin."""
    radius = whirl_radius(CENTRED)
    sticky = FIG4
    stuck = 0.98 * sticking_radius(sticky)
    turning = sticky.disc_speed
    return {
        "the way to the equilibrium, with stick phases": Motion(
            FIG5, FIG5_STARTS["equilibrium"], 100.0, "Fig. 5"
        ),
        "the way to the whirl, with stick phases": Motion(
            FIG5, FIG5_STARTS["whirl"], 400.0, "Fig. 5", tolerance=2.0 * WORKING, drawn=True
        ),
        "a whirl that settles": Motion(
            CENTRED,
            (0.8 * radius, 0.0, 0.0, radius),
            100.0,
            "Fig. 4 with X0 = 0, started 20 % inside the whirl",
        ),
        "a pin that sticks all the time": Motion(
            # It turns over little energy, against which a smoothed law's creep must be small.
            sticky,
            (stuck, 0.0, 0.0, turning * stuck),
            10.0,
            "Fig. 4, at 0.98 of the radius (9)",
            tolerance=WORKING / 20,
        ),
        "a pin on a resting disc": Motion(
            replace(FIG4, disc_speed=0.0), (0.8, 0.3, -0.2, 0.5), 40.0, "Fig. 4 with ω = 0, start by choice"
        ),
        "a disc that turns the other way": Motion(
            replace(FIG4, disc_speed=-FIG4.disc_speed),
            (0.5, 0.2, 0.0, -0.3),
            100.0,
            "Fig. 4 with −ω, start by choice",
        ),
    }


def motions_of_the_disc() -> dict[str, Motion]:
    """Return the motions of a friction disc, on the continuous ring and on six points."""
    near_axis, thrown = (0.02, 0.0, 0.0, 0.0, 0.0, 1.3), (0.0, 0.0, 0.0, 0.5, 0.2, 3.0)
    sticky = replace(FIG11, friction_force=0.1)
    table = replace(
        FIG11,
        stiffness=0.0,
        damping=0.0,
        shaft_damping=0.0,
        disc_speed=0.0,
        friction_force=0.1,
        polar_inertia=FIG11.mass * FIG11.contact_radius**2,
    )
    on_table = "nothing but friction on a disc at rest, μN = 0.1 N, J = mR², start by choice"
    return {
        "a disc on its way to the modulated cycle": Motion(
            FIG11, near_axis, 100.0, "Fig. 11 with X0 = 0, start by choice"
        ),
        "a disc on six points": Motion(
            replace(FIG11, contact_points=6), near_axis, 40.0, "Fig. 11 with X0 = 0, start by choice"
        ),
        "a disc with an offset, turning the other way": Motion(
            replace(FIG11, disc_speed=-FIG11.disc_speed, shaft_speed=-FIG11.shaft_speed, offset=0.02),
            (0.02, 0.0, 0.0, 0.0, 0.0, -1.3),
            40.0,
            "Fig. 11 with −ω, −Ω and X0 = 0.02 m, start by choice",
        ),
        "a disc that sticks all the time": Motion(
            sticky,
            (0.05, 0.0, 0.0, 0.0, 0.05 * sticky.disc_speed, sticky.disc_speed),
            2.0,
            "Fig. 11, μN = 0.1 N",
        ),
        "a ring thrown on a table, to rest": Motion(table, thrown, 10.0, on_table),
        "six points thrown on a table, to rest": Motion(
            # One of the points rests before the others, where the quadrature is worse.
            replace(table, contact_points=6),
            thrown,
            10.0,
            on_table,
            step=0.1 * SAMPLE_DISTANCE,
            contact_alone=True,
        ),
    }
