"""Catalogue of sound engines, and of variants with one typical mistake of users or developers each.

If a term can be wrong by any amount, a small error stands for all: friction off by a millionth for friction along the
slip. ``tested_studies`` contains the gross faults that every claim must detect.
"""

import functools
import math

from compare.engines import EVERY_KIND, Engine, reference
from faults.around_reference import (
    from_rest,
    half_a_pitch_on,
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
from faults.make import Make
from faults.plain import simulate as simulate_plainly
from faults.wrong_parameters import (
    off_by,
    one_point_too_few,
    stronger_at_extremes,
    weaker_backwards,
    with_parameters,
)

SOUND = (reference, Engine("plain", simulate_plainly, EVERY_KIND))
"""Engines to insert faults into. A claim that fails for one of them is itself wrong."""


def made(name, **make):
    """Return the plain engine with one wrong part."""
    return Engine(name, functools.partial(simulate_plainly, make=Make(**make)), EVERY_KIND)


def mistaken(name, change):
    """Return the reference with wrong parameters."""
    return Engine(name, functools.partial(with_parameters, change), EVERY_KIND)


def spoilt(name, change):
    """Return the reference with wrong output."""
    return Engine(name, functools.partial(with_output, change), EVERY_KIND)


def around(name, simulate):
    """Return an engine that calls the reference wrongly."""
    return Engine(name, simulate, EVERY_KIND)


FORCE = (
    made("absolute-velocity", relative=0.0),
    made("disc-turns-about-anchor", about_anchor=True),
    made("static-friction-higher", static_ratio=1.2),
    made("friction-falls-with-slip", weakening=0.01),
    made("creep-in-stick", creep_speed=1e-5),
    made("no-release", release_delay=math.inf),
    made("release-late-by-1e-3", release_late=1e-3),
    around("no-centripetal-term-in-stick", without_centripetal_term),
    made("friction-stronger-beside", stronger_beside=1e-5),
    mistaken("friction-stronger-at-extremes", stronger_at_extremes),
    mistaken("friction-weaker-backwards", weaker_backwards),
)

MOMENT = (
    made("moment-of-wrong-sign", moment=-1.0),
    made("uncoupled-slip-and-spin", uncoupled=True),
    made("points-lag", points_lag=1e-5),
    made("moment-larger-in-slip", moment_of_slip=1.0 + 1e-4),
    around("points-half-a-pitch-on", half_a_pitch_on),
    around("expansion-for-ring", three_terms),
    mistaken("one-point-too-few", one_point_too_few),
)

SUPPORT = (
    made("damping-on-slip", damping_on_slip=True),
    made("springs-turn", anchor_turns=True),
    made("hardening-of-wrong-power", hardening_power=1.0),
    made("stop-that-pulls", stop_pulls=True),
    made("stop-on-one-side", stop_on_one_side=True),
    made("stiffer-in-y", stiffer_in_y=1e-5),
)

NUMERICS = (
    made("no-coriolis", coriolis=0.0),
    made("energy-creeps-in", energy_gain=1e-6),
    made("step-10-times-too-large", order=4, step=0.1),
    around("output-late", output_late),
    around("phases-late", phases_late),
    spoilt("angle-wrapped", with_angle_wrapped),
    spoilt("no-number-at-the-end", without_end),
    spoilt("relative-velocities", with_relative_velocities),
    spoilt("velocities-by-differences", with_velocities_by_differences),
    around("starts-from-rest", from_rest),
)

SIZE = "1e-6"
"""Relative error of a parameter; a claim that detects it also detects larger errors."""

PARAMETERS = (
    "mass", "stiffness", "damping", "friction_force", "disc_speed", "offset", "hardening", "stop_gap",
    "stop_stiffness", "polar_inertia", "contact_radius", "shaft_damping", "shaft_speed",
)  # fmt: skip

WRONG_PARAMETERS = tuple(
    mistaken(f"{name.replace('_', '-')}-off-by-{SIZE}", functools.partial(off_by, name, float(SIZE)))
    for name in PARAMETERS
)

FAULTS = (*FORCE, *MOMENT, *SUPPORT, *NUMERICS, *WRONG_PARAMETERS)
