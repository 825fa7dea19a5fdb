"""The first sentence names a cause only if the measurements exclude the others; no right engine is accused."""

import functools
import math
from dataclasses import replace

import numpy as np
import odd_engines
import pytest
from faults.catalogue import mistaken
from odd_engines import around, in_batches, in_other_time, linear, nearest, on_grid, scaled
from scipy.integrate import solve_ivp
from stepping import engine, stepped

from compare.diagnosis import findings, run
from compare.diagnosis.findings import PROBES
from compare.diagnosis.row import RIGHT
from compare.engines import EVERY_KIND, BadTrajectoryError, Engine
from reference_model import Trajectory


def with_coefficients(name, factor):
    """Return the reference with a coefficient μ that is ``factor()`` times the right one in each call."""

    def change(system, start, times, simulate):
        other = replace(system, friction_force=factor() * system.friction_force)
        return simulate(other, start, times).states

    return around(name, change)


def asleep(system, start, times, *, step):
    """Stop a body that has been slower than 2 cm/s for half a second."""
    found = stepped(system, start, times, step=step)
    slow = np.hypot(*found.states[:, 2:].T) < 0.02
    if times[-1] - times[0] > 0.5 and len(times) > 8 and np.any(slow[1:]):
        states = found.states.copy()
        states[1:] = [*states[1, :2], 0.0, 0.0]
        return Trajectory(system, found.times, states)
    return found


def ten_steps(system, start, times, *, step):
    """Take ten steps between the requested times, whatever the step."""
    return stepped(system, start, times, step=float(np.max(np.diff(times))) / 10.0)


def quantised(system, *_):
    """Return the factor of μ that rounds it to a multiple of 1/256."""
    share = 256.0 * system.friction_force / system.mass / 9.81
    return round(share) / share


def turned_with(factor):
    """Return Moreau's stepping with another disc speed."""

    def simulate(system, start, times, *, step):
        found = stepped(replace(system, disc_speed=factor * system.disc_speed), start, times, step=step)
        return replace(found, system=system)

    return simulate


def sliding_disc(name, law):
    """Return an engine of discs with the force and moment/R ``law(slip, rim speed, size of both, angle)`` over μN."""

    def simulate(system, start, times, *, tolerance):
        radius = system.contact_radius

        def rates(_, state):
            x, y, _, vx, vy, spin = state.tolist()
            slip = complex(vx, vy) - 1j * system.disc_speed * complex(x, y)
            rim = radius * (spin - system.disc_speed)
            force, moment = law(slip, rim, max(math.hypot(abs(slip), rim), 1e2 * tolerance), state[2])
            a = (-system.friction_force * force - system.stiffness * complex(x, y)) / system.mass
            moment = system.friction_force * radius * moment + system.shaft_damping * (
                spin - system.shaft_speed
            )
            return [vx, vy, spin, a.real, a.imag, -moment / system.polar_inertia]

        local = max(0.01 * tolerance, 1e-13)
        found = solve_ivp(rates, (times[0], times[-1]), start, t_eval=times, rtol=local, atol=local)
        return Trajectory(system, np.asarray(times, dtype=float), found.y.T)

    return Engine(name, simulate, ("ring",), nonlinear=False, phases=False)


def disc(name, kind, change):
    """Return the reference for one kind of disc, with the changed parameters."""
    return replace(mistaken(name, change), kinds=(kind,))


def along(slip):
    """Return the direction of a slip, and nearly zero for spin alone."""
    return slip / max(abs(slip), 1e-6)


def stopped_alone(slip, rim, size, angle):
    """Return friction at six points along the impulses that would stop them, with twice the tangential mobility."""
    arms = np.exp(1j * (angle + np.pi / 3.0 * np.arange(6)))
    local = (slip + 1j * rim * arms) * np.conj(arms)
    local = local.real + 0.5j * local.imag
    local /= np.maximum(np.abs(local), 1e-3 * size)
    return np.mean(arms * local), np.mean(local.imag)


def stopped_by_axis(slip, rim, size, angle):
    """Return the same friction without the coupling of the impulses along x and y."""
    arms = np.exp(1j * (angle + np.pi / 3.0 * np.arange(6)))
    speeds = slip + 1j * rim * arms
    forces = speeds.real / (1.0 + arms.imag**2) + 1j * speeds.imag / (1.0 + arms.real**2)
    forces /= np.maximum(np.abs(forces), 1e-3 * size)
    return np.mean(forces), np.mean((np.conj(arms) * forces).imag)


