"""The catalogue: right engines, and the same with one mistake each, as users and makers of engines do make them."""

from __future__ import annotations

import cmath
import functools
import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from compare.engines import EVERY_KIND, Engine, reference
from compare.judge.faults import plain
from compare.judge.faults.plain import Make
from reference_model import simulate
from reference_model.contact.contact_law import ThreeTermRing
from reference_model.formulas.pin import release_time
from reference_model.support import Support
from reference_model.systems import ANGLE, DiscOnDisc, FloatArray, PinOnDisc, System
from reference_model.trajectory import Phase, Trajectory


@dataclass(frozen=True)
class Fault:
    """One mistake, and an engine that makes it and no other.

    Parameters
    ----------
    name : str
        As on the command line.
    says : str
        What is wrong, in a sentence.
    engine : Engine
        Of the same name.
    changes_physics : bool
        Whether any motion can tell; otherwise ``why_not_caught`` says why not.

    """

    name: str
    says: str
    engine: Engine
    changes_physics: bool = True
    why_not_caught: str = ""


RIGHT: tuple[Engine, ...] = (reference, Engine("plain", plain.simulate, EVERY_KIND))
"""The engines that mistakes are put into. Whoever fails one of them has made a mistake himself."""


# ---------------------------------------------------------------- the reference with something around it


def with_parameters(
    change: Callable[[System], dict[str, Any]],
    system: System,
    initial_state: ArrayLike,
    times: ArrayLike,
    *,
    tolerance: float = 1e-9,
) -> Trajectory:
    """Simulate ``system`` with some of its parameters changed."""
    trajectory = simulate(replace(system, **change(system)), initial_state, times, tolerance=tolerance)
    return replace(trajectory, system=system)


def with_output(
    change: Callable[[Trajectory], FloatArray],
    system: System,
    initial_state: ArrayLike,
    times: ArrayLike,
    *,
    tolerance: float = 1e-9,
) -> Trajectory:
    """Simulate ``system`` and hand out ``change(trajectory)`` as its states."""
    trajectory = simulate(system, initial_state, times, tolerance=tolerance)
    return replace(trajectory, states=change(trajectory))


def three_terms(
    system: System, initial_state: ArrayLike, times: ArrayLike, *, tolerance: float = 1e-9
) -> Trajectory:
    """Simulate a ring under (23)."""
    ring = isinstance(system, DiscOnDisc) and system.contact_points is None
    law = ThreeTermRing(system.contact_radius) if ring else None  # type: ignore[union-attr]
    return simulate(system, initial_state, times, tolerance=tolerance, contact=law)


def off_by(name: str, share: float, system: System) -> dict[str, float]:
    """Return a parameter that is too large by ``share``, nothing for a system that has no such parameter."""
    return {name: (1.0 + share) * getattr(system, name)} if hasattr(system, name) else {}


def points_of(system: System) -> int:
    """Return the number of points that a disc rests on, 0 if there is no ring of points."""
    return (system.contact_points or 0) if isinstance(system, DiscOnDisc) else 0


def one_point_too_few(system: System) -> dict[str, Any]:
    """Return n − 1 points; 3 are the fewest that a disc can have."""
    return {"contact_points": points_of(system) - 1} if points_of(system) > 3 else {}


def load_shared_twice(system: System) -> dict[str, Any]:
    """Return the load over n."""
    return {"friction_force": system.friction_force / (points_of(system) or 1)}


def load_not_shared(system: System) -> dict[str, Any]:
    """Return n times the load."""
    return {"friction_force": system.friction_force * (points_of(system) or 1)}


def diameter_for_radius(system: System) -> dict[str, Any]:
    """Return 2R."""
    return {"contact_radius": 2.0 * system.contact_radius} if isinstance(system, DiscOnDisc) else {}


def shaft_at_rest(system: System) -> dict[str, Any]:
    """Return Ω = 0."""
    return {"shaft_speed": 0.0} if isinstance(system, DiscOnDisc) else {}


