"""Stick phases found from states are those that the reference reports."""

import math
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import reference_model
from compare.claims.error_estimates import refined
from compare.claims.parameters import FIG5, FIG5_STARTS, FIG11
from compare.engines import Engine
from compare.engines.stick import REST
from reference_model import Phase, Trajectory, plain

TIMES = np.linspace(0.0, 30.0, 7)

RING = replace(FIG11, friction_force=0.1)

PASSES_BY = replace(
    FIG5,
    damping=0.05174294942761709,
    friction_force=0.2067058991083,
    disc_speed=1.62039924899,
    offset=0.1027585285368,
)
"""Its slip falls to 2e-4 of the largest slip and grows again."""


BLOCK = replace(FIG5, stiffness=0.1, damping=0.0, friction_force=1.0, disc_speed=0.0, offset=0.0)
"""Block on a plane at rest. At 10 m from the origin, the spring force equals the friction force."""


def drawn(seed):
    """Return a random pin and start; seed 1 never sticks, 18 and 56 stick in between."""
    random = np.random.default_rng(seed)
    pin = replace(
        FIG5,
        friction_force=random.uniform(0.03, 0.3),
        disc_speed=random.uniform(0.3, 3.0) * random.choice([-1, 1]),
        damping=random.uniform(0.0, 0.5),
        offset=random.uniform(0.0, 0.2),
    )
    return pin, random.normal(0.0, 0.1, 4)


MOTIONS = {
    "the way to the whirl, whose last stick is nearly slip": (FIG5, FIG5_STARTS["whirl"]),
    "a ring that comes to rest": (RING, (0.05, 0.0, 0.0, 0.1, 0.0, 0.5)),
    "slip that passes by rest": (PASSES_BY, (-0.04926085, -0.06287503, -0.1125771, -0.05500665)),
    "a block that is thrown": (replace(BLOCK, stiffness=0.0), (0.0, 0.0, 2.0, 1.0)),
    "a block that is held": (BLOCK, (9.0, 3.0, 0.0, 0.0)),
    "a block that is released": (BLOCK, (9.0, 5.0, 0.0, 0.0)),
    "a block that swings to rest": (replace(BLOCK, stiffness=1.0), (6.0, 6.0, 0.0, 0.0)),
} | {f"drawn {seed}": drawn(seed) for seed in (1, 18, 56)}


def told(system, start, times, *, tolerance=1e-9):
    return reference_model.simulate(system, start, times, tolerance=tolerance)


def states_only(system, start, times, *, tolerance=1e-9):
    run = told(system, start, times, tolerance=tolerance)
    return Trajectory(system, run.times, run.states)


def one_phase(system, start, times, *, tolerance=1e-9):
    run = told(system, start, times, tolerance=tolerance)
    return replace(run, phases=(Phase("slip", times[0], times[-1], run.states[0]),))


def engine(function, **more):
    return Engine("mine", function, ("pin", "ring"), **more)


@pytest.mark.parametrize("motion", MOTIONS)
def test_stick_found_in_states_is_that_of_the_reference(motion):
    system, start = MOTIONS[motion]
    exact = told(system, start, TIMES)
    found = engine(states_only, phases=False).simulate(system, start, TIMES)
    assert [phase.kind for phase in found.phases] == [phase.kind for phase in exact.phases]
    np.testing.assert_allclose(found.stick_times, exact.stick_times, rtol=0.0, atol=1e-5)


@pytest.mark.parametrize("load", [0.1, 0.99])
def test_a_creeping_block_counts_as_permanent_stick(load):
    """On a plane at rest, only the spring defines a scale for slow motion."""

    def creeping(pin, start, times, *, tolerance):
        return plain.simulate(pin, start, times, tolerance=tolerance)

    found = engine(creeping, phases=False).simulate(BLOCK, (6.0 * load, 8.0 * load, 0.0, 0.0), TIMES)
    assert np.any(found.slip_speed > 0.0)
    np.testing.assert_array_equal(found.stick_times, TIMES[[0, -1]])