MU = "the coefficient μ is"
random = np.random.default_rng(3)

WRONG = [
    # friction that depends on something
    (engine("place", factor=lambda z, _: 1.0 + 0.05 * abs(z)), "changes with the place, by 5.0 % per m of"),
    (
        engine("x", factor=lambda z, _: 1.0 + 0.05 * z.real),
        "with the place, by 5.0 % per m along 0.0°",
        "fits",
    ),
    (engine("fades", factor=lambda _, t: max(1.0 - 0.1 * t, 0.5)), "with the time or the place: it is 0.99"),
    (
        engine("adhesion", limit=lambda system, *_: 1.0 + 1e-3 / system.friction_force),
        "by 0.0010 N at any load",
        "at once",
    ),
    (
        engine("quantised", limit=quantised),
        "at 1 kg, 0.2 N, 1 m/s and 1 m from the axis, the coefficient μ is 4.2",
        "%, ",
    ),
    (replace(engine("half"), function=turned_with(0.5)), "assumes 0.5 times the speed of the master disc"),
    # other forces
    (
        engine("tilted", push=lambda system, *_: 0.02 * system.mass),
        "accelerated by 0.020 m/s² along 0.0°",
        "spring",
    ),
    (
        engine("turning", push=lambda system, _, v: -0.02j * system.mass * v),
        "velocity turns by −0.020 rad/s",
        "Stribeck",
    ),
    (
        engine("drag", push=lambda system, _, v: -0.04 * system.mass * v),
        "loses 4.0 % of its speed per second",
        "at once",
    ),
    (
        engine("air", push=lambda system, _, v: -1e-3 * v * abs(v)),
        "square of the speed, 0.0010 N per m²/s²",
        "at once",
    ),
    (
        engine("viscous", push=lambda system, z, v: -0.1 * system.mass * (v - 1j * system.disc_speed * z)),
        "viscous friction of 0.10 N per kg and m/s of the slip",
        "damping",
    ),
    (
        engine("centre", push=lambda system, z, _: -0.1 * system.mass * z),
        "0.10 m/s² per m towards the axis",
        "spring",
    ),
    (
        engine("tilted and rough", limit=lambda *_: 1.02, push=lambda system, *_: 0.01 * system.mass),
        "along 0.0° (is the plane tilted?), and the coefficient μ is 2.0 % too large",
        "spring",
    ),
    # the support
    (
        mistaken("damper twice", lambda system: {"damping": 2.0 * system.damping}),
        "damper force is 100 % too large",
    ),
    (
        mistaken(
            "support", lambda system: {"damping": 2.1 * system.damping, "stiffness": 2.1 * system.stiffness}
        ),
        "the spring force is 2.1 times",
        "mass",
    ),
    (
        mistaken("springs", lambda s: {"damping": max(s.damping, 0.01 * math.sqrt(s.stiffness * s.mass))}),
        "a body on springs loses 0.99 % of its speed per second",
        "spring force",
    ),
    (mistaken("pounds", lambda system: {"mass": 0.4536 * system.mass}), "the mass is 0.454 times"),
    # the output
    (
        around("degrees", scaled([5], 180.0 / math.pi), EVERY_KIND),
        "57.3 times the given spin, as if",
        "moment",
    ),
    (around("positions", scaled([0, 1], 1.01)), "moves by 1.01 times the integral of its velocity", "spring"),
    (around("late", in_other_time(lambda t: t - 1e-3)), "are returned 1.0 ms late", "converge"),
    (around("clock", in_other_time(lambda t: 1.01 * t)), "moves by 1.01 times the integral", "mass"),
    (around("nearest", on_grid(1e-2, nearest)), "as if states belonged to other times", "turntable"),
    (around("linear", on_grid(2e-2, linear)), "states lie on straight lines", "spring"),
    (
        around("rounded", lambda *of: np.round(of[3](*of[:3]).states, 4)),
        "states are rounded to 4 decimals",
        "at once",
    ),
    (in_batches("reversed", lambda *_: _[-1][::-1]), "in another order than asked", "shape"),
    (
        in_batches(
            "shared",
            lambda s, starts, times, _: [
                stepped(s[0], *one, step=4e-3) for one in zip(starts, times, strict=True)
            ],
        ),
        "motions of a batch differ by",
    ),
    # discs
    (
        sliding_disc("ellipsoid", lambda u, w, size, _: (u / size, w / size)),
        "of an ellipsoid with the limits μN and 1·μNR",
    ),
    (
        sliding_disc("separate", lambda u, w, *_: (along(u), 2.0 / 3.0 * float(np.sign(w)))),
        "separate limits for slide and spin, μN and 0.667·μNR; it deviates from a ring by up to 87 % of μN",
    ),
    (
        sliding_disc(
            "larger", lambda u, w, *_: (along(u), 0.0) if abs(u) > abs(w) else (0.0, float(np.sign(w)))
        ),
        "friction against the larger of slide and spin only, a pyramid; it deviates from a ring",
    ),
    (
        sliding_disc("stopped", stopped_alone),
        "along the impulse that would stop each of 6 points alone",
        "or",
    ),
    (
        sliding_disc("by axis", stopped_by_axis),
        "along the impulse that would stop each of 6 points by axis",
        "or",
    ),
    (sliding_disc("no spin friction", lambda u, *_: (along(u), 0.0)), "no friction against spin; it", "or"),
    (sliding_disc("viscous spin", lambda u, w, *_: (along(u), w)), "viscous friction against spin, 1 s/m"),
    (
        disc("four", "ring", lambda _: {"contact_points": 4}),
        "the friction of 4 points; it deviates from a ring",
    ),
    (disc("ring", "points", lambda _: {"contact_points": None}), "the friction of a ring; it deviates", "or"),
    (
        disc("cylinder", "ring", lambda s: {"polar_inertia": 0.5 * s.polar_inertia}),
        "0.5 times the right moment of in",
    ),
    (
        disc("radius", "ring", lambda s: {"contact_radius": 0.95 * s.contact_radius}),
        "a ring of 0.95 times the radius",
    ),
    # calls and steps
    (
        with_coefficients("random", lambda: random.uniform(0.95, 1.05)),
        "equal calls return states that differ",
    ),
    (replace(engine("ten steps"), function=ten_steps), "results do not change with the step", "damper"),
    (
        replace(engine("long steps"), function=lambda *motion, step: stepped(*motion, step=max(step, 1e-2))),
        "the same at steps of 0.004 and 0.008 s",
    ),
    (replace(engine("sleeps"), function=asleep), "it falls asleep, or friction grows", "static"),
    (engine("soft start", factor=lambda _, t: float(t > 0.02)), "0 to 0.01 s after the start of a slide"),
]
"""Wrong engines, a part of the first sentence of each, and words that the sentence must not contain instead of μ."""


