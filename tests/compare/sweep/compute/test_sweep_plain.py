"""Ends that the plain reference finds."""

from dataclasses import replace

import numpy as np
import pytest

from compare.claims.parameters import CENTRED, FIG5, FIG5_STARTS, FIG11
from compare.sweep.compute import work
from compare.sweep.compute.work import (
    DOUBLINGS,
    LEAST_TURNS,
    end_of,
    plain_trajectory,
    recompute,
    twice_as_long,
    watched_until,
)
from compare.sweep.plan import RandomBasin
from compare.sweep.quantities import Axis
from reference_model import PinOnDisc, simulate, sticking_radius, whirls
from reference_model.ensemble import EndState, simulate_ensemble


def end(system, start, duration, tolerance=1e-9):
    return end_of(plain_trajectory(system, np.array(start), 0.3 * duration, duration, tolerance))


MIRRORED = tuple(value * sign for value, sign in zip(FIG5_STARTS["whirl"], (1, -1, 1, -1), strict=True))
HELD = replace(FIG5, friction_force=0.15, disc_speed=0.8)
RADIUS = 0.9 * sticking_radius(HELD)
STICKING = replace(FIG5, friction_force=0.124, disc_speed=0.8), (0.1, 0.0, 0.03, 0.0)
SLIPPING = FIG5, FIG5_STARTS["whirl"]

ENDS = {
    "at rest in space": (FIG5, FIG5_STARTS["equilibrium"], 300.0, EndState.SELF_CENTRED),
    "whirl": (*SLIPPING, 300.0, EndState.WHIRL),
    "not yet a whirl": (*SLIPPING, 100.0, EndState.UNDECIDED),
    "whirl the other way": (replace(FIG5, disc_speed=-1.5), MIRRORED, 300.0, EndState.WHIRL),
    "whirl without offset": (CENTRED, whirls(CENTRED)[0].state, 60.0, EndState.WHIRL),
    "stuck": (HELD, (RADIUS, 0.0, 0.0, 0.8 * RADIUS), 60.0, EndState.STUCK),
    "stuck the other way": (
        replace(HELD, disc_speed=-0.8), (RADIUS, 0.0, 0.0, -0.8 * RADIUS), 60.0, EndState.STUCK,
    ),
    "sticks beyond the sticking radius": (*STICKING, 300.0, EndState.STICK_SLIP),
}  # fmt: skip


@pytest.mark.parametrize(("system", "start", "duration", "expected"), ENDS.values(), ids=ENDS)
def test_the_end_is_that_of_the_theory(system, start, duration, expected):
    assert end(system, start, duration) == expected


def test_the_modulated_cycle_of_fig_11():
    assert end(FIG11, (0.02, 0.0, 0.0, 0.0, 0.0, 1.3), 1500.0, 1e-6) == EndState.MODULATED


@pytest.mark.parametrize("duration", [20.0, 200.0])
def test_a_pin_that_creeps_to_the_sticking_radius_is_not_a_whirl(duration):
    # β² > 4m(C − mω²): slip dies out like exp(−λt), λ = 0.92/s, and never ends.
    pin = PinOnDisc(mass=1.0, stiffness=4.0, damping=5.0, friction_force=0.4, disc_speed=0.5)
    start = (0.12, 0.0, 0.0, 0.06)
    assert end(pin, start, duration) == EndState.STUCK
    assert simulate_ensemble(pin, start, duration=duration).end.tolist() == [EndState.STUCK]


@pytest.mark.parametrize(("system", "start"), [STICKING, SLIPPING], ids=["sticking", "slipping"])
def test_a_continued_motion_equals_one_simulated_at_once(system, start):
    motion = twice_as_long(plain_trajectory(system, np.array(start), 3.0, 30.0, 1e-10))
    assert motion.times[[0, -1]].tolist() == [0.0, 60.0]
    assert 3.0 in motion.times
    assert np.all(np.diff(motion.times) > 0.0)
    at_once = simulate(system, start, motion.times, tolerance=1e-10)
    np.testing.assert_allclose(motion.states, at_once.states, atol=1e-7)
    ends = [phase.end for phase in motion.phases]
    assert [0.0, *ends] == [*(phase.start for phase in motion.phases), 60.0]  # without gaps


FIRST = 2.0 * LEAST_TURNS * 2.0 * np.pi / FIG5.disc_speed
"""Shortest duration of a check in s."""

CHECKS = [
    ("whirl", 200.0, EndState.WHIRL, EndState.WHIRL, [400.0]),
    ("whirl", 50.0, EndState.UNDECIDED, EndState.UNDECIDED, [50.0]),
    ("equilibrium", 1.0, EndState.STUCK, EndState.SELF_CENTRED, FIRST * 2.0 ** np.arange(DOUBLINGS + 1)),
]


@pytest.mark.parametrize(("start", "time", "by_kernel", "expected", "simulated"), CHECKS)
def test_a_check_takes_twice_the_kernels_time_and_doubles_it_before_an_end_counts_as_different(
    start, time, by_kernel, expected, simulated, monkeypatch
):
    durations = []

    def watching(function):
        def watched(*arguments):
            durations.append(float((motion := function(*arguments)).times[-1]))
            return motion

        return watched

    for function in (plain_trajectory, twice_as_long):
        monkeypatch.setattr(work, function.__name__, watching(function))
    x, y = Axis("y", 0.0, 1e-9, 2), Axis("vy", 0.0, 1e-9, 2)
    common = {"system": FIG5, "duration": 12000.0, "tolerance": 1e-9, "seed": 1}
    plan = RandomBasin(**common, start=FIG5_STARTS[start], x=x, y=y, samples=1)
    found = recompute(plan, 0, time, by_kernel)
    assert found.end == expected
    np.testing.assert_allclose(durations, simulated)
    at_time = simulate(FIG5, FIG5_STARTS[start], [0.0, time]).states[-1]
    np.testing.assert_allclose(found.state, at_time, atol=1e-7)


def test_a_motion_without_turns_is_checked_too():
    resting = replace(FIG5, stiffness=1e-300, disc_speed=0.0)
    assert watched_until(resting, 0.0, 7.0) == 2.0 * LEAST_TURNS * 2.0 * np.pi * 7.0
