"""Catalogue of sound engines, and of variants with one typical mistake of users or developers each."""

from __future__ import annotations

import functools
import math
from collections.abc import Callable
from typing import Any

from compare.engines import EVERY_KIND, Engine, reference
from faults.around_reference import (
    from_rest,
    half_a_pitch_on,
    in_single_precision,
    one_sample_late,
    output_late,
    phases_late,
    three_terms,
    with_angle_wrapped,
    with_output,
    with_relative_velocities,
    with_velocities_by_differences,
    without_centripetal_term,
    without_end,
)
from faults.fault import Fault
from faults.make import Make
from faults.plain import simulate as simulate_plainly
from faults.wrong_parameters import (
    disc_backwards,
    load_not_shared,
    off_by,
    one_point_too_few,
    stronger_at_extremes,
    weaker_backwards,
    with_parameters,
)
from reference_model.systems import FloatArray, System
from reference_model.trajectory import Trajectory

SOUND: tuple[Engine, ...] = (reference, Engine("plain", simulate_plainly, EVERY_KIND))
"""Engines to insert faults into. A claim that fails for one of them is itself wrong."""


def _fault(name: str, says: str, function: Any, kinds: tuple[str, ...] = EVERY_KIND) -> Fault:
    return Fault(name, says, Engine(name, function, kinds))


def made(name: str, says: str, kinds: tuple[str, ...] = EVERY_KIND, **make: Any) -> Fault:
    """Return the plain engine with one wrong part."""
    return _fault(name, says, functools.partial(simulate_plainly, make=Make(**make)), kinds)


def mistaken(name: str, says: str, change: Callable[[System], dict[str, Any]]) -> Fault:
    """Return the reference with wrong parameters."""
    return _fault(name, says, functools.partial(with_parameters, change))


def spoilt(name: str, says: str, change: Callable[[Trajectory], FloatArray]) -> Fault:
    """Return the reference with wrong output."""
    return _fault(name, says, functools.partial(with_output, change))


POINTS_ONLY = ("pin", "points")
"""Kinds of systems that a polygon applies to, as a law of single points."""

CORNERS = 1e-4
"""ε in m/s of polygons; a smaller one is too costly because motions follow the corners for a long time."""

FORCE: tuple[Fault, ...] = (
    made("friction-along-slip", "Friction acts along the slip, not against it.", friction=-1.0),
    made(
        "pyramid-of-8-sides",
        "Friction is bounded by an octagon inside of the circle.",
        POINTS_ONLY,
        sides=8,
        first_side=math.pi / 8.0,
        slip_width=CORNERS,
    ),
    made(
        "box-friction",
        "Friction of each axis is bounded by itself.",
        POINTS_ONLY,
        sides=4,
        circumscribed=True,
        slip_width=CORNERS,
    ),
    made(
        "absolute-velocity",
        "Friction acts against the velocity in space, not that over the disc.",
        relative=0.0,
    ),
    made(
        "disc-turns-about-anchor",
        "The disc below turns about the point where the springs are relaxed, not about its own axis.",
        about_anchor=True,
    ),
    made(
        "static-friction-higher", "What friction holds in stick is 20 % more than in slip.", static_ratio=1.2
    ),
    made("friction-falls-with-slip", "Friction is weaker by 1 % for each m/s of slip.", weakening=0.01),
    made(
        "regularised-10-times-too-wide",
        "Friction is viscous below 1e-4 m/s, whatever the tolerance.",
        slip_width=1e-4,
    ),
    made("creep-in-stick", "What sticks creeps with up to 1e-5 m/s.", creep_speed=1e-5),
    made("no-release", "Stick never ends.", release_delay=math.inf),
    made("release-late-by-1e-3", "Stick lasts 0.1 % too long.", release_late=1e-3),
    _fault(
        "no-centripetal-term-in-stick",
        "Stick goes on while friction holds springs and dampers, without the term mω²ρ of (7).",
        without_centripetal_term,
    ),
    made(
        "friction-stronger-beside",
        "Friction is stronger by 1e-5 of itself where |y| > x.",
        stronger_beside=1e-5,
    ),
    mistaken(
        "friction-stronger-at-extremes",
        "Friction is stronger by 1 % where |ω| is above 4 or below 0.3 rad/s.",
        stronger_at_extremes,
    ),
    mistaken(
        "friction-weaker-backwards", "Friction is weaker by 1e-4 of itself for ω < 0.", weaker_backwards
    ),
)

