import itertools
import math
import re
from dataclasses import replace

import numpy as np
import pytest
from friction_joints import by_events, by_time_stepping, random_joint
from scipy.linalg import expm

from reference_model import FrictionJoint, PinOnDisc, Ring, simulate

JOINT = FrictionJoint(inertia=0.5, friction_moment=2.0)
TIMES = np.linspace(0.0, 8.0, 33)


@pytest.mark.parametrize("seed", range(0, 60, 20))
def test_random_joints_move_as_by_an_integrator_with_events(seed):
    for number in range(seed, seed + 20):
        joint, state = random_joint(number)
        expected = by_events(joint, state, TIMES)
        found = simulate(joint, state, TIMES).states
        # DOP853 and the time of an event err by about 1e-12 each, and a release amplifies this
        assert found == pytest.approx(expected, abs=1e-8 * max(1.0, np.max(abs(expected)))), number


@pytest.mark.parametrize("damping", [0.0, 1.0])
def test_spin_that_just_reaches_zero_while_it_swings_stops(damping):
    # about a spin of 1 rad/s, which keeps up with the moment
    joint = FrictionJoint(
        inertia=1.0, friction_moment=1.0, damping=damping, stiffness=1.0, moment=[(0, 1), (9, 10)]
    )
    stops = 0
    for spin in np.linspace(1.0, 12.0, 121):
        run = simulate(joint, (-damping, spin), TIMES)
        stops += len(run.stick_phases) > 0
        assert run.states == pytest.approx(by_events(joint, (-damping, spin), TIMES), abs=1e-7), spin
    assert 20 < stops < 115


def test_random_joints_are_the_limit_of_time_stepping():
    step = 2e-4  # s
    for number in range(20):
        joint, state = random_joint(number)
        joint = replace(joint, static_ratio=1.0)
        exact = simulate(joint, state, TIMES).states
        error = np.max(abs(by_time_stepping(joint, state, TIMES, step) - exact))
        angle, spin = np.max(abs(exact), axis=0)
        most = 4.0 * joint.friction_moment + joint.stiffness * (angle + 1.0) + joint.damping * spin
        # some ten events are late by up to a step, and each second is off by up to half a step of acceleration
        assert error < 20.0 * step * most / joint.inertia, number


RATES = [0.0, 1e-8, 1e-3, 0.4, 1.0, 1.0 + 1e-9, 1.5, 30.0, 1e5]


@pytest.mark.parametrize(("damping", "stiffness"), list(itertools.product(RATES, RATES)))
def test_closed_forms_agree_with_a_matrix_exponential(damping, stiffness):
    joint = FrictionJoint(
        inertia=1.0, friction_moment=0.5, damping=2.0 * damping, stiffness=stiffness**2,
        moment=((0.0, 40.0), (4.0, 60.0)),
    )  # fmt: skip
    # angle, spin, M − F and its rate; the joint moves forward at first
    flow = np.zeros((4, 4))
    flow[0, 1] = flow[1, 2] = flow[2, 3] = 1.0
    flow[1, :2] = -(stiffness**2), -2.0 * damping
    for time in (1e-6, 1e-3, 0.1, 1.0, 4.0):
        if time > 0.5 * math.pi / max(stiffness, 0.1):  # it may stop
            continue
        run = simulate(joint, (0.0, 0.0), [0.0, time])
        expected = (expm(time * flow) @ (0.0, 0.0, 39.5, 5.0))[:2]
        # the reference of the comparison loses digits where the rates differ most
        assert run.at_end == pytest.approx(expected, rel=1e-13 * max(1e2, damping * time, stiffness * time))


def test_spin_stops_where_friction_has_done_the_work_and_rests_for_an_hour():
    run = simulate(JOINT, (0.0, -3.0), [0.0, 0.375, 0.75, 3600.0])
    assert run.states[1:] == pytest.approx(
        np.array([(-0.84375, -1.5), (-1.125, 0.0), (-1.125, 0.0)]), abs=1e-14
    )  # Jω²/2F = 0.5·9/4
    assert [(phase.kind, phase.end) for phase in run.phases] == [("slip", 0.75), ("stick", 3600.0)]


def test_joint_holds_exactly_up_to_its_static_moment_and_breaks_away_at_once():
    held = replace(JOINT, static_ratio=1.5, moment=((0.0, -3.0),))
    assert np.all(simulate(held, (0.1, 0.0), [0.0, 3600.0]).at_end == (0.1, 0.0))
    ramp = replace(held, moment=((0.0, 0.0), (10.0, -10.0)))
    run = simulate(ramp, (0.0, 0.0), [0.0, 3.0, 4.0])
    assert run.stick_times == pytest.approx([0.0, 3.0])
    # J·φ̈ = 1 + τ N m beyond the sliding friction
    assert run.at_end == pytest.approx([-(1.0 / 2.0 + 1.0 / 6.0) / 0.5, -(1.0 + 1.0 / 2.0) / 0.5])