def row_of(made):
    """Return the row of an engine without the motions."""
    row = run._empty(made)
    for part in findings.parts_of(made).keys() & PROBES:
        try:
            row = run._with(row, part, run.measured(made, part))
        except BadTrajectoryError as error:
            row = replace(row, gaps=row.gaps | {part: str(error)})
    return row


@pytest.mark.parametrize("case", WRONG, ids=lambda case: case[0].name)
def test_the_first_sentence_says_what_was_measured(case):
    made, said, *others = case
    row = row_of(made)
    assert said in row.sentences[0]
    assert not any(other in row.sentences[0] for other in others or [MU])
    assert row.verdict != RIGHT


@pytest.mark.parametrize("made", odd_engines.RIGHT, ids=lambda made: made.name)
def test_no_right_engine_of_any_kind_is_accused(made):
    row = row_of(made)
    assert row.verdict == RIGHT
    assert row.sentences[0].startswith(
        ("Coulomb friction, accurate to ", "The force and the moment of friction")
    )


def test_a_damped_vibration_is_repeated_with_smaller_steps():
    """Implicit Euler damps the stick-slip vibration completely at the usual four steps."""
    implicit = odd_engines.with_steps("implicit", functools.partial(odd_engines.implicit, 1.0))
    assert not findings._motion(implicit, "stick-slip").converges
    assert findings.motion(implicit, "stick-slip").converges