def mass_for_inertia(system: System) -> dict[str, Any]:
    """Return m and J exchanged."""
    if not isinstance(system, DiscOnDisc):
        return {}
    return {"mass": system.polar_inertia, "polar_inertia": system.mass}


def stiffness_for_frequency(system: System) -> dict[str, Any]:
    """Return the spring of which C is the natural frequency."""
    return {"stiffness": system.mass * system.stiffness**2}


def damping_per_mass(system: System) -> dict[str, Any]:
    """Return the damper of which β is divided by the mass."""
    return {"damping": system.damping * system.mass}


def hardening_forgotten(system: System) -> dict[str, Any]:
    """Return C₃ = 0."""
    return {"hardening": 0.0}


def stop_without_play(system: System) -> dict[str, Any]:
    """Return a gap of 0."""
    return {"stop_gap": 0.0}


def disc_backwards(system: System) -> dict[str, Any]:
    """Return −ω."""
    return {"disc_speed": -system.disc_speed}


def stronger_at_extremes(system: System) -> dict[str, Any]:
    """Return a load that is 1 % larger on a disc that is fast or slow."""
    usual = 0.3 <= abs(system.disc_speed) <= 4.0
    return {} if usual else {"friction_force": 1.01 * system.friction_force}


def weaker_backwards(system: System) -> dict[str, Any]:
    """Return a load that is 1e-4 smaller for ω < 0."""
    return {"friction_force": (1.0 - 1e-4) * system.friction_force} if system.disc_speed < 0.0 else {}


def in_single_precision(trajectory: Trajectory) -> FloatArray:
    """Round to 24 bits."""
    return trajectory.states.astype(np.float32).astype(float)


def one_sample_late(trajectory: Trajectory) -> FloatArray:
    """Return every state one sample late, the first one twice."""
    return np.vstack((trajectory.states[:1], trajectory.states[:-1]))


def with_angle_wrapped(trajectory: Trajectory) -> FloatArray:
    """Return angles between −π and π."""
    states = trajectory.states.copy()
    if isinstance(trajectory.system, DiscOnDisc):
        states[:, ANGLE] = np.angle(np.exp(1j * states[:, ANGLE]))
    return states


def without_end(trajectory: Trajectory) -> FloatArray:
    """Return no numbers for the last state."""
    states = trajectory.states.copy()
    states[-1] = np.nan
    return states


def with_relative_velocities(trajectory: Trajectory) -> FloatArray:
    """Return velocities relative to the master disc."""
    states, half = trajectory.states.copy(), trajectory.system.state_size // 2
    states[:, half:] -= plain.carried(states[:, :half], trajectory.system.disc_speed)
    return states


def with_velocities_by_differences(trajectory: Trajectory) -> FloatArray:
    """Return velocities that are differences of places over the time between samples, the first one as it was."""
    states, half = trajectory.states.copy(), trajectory.system.state_size // 2
    steps = np.diff(trajectory.times)[:, np.newaxis]
    states[1:, half:] = np.diff(states[:, :half], axis=0) / steps
    return states


def output_late(
    system: System, initial_state: ArrayLike, times: ArrayLike, *, tolerance: float = 1e-9
) -> Trajectory:
    """Return states of 1e-7 s before the times asked for, but for the first."""
    times = np.asarray(times, dtype=float)
    early = np.append(times[0], np.maximum(times[1:] - 1e-7, times[0]))
    return replace(simulate(system, initial_state, early, tolerance=tolerance), times=times)


def phases_late(
    system: System, initial_state: ArrayLike, times: ArrayLike, *, tolerance: float = 1e-9
) -> Trajectory:
    """Return the right states, and phases that begin and end 1 ms late, but for the start and the end of it all."""
    trajectory = simulate(system, initial_state, times, tolerance=tolerance)
    start, end = trajectory.times[0], trajectory.times[-1]

    def late(time: float) -> float:
        return min(time + 1e-3, end) if time > start else time

    phases = (replace(one, start=late(one.start), end=late(one.end)) for one in trajectory.phases)
    return replace(trajectory, phases=tuple(phases))