@pytest.mark.parametrize(("force", "kinds"), [(0.99, ["slip", "stick"]), (1.01, ["slip"])])
def test_a_body_at_rest_does_not_stick_if_friction_cannot_hold_it(force, kinds):
    """An engine with too much friction may hold it."""
    place, stops = force * BLOCK.friction_force / BLOCK.stiffness, 3.0

    def stopping(system, start, times, *, tolerance):
        left = np.maximum(stops - np.asarray(times), 0.0)
        states = np.zeros((len(times), 4))
        states[:, 0], states[:, 2] = place - 0.5 * left**2, left
        return Trajectory(system, np.array(times), states)

    start = (place - 0.5 * stops**2, 0.0, stops, 0.0)
    found = engine(stopping, phases=False).simulate(BLOCK, start, TIMES)
    assert [phase.kind for phase in found.phases] == kinds


def test_stick_is_searched_only_if_the_engine_does_not_report_phases():
    start = FIG5_STARTS["equilibrium"]
    looked_for = engine(one_phase, phases=False).simulate(FIG5, start, TIMES)
    assert len(looked_for.stick_phases) == 2
    assert engine(one_phase).simulate(FIG5, start, TIMES).stick_phases == ()
    exact = engine(told, phases=False).simulate(FIG5, start, TIMES)
    np.testing.assert_array_equal(exact.stick_times, told(FIG5, start, TIMES).stick_times)


def test_a_pivot_phase_is_kept():
    def pivots(system, start, times, *, tolerance=1e-9):
        kinds = ("slip", "pivot")
        told_by_it = tuple(Phase(kind, i, i + 1.0, np.zeros(6)) for i, kind in enumerate(kinds))
        return Trajectory(system, np.array(times), np.zeros((len(times), 6)), told_by_it)

    found = Engine("mine", pivots, ("points",), phases=False).simulate(
        replace(FIG11, contact_points=6), np.zeros(6), (0.0, 1.0, 2.0)
    )
    assert [phase.kind for phase in found.phases] == ["slip", "pivot"]


def test_stick_is_searched_only_on_request_and_phases_begin_with_states_of_the_engine():
    calls, start = [], FIG5_STARTS["equilibrium"]

    def counted(*arguments, **options):
        calls.append(arguments)
        return states_only(*arguments, **options)

    run = engine(counted, phases=False).simulate(FIG5, start, TIMES)
    assert (len(calls), run.times[-1]) == (1, TIMES[-1])
    np.testing.assert_allclose(run.stick_times, told(FIG5, start, TIMES).stick_times, rtol=0.0, atol=1e-5)
    assert run.stick_times.size == 4
    assert len(calls) > 1
    for phase in run.phases[1:]:
        states = told(FIG5, start, [0.0, phase.start]).states
        np.testing.assert_allclose(phase.initial_state, states[-1], rtol=0.0, atol=1e-9)


def smoothed(pin, start, times, *, tolerance=1e-9):
    """Simulate friction −μN·v/√(v² + ε²), so creep accelerates before a release."""
    turning, slow = np.array([[0.0, 1.0], [-1.0, 0.0]]) * pin.disc_speed, 100.0 * tolerance

    def equations(_, state):
        slip = state[2:] + turning @ state[:2]
        hold = pin.friction_force / np.hypot(np.hypot(*slip), slow)
        springs = -pin.stiffness * (state[:2] - (pin.offset, 0.0))
        return *state[2:], *((springs - hold * slip - pin.damping * state[2:]) / pin.mass)

    local = 0.01 * tolerance
    span = (times[0], times[-1])
    run = solve_ivp(equations, span, start, method="LSODA", t_eval=times, rtol=local, atol=local)
    return Trajectory(pin, run.t, run.y.T)


def test_release_after_growing_creep_converges_with_the_regularisation():
    exact = told(FIG5, FIG5_STARTS["whirl"], [0.0, 7.0]).phases[2].start
    off = []
    for tolerance in (1e-7, 1e-9):
        run = Engine("smoothed", smoothed, phases=False).simulate(
            FIG5, FIG5_STARTS["whirl"], [0.0, 7.0], tolerance=tolerance
        )
        off.append(abs(run.phases[2].start - exact))
    assert off[1] < 0.2 * off[0]
    assert off[1] < 0.01