def test_swings_on_a_spring_shorten_by_twice_the_friction_until_the_joint_rests():
    joint = replace(JOINT, stiffness=4.0, offset=0.2)
    turn = math.pi * math.sqrt(joint.inertia / joint.stiffness)
    run = simulate(joint, (0.2 + 0.5 * 8.5, 0.0), turn * np.arange(8.0))
    assert (run.states[:, 0] - 0.2) / 0.5 == pytest.approx([8.5, -6.5, 4.5, -2.5, 0.5, 0.5, 0.5, 0.5])
    assert run.stick_times == pytest.approx([4.0 * turn, 7.0 * turn])


def test_moment_that_reverses_a_spin_passes_zero_without_rest():
    joint = replace(JOINT, moment=((0.0, 7.0),))
    run = simulate(joint, (0.0, -1.0), [0.0, 1.0])
    stop = 0.5 / 9.0  # decelerated by 7 + 2 N m, then accelerated by 7 − 2 N m
    assert run.at_end[1] == pytest.approx((1.0 - stop) * 5.0 / 0.5)
    assert [phase.kind for phase in run.phases] == ["slip"]


def test_motion_does_not_depend_on_the_requested_times_or_the_direction():
    for number in range(20):
        joint, state = random_joint(number)
        mirrored = replace(joint, offset=-joint.offset, moment=[(t, -value) for t, value in joint.moment])
        run = simulate(joint, state, TIMES)
        assert np.all(simulate(mirrored, np.negative(state), TIMES).states == -run.states)
        assert simulate(joint, state, TIMES[[0, 7, 32]]).states == pytest.approx(run.states[[0, 7, 32]])


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"inertia": 0.0}, "inertia = 0 kg m²: it must be > 0"),
        ({"friction_moment": -1.0}, "friction_moment = -1 N m: it must be >= 0"),
        ({"static_ratio": 0.9}, "static_ratio = 0.9: it must be >= 1"),
        ({"damping": math.nan}, "damping = nan: it must be finite"),
        ({"stiffness": 1e51}, "stiffness = 1e+51 N m/rad: its size must be at most 1e+50"),
        (
            {"inertia": 1e-40, "stiffness": 1e20},
            "stiffness = 1e+20: √(stiffness/inertia) must be at most 1e+25",
        ),
        ({"moment": 3.0}, "moment[0] = 3.0: it must be (t, M), in s and N m"),
        ({"moment": [(0.0, 1.0, 2.0)]}, "moment[0] = (0.0, 1.0, 2.0): it must be (t, M), in s and N m"),
        (
            {"moment": [(1.0, 1.0), (1.0, 2.0)]},
            "moment[1] = (1.0, 2.0): the times of the points must increase",
        ),
        ({"moment": [(0.0, 1e60)]}, "moment[0] = (0.0, 1e+60): its size must be at most 1e+50"),
    ],
)
def test_invalid_joint_is_refused(change, message):
    with pytest.raises(ValueError, match=f"^{re.escape(message)}$"):
        FrictionJoint(**{"inertia": 1.0, "friction_moment": 1.0} | change)


def test_invalid_argument_of_a_joint_is_refused_and_slip_is_that_of_bodies_on_a_disc():
    pin = PinOnDisc(mass=1.0, stiffness=1.0, damping=0.0, friction_force=0.0, disc_speed=0.0)
    for arguments, options, message in (
        ((JOINT, (0.0,), [0.0]), {}, "initial_state = .*a joint takes an angle and a spin"),
        ((JOINT, (0.0, 0.0), [0.0]), {"contact": Ring(0.1)}, "a joint has no contact law"),
        ((JOINT, (0.0, 0.0), [0.0]), {"compiled": 1}, "compiled = 1: it must be True or False"),
        ((JOINT, (0.0, 0.0), [0.0]), {"tolerance": 1.0}, "tolerance = 1: it must lie between"),
        ((pin, (0.0, 0.0), [0.0]), {}, "PinOnDisc takes 4 numbers, not shape"),
    ):
        with pytest.raises(ValueError, match=message):
            simulate(*arguments, **options)
    with pytest.raises(ValueError, match="it must be a PinOnDisc or a DiscOnDisc"):
        simulate(JOINT, (0.0, 1.0), [0.0, 1.0]).slip_velocity  # noqa: B018