def without_centripetal_term(
    system: System, initial_state: ArrayLike, times: ArrayLike, *, tolerance: float = 1e-9
) -> Trajectory:
    """Simulate a pin that is let go when friction can no longer hold it without its mass.

    Where that is too early, it sticks again at once.
    """
    trajectory = simulate(system, initial_state, times, tolerance=tolerance)
    if not isinstance(system, PinOnDisc) or not Support.of(system).linear:
        return trajectory
    massless = replace(system, mass=1e-12 * system.mass)
    times = trajectory.times
    for i, phase in enumerate(trajectory.phases):
        if phase.kind != "stick":
            continue
        z = complex(*phase.initial_state[:2])
        until = min(phase.start + release_time(massless, abs(z), cmath.phase(z)), float(times[-1]))
        if until > phase.end:
            held, after = (times > phase.end) & (times <= until), times > until
            states = trajectory.states.copy()
            states[held] = [_carried_on(phase, system.disc_speed, t) for t in times[held]]
            phases = [*trajectory.phases[:i], replace(phase, end=until)]
            if np.any(after):
                rest = [until, *times[after]]
                let_go = _carried_on(phase, system.disc_speed, until)
                later = without_centripetal_term(system, let_go, rest, tolerance=tolerance)
                states[after] = later.states[1:]
                phases += later.phases
            return replace(trajectory, states=states, phases=tuple(phases))
    return trajectory


def _carried_on(phase: Phase, speed: float, time: float) -> FloatArray:
    """Return the state of a pin that still sticks at ``time``."""
    turn = cmath.exp(1j * speed * (time - phase.start))
    z, v = (complex(*pair) * turn for pair in np.split(phase.initial_state, 2))
    return np.array([z.real, z.imag, v.real, v.imag])


def half_a_pitch_on(
    system: System, initial_state: ArrayLike, times: ArrayLike, *, tolerance: float = 1e-9
) -> Trajectory:
    """Simulate points at φ + 2π(i + ½)/n."""
    points = system.contact_points if isinstance(system, DiscOnDisc) else None
    if points is None:
        return simulate(system, initial_state, times, tolerance=tolerance)
    turn = np.zeros(system.state_size)
    turn[ANGLE] = math.pi / points
    trajectory = simulate(system, np.asarray(initial_state) + turn, times, tolerance=tolerance)
    return replace(trajectory, states=trajectory.states - turn)


def from_rest(
    system: System, initial_state: ArrayLike, times: ArrayLike, *, tolerance: float = 1e-9
) -> Trajectory:
    """Simulate from the places alone."""
    places, velocities = np.split(np.asarray(initial_state, dtype=float), 2)
    return simulate(system, [*places, *(0.0 * velocities)], times, tolerance=tolerance)


# ---------------------------------------------------------------- the catalogue


def _fault(name: str, says: str, function: Any, kinds: tuple[str, ...] = EVERY_KIND) -> Fault:
    return Fault(name, says, Engine(name, function, kinds))


def made(name: str, says: str, kinds: tuple[str, ...] = EVERY_KIND, **make: Any) -> Fault:
    """Return the plain engine with one part made wrong."""
    return _fault(name, says, functools.partial(plain.simulate, make=Make(**make)), kinds)


def mistaken(name: str, says: str, change: Callable[[System], dict[str, Any]]) -> Fault:
    """Return the reference with parameters that are mistaken."""
    return _fault(name, says, functools.partial(with_parameters, change))


def spoilt(name: str, says: str, change: Callable[[Trajectory], FloatArray]) -> Fault:
    """Return the reference with outputs that are spoilt."""
    return _fault(name, says, functools.partial(with_output, change))


POINTS_ONLY = ("pin", "points")
"""A polygon is a law of single points."""

CORNERS = 1e-4
"""ε in m/s of polygons: motions run along their corners for long, which a smaller one makes too costly to follow."""