def stepped(pin, start, times, *, step):
    """Simulate ``smoothed`` friction with ε proportional to the step, by implicit Euler between half drifts."""
    slow, states = step * pin.friction_force / pin.mass, [start]
    z, v = complex(*start[:2]), complex(*start[2:])
    for begin, end in pairwise(times):
        many = max(1, math.ceil((end - begin) / step - 1e-9))
        h = (end - begin) / many
        for _ in range(many):
            z += 0.5 * h * v
            pushed = v - h * pin.stiffness * (z - pin.offset) / pin.mass
            carried = 1j * pin.disc_speed * z
            for _ in range(4):
                hold = pin.friction_force / math.hypot(abs(v - carried), slow)
                v = (pushed + h * hold * carried / pin.mass) / (1.0 + h * (hold + pin.damping) / pin.mass)
            z += 0.5 * h * v
        states.append((z.real, z.imag, v.real, v.imag))
    return Trajectory(pin, np.array(times), np.array(states))


def test_the_error_estimate_covers_the_times_of_stick_and_release():
    start, ends = FIG5_STARTS["equilibrium"], [0.0, 6.4]
    mine = Engine("stepped", stepped, phases=False, step=1e-3)
    found = refined(
        lambda tolerance: mine.simulate(FIG5, start, ends, tolerance=tolerance).stick_times, 1.2e-9
    )
    assert np.max(np.abs(found.value - told(FIG5, start, ends).stick_times)) < 0.5 * found.largest
    # Creep nearly as fast as slip is not stick.
    assert mine.simulate(FIG5, start, ends, tolerance=2e-8).stick_phases == ()


@pytest.mark.parametrize(("growth", "sticks"), [(0.0, True), (1.0, False)])
def test_creep_of_a_coarse_engine_that_grows_up_to_release_is_not_called_stick(growth, sticks):
    """A block slides at 1 m/s, creeps from 10 to 20 s at about a tenth of REST, and slides again."""
    creep = 0.1 * REST

    def speed(t):
        creeping = creep * (1.0 + growth * (t - 15.0) / 10.0)
        return np.maximum(np.maximum(1.0 - 0.1 * t, creeping), 0.1 * (t - 20.0))

    def slow(system, start, times, *, tolerance):
        fine = np.linspace(0.0, 30.0, 30001)
        travelled = np.concatenate(([0.0], np.cumsum(0.5e-3 * (speed(fine)[1:] + speed(fine)[:-1]))))
        states = np.zeros((len(times), 4))
        states[:, 0], states[:, 2] = np.interp(times, fine, travelled), speed(np.asarray(times))
        return Trajectory(system, np.array(times), states)

    block = replace(BLOCK, stiffness=1e-6)
    found = engine(slow, phases=False).simulate(block, (0.0, 0.0, 1.0, 0.0), TIMES, tolerance=1e-7)
    assert bool(found.stick_phases) == sticks


def split_symmetrically(pin, start, times, *, step):
    """Half of friction, springs and damper, and the other half of friction; complex numbers are vectors."""
    z, velocity = complex(*start[:2]), complex(*start[2:])
    states, now = [start], times[0]
    for time in times[1:]:
        steps = max(1, math.ceil((time - now) / step - 1e-9))
        h, now = (time - now) / steps, time
        for i in range(2 * steps):
            if i % 2:
                velocity -= h * (pin.stiffness * (z - pin.offset) + pin.damping * velocity) / pin.mass
                z += h * velocity
            disc = 1j * pin.disc_speed * z
            slip, stopped = velocity - disc, 0.5 * h * pin.friction_force / pin.mass
            velocity = disc + slip * max(0.0, 1.0 - stopped / max(abs(slip), 1e-300))
        states.append((z.real, z.imag, velocity.real, velocity.imag))
    return Trajectory(pin, np.array(times), np.array(states))


def test_slip_that_friction_stops_within_a_step_is_stick():
    """Above half of the limit, half of friction leaves some slip at the end of each step, in proportion to it."""
    pin, start = replace(FIG5, friction_force=0.5, disc_speed=0.5, offset=0.5), (1.0, 0.0, 0.0, 0.5)
    (expected, *_) = told(pin, start, [0.0, 2.0]).phases
    split = Engine("mine", split_symmetrically, ("pin",), step=2e-3)
    found = [
        split.simulate(pin, start, [0.0, 2.0], tolerance=tolerance).phases[0]
        for tolerance in (1e-9, 1.25e-10)
    ]
    assert [phase.kind for phase in found] == ["stick", "stick"]
    release, finer = (phase.end for phase in found)
    assert expected.end > 1.0
    assert expected.end == pytest.approx(finer, abs=abs(release - finer))
