"""The study of the block: its closed forms are those of the motion in time."""

import math
from dataclasses import replace

import numpy as np
import pytest
from faults.reference import simulate
from scipy.integrate import solve_ivp
from studies_under_test import engine_named

from compare.engines import Engine
from compare.studies.plane.block import study
from compare.studies.plane.block.study import STUDY
from reference_model.trajectory import Trajectory

DEGREE = np.exp(1j * math.radians(1.0))


def not_quite_against_the_slip(system, initial_state, times, *, tolerance=1e-9):
    """Friction is a degree beside the direction against the slip, while there is some."""
    if not any(initial_state[2:]):
        return simulate(system, initial_state, times, tolerance=tolerance)

    def rates(_, state):
        z, v = np.ascontiguousarray(state).view(complex)
        friction = -system.friction_force * v / max(abs(v), 1e-6) * DEGREE
        return np.array([v, (friction - system.stiffness * (z - system.offset)) / system.mass]).view(float)

    run = solve_ivp(rates, (times[0], times[-1]), initial_state, "Radau", times, rtol=1e-8, atol=1e-9)
    return Trajectory(system, np.array(times), run.y.T)


def test_who_simulates_nothing_that_turns_takes_part_in_all_of_it():
    blocks_only = Engine("blocks", engine_named("reference").function, ("block",))
    found = STUDY.measure(blocks_only)
    assert found.not_simulated == ""
    assert len(found.claims) == len(STUDY.declared)


def test_who_only_slides_is_asked_for_what_slips_all_the_time():
    sliding = Engine("sliding", engine_named("reference").function, ("block",), sticks=False)
    found = STUDY.measure(sliding)
    assert found.not_simulated == "sliding does not simulate stick"
    assert [claim.identity for claim in found.claims] == [
        "block/slows",
        "block/pulled-along",
        "block/pulled-across",
    ]


def test_the_block_on_a_spring_rests_after_four_half_swings_at_a_twentieth_of_a_millimetre():
    """By hand: 0.85, −0.65, 0.45, −0.25, 0.05 mm, and 1e4 N/m · 0.05 mm = 0.5 N < μN."""
    times = math.pi / 100.0 * np.array([0.0, 1.0, 2.0, 3.0, 4.0, 5.5])
    states = study.half_swings(study.SWINGING, 0.85e-3, times)
    assert states[:, 0] == pytest.approx([0.85e-3, -0.65e-3, 0.45e-3, -0.25e-3, 0.05e-3, 0.05e-3], abs=1e-18)
    assert states[:, 1] == pytest.approx(0.0, abs=1e-15)


@pytest.mark.parametrize("start", [1.01, 2.5, 6.3])
def test_swings_are_those_of_newtons_law_up_to_each_turning_point(start):
    """Friction changes its sign where the block turns: each half swing by an integration of its own."""
    pin = study.SPRING
    length, half = pin.friction_force / pin.stiffness, math.pi / pin.natural_frequency
    place, t = start * length, 0.0
    while abs(place) > length:
        sign = math.copysign(1.0, place)
        rates = lambda _, y, sign=sign: (  # noqa: E731
            y[1],
            (sign * pin.friction_force - pin.stiffness * y[0]) / pin.mass,
        )
        at = np.array([0.0, 0.3, 0.8, 1.0]) * half
        run = solve_ivp(rates, (0.0, half), (place, 0.0), "DOP853", at, rtol=1e-12, atol=1e-12)
        expected = study.half_swings(pin, start * length, t + at)
        np.testing.assert_allclose(run.y.T, expected, atol=1e-9)
        place, t = run.y[0, -1], t + half
    assert study.half_swings(pin, start * length, [t, 9.0 * t])[:, 0] == pytest.approx(place, abs=1e-9)


@pytest.mark.parametrize("stiffness", [0.0, study.ACROSS.stiffness, 1e4 * study.ACROSS.stiffness])
def test_the_velocity_across_a_pull_is_that_of_newtons_law_to_what_the_spring_changes(stiffness, monkeypatch):
    """The bound holds of springs that are so near that their pull changes by a hundredth, too."""
    block, times = study.ACROSS, study.TURNING

    def rates(_, y):
        z, v = y.view(complex)
        a = (block.friction_force * (1.0 - v / abs(v)) - stiffness * z) / block.mass
        return np.array([v, a]).view(float)

    run = solve_ivp(
        rates, (0.0, times[-1]), (0.0, 0.0, 0.0, study.SPEED), "DOP853", times, rtol=1e-12, atol=1e-13
    )
    monkeypatch.setattr(study, "ACROSS", replace(block, stiffness=stiffness))
    apart = np.max(np.abs(run.y[2:].T - study.across(times)))
    bound = study.bend_by_spring(times)
    assert apart <= bound + 1e-10
    assert apart >= 0.1 * bound


def test_half_of_the_speed_is_left_in_the_end():
    assert study.across([30.0])[0] == pytest.approx([0.5 * study.SPEED, 0.0], abs=1e-15)


def test_a_sliding_block_is_slowed_down_or_pulled_as_by_a_constant_force_when_the_spring_is_weak():
    block, t = replace(study.AFAR, stiffness=1e-9), np.array([0.5, 2.0])
    s, v = study.pulled(block, 1.0, 1.5e9, t).T
    assert s == pytest.approx(t + 0.25 * t**2, abs=1e-6)
    assert v == pytest.approx(1.0 + 0.5 * t, abs=1e-6)