MOMENT: tuple[Fault, ...] = (
    made("moment-of-wrong-sign", "The moment of friction has the wrong sign.", moment=-1.0),
    made(
        "no-moment-of-eccentric-force",
        "The moment d × F of a force away from the centre is forgotten.",
        moment=0.0,
    ),
    made(
        "no-spin-in-slip",
        "The part ω × d of a contact's relative velocity is forgotten.",
        spin_in_slip=0.0,
    ),
    made("uncoupled-slip-and-spin", "Slip and spin of a ring are each resisted fully.", uncoupled=True),
    made(
        "points-do-not-turn",
        "The points of contact keep their directions while the disc turns.",
        points_turn=0.0,
    ),
    made("points-lag", "The points' directions are 1e-5 s behind the disc's angle.", points_lag=1e-5),
    made(
        "moment-larger-in-slip",
        "The moment of a ring is larger by 1e-4 of itself where its centre slips faster than its rim.",
        moment_of_slip=1.0 + 1e-4,
    ),
    _fault("points-half-a-pitch-on", "Point i is at φ + 2π(i + ½)/n.", half_a_pitch_on),
    _fault(
        "expansion-for-ring", "The ring's friction is that of three terms of an expansion (23).", three_terms
    ),
    mistaken("one-point-too-few", "A ring of n points has n − 1 of them.", one_point_too_few),
    mistaken("load-not-shared", "Each point carries all of the load.", load_not_shared),
)

SUPPORT: tuple[Fault, ...] = (
    made(
        "damping-on-slip",
        "The dampers act against the velocity relative to the disc below.",
        damping_on_slip=True,
    ),
    made("offset-of-wrong-sign", "The springs are relaxed at −X0.", anchor=-1.0 + 0.0j),
    made("springs-turn", "The springs turn with the disc below.", anchor_turns=True),
    made(
        "hardening-of-wrong-power",
        "The hardening is proportional to the deflection, not to its square.",
        hardening_power=1.0,
    ),
    made("stop-that-pulls", "The stop pulls while it is not touched.", stop_pulls=True),
    made("stop-on-one-side", "There is no stop at deflections of negative x.", stop_on_one_side=True),
    made("stiffer-in-y", "The spring of the y axis is stiffer by 1e-5 of itself.", stiffer_in_y=1e-5),
    mistaken("disc-backwards", "The disc below turns in the other sense.", disc_backwards),
)

NUMERICS: tuple[Fault, ...] = (
    made("no-coriolis", "The Coriolis term 2ρ̇ψ̇ of the polar form is forgotten.", coriolis=0.0),
    made("energy-creeps-in", "A vibration gains 1e-6 of its energy in a cycle.", energy_gain=1e-6),
    made(
        "first-order",
        "Euler's method under the name of a high order, with steps of 1e-3 s.",
        order=1,
        step=1e-3,
    ),
    made(
        "step-10-times-too-large", "The classic fourth-order method with steps of 0.1 s.", order=4, step=0.1
    ),
    spoilt("single-precision", "States have 24 bits.", in_single_precision),
    spoilt("one-sample-late", "Every state is that of the sample before.", one_sample_late),
    _fault("output-late", "Every state but the first is of 1e-7 s before its time.", output_late),
    _fault("phases-late", "Phases begin and end 1 ms after the states say so.", phases_late),
    spoilt("angle-wrapped", "Angles are brought between −π and π.", with_angle_wrapped),
    spoilt("no-number-at-the-end", "The last state is not a number.", without_end),
    spoilt("relative-velocities", "Velocities are relative to the disc below.", with_relative_velocities),
    spoilt(
        "velocities-by-differences",
        "Velocities are differences of places between samples.",
        with_velocities_by_differences,
    ),
    _fault("starts-from-rest", "The velocities of the start are ignored.", from_rest),
)

SIZE = "1e-6"
"""Relative error of a parameter; a claim that detects it also detects larger errors."""

PARAMETERS = {
    "mass": "The mass",
    "stiffness": "The stiffness",
    "damping": "The damping",
    "friction_force": "The friction force",
    "disc_speed": "The speed of the disc below",
    "offset": "The offset",
    "hardening": "The hardening",
    "stop_gap": "The play before the stop",
    "stop_stiffness": "The stiffness of the stop",
    "polar_inertia": "The moment of inertia",
    "contact_radius": "The radius of the contact",
    "shaft_damping": "The damping of the shaft",
    "shaft_speed": "The speed of the shaft",
}

WRONG_PARAMETERS: tuple[Fault, ...] = tuple(
    mistaken(
        f"{name.replace('_', '-')}-off-by-{SIZE}",
        f"{words} is too large by {SIZE} of itself.",
        functools.partial(off_by, name, float(SIZE)),
    )
    for name, words in PARAMETERS.items()
)

FAULTS: tuple[Fault, ...] = (*FORCE, *MOMENT, *SUPPORT, *NUMERICS, *WRONG_PARAMETERS)