FORCE: tuple[Fault, ...] = (
    made(
        "pyramid-of-4-sides",
        "Friction is bounded by a square inside of the circle.",
        POINTS_ONLY,
        sides=4,
        first_side=math.pi / 4.0,
        slip_width=CORNERS,
    ),
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
    made(
        "regularised-100-times-too-wide",
        "Friction is viscous below 1e-3 m/s, whatever the tolerance.",
        slip_width=1e-3,
    ),
    made("creep-in-stick", "What sticks creeps with up to 1e-5 m/s.", creep_speed=1e-5),
    made("late-release", "Stick ends 0.02 s late.", release_delay=0.02),
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
    made("points-turn-backwards", "The points of contact turn against the disc.", points_turn=-1.0),
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
    mistaken(
        "load-shared-twice",
        "The load of a point is divided by the number of points twice.",
        load_shared_twice,
    ),
    mistaken("load-not-shared", "Each point carries all of the load.", load_not_shared),
    mistaken("diameter-for-radius", "The ring's diameter is taken for its radius.", diameter_for_radius),
)

SUPPORT: tuple[Fault, ...] = (
    made(
        "damping-on-slip",
        "The dampers act against the velocity relative to the disc below.",
        damping_on_slip=True,
    ),
    made("offset-of-wrong-sign", "The springs are relaxed at −X0.", anchor=-1.0 + 0.0j),
    made("offset-on-wrong-axis", "The springs are relaxed on the y axis.", anchor=1.0j),
    made("springs-turn", "The springs turn with the disc below.", anchor_turns=True),
    made(
        "hardening-of-wrong-power",
        "The hardening is proportional to the deflection, not to its square.",
        hardening_power=1.0,
    ),
    made("stop-that-pulls", "The stop pulls while it is not touched.", stop_pulls=True),
    made("stop-on-one-side", "There is no stop at deflections of negative x.", stop_on_one_side=True),
    made("stiffer-in-y", "The spring of the y axis is stiffer by 1e-5 of itself.", stiffer_in_y=1e-5),
    mistaken("hardening-forgotten", "Springs are linear.", hardening_forgotten),
    mistaken("stop-without-play", "The stop acts from the first.", stop_without_play),
    mistaken(
        "stiffness-for-frequency",
        "C and k are confused: the spring's stiffness is taken for k.",
        stiffness_for_frequency,
    ),
    mistaken("damping-per-mass", "The damping is taken for that of a unit of mass, β/m.", damping_per_mass),
    mistaken("mass-for-inertia", "Mass and moment of inertia are exchanged.", mass_for_inertia),
    mistaken("shaft-at-rest", "The shaft's damper acts against the ground, not against Ω.", shaft_at_rest),
    mistaken("disc-backwards", "The disc below turns in the other sense.", disc_backwards),
)

NUMERICS: tuple[Fault, ...] = (
    made("no-coriolis", "The Coriolis term 2ρ̇ψ̇ of the polar form is forgotten.", coriolis=0.0),
    made("energy-creeps-in", "A vibration gains 1e-6 of its energy in a cycle.", energy_gain=1e-6),
    made(
        "first-order",
        "Euler's method under the name of a high order, with steps of 1e-4 s.",
        order=1,
        step=1e-4,
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

SIZES = ("1e-3", "1e-4", "1e-6")

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
        f"{name.replace('_', '-')}-off-by-{size}",
        f"{words} is too large by {size} of itself.",
        functools.partial(off_by, name, float(size)),
    )
    for name, words in PARAMETERS.items()
    for size in SIZES
)

INVISIBLE: tuple[Fault, ...] = (
    Fault(
        "no-friction-on-the-master",
        "Friction does not act back on the disc below.",
        Engine("no-friction-on-the-master", plain.simulate, EVERY_KIND),
        changes_physics=False,
        why_not_caught="(1) and (19) give the speed of the disc below, so that no force can change it, and a "
        "trajectory has no torque of its drive. Where that disc is a body of its own, in the drivetrain, the balance "
        "of its momentum sees it.",
    ),
)

FAULTS: tuple[Fault, ...] = (*FORCE, *MOMENT, *SUPPORT, *NUMERICS, *WRONG_PARAMETERS, *INVISIBLE)
