"""A compiled run is the motion that the plain reference finds, at any times, phase by phase."""

import subprocess
import sys
from dataclasses import replace

import numpy as np
import pytest

from compare.claims.parameters import FIG5, FIG5_STARTS, FIG8, FIG9, FIG11
from reference_model import (
    DiscOnDisc,
    PinOnDisc,
    Ring,
    SimulationError,
    ThreeTermRing,
    simulate,
    sticking_radius,
)
from reference_model.ensemble import recording, simulate_ensemble
from reference_model.ensemble.disc import driver
from reference_model.ensemble.disc.kernel import run_points
from reference_model.motion.exact import simulate_with

SECOND = list(FIG5_STARTS.values())[1]
"""Sticks nine times."""

STICKING = DiscOnDisc(
    mass=1.0, polar_inertia=0.034, stiffness=1.0, damping=0.255, friction_force=0.14, disc_speed=1.2, offset=0.1,
    contact_radius=0.28, shaft_damping=0.01, shaft_speed=-0.5,
)  # fmt: skip
HARD = replace(FIG9, friction_force=2.0 * FIG9.friction_force)


def turning_with(disc, x):
    return [x, 0.0, 0.0, 0.0, disc.disc_speed * x, disc.disc_speed]


def on_six(disc):
    return replace(disc, contact_points=6)


def lasting(motion):
    """The phases that last: where a disc starts turning about a point the reference slips for no time."""
    return [phase for phase in motion.phases if phase.end - phase.start > 1e-12 * motion.times[-1]]


@pytest.mark.parametrize(
    ("system", "start", "end", "sticks"),
    [
        (FIG5, SECOND, 100.0, 9),
        (STICKING, turning_with(STICKING, -0.08), 100.0, 10),
        (HARD, turning_with(HARD, -0.02), 100.0, 1),
        (on_six(HARD), turning_with(HARD, -0.02), 40.0, 1),
        (on_six(FIG11), turning_with(FIG11, 0.1), 100.0, 0),
        (FIG8, [0.3, 0.0, 0.0, 0.1, 0.0, 0.5], 100.0, 0),
        (FIG11, [0.1, 0.0, 0.0, 0.0, 0.0, 1.0], 100.0, 0),
        (on_six(FIG11), [0.1, 0.0, 0.0, 0.0, 0.0, 1.0], 100.0, 0),
    ],
    ids=[
        "Fig. 5", "sticking ring", "ring of Fig. 9 that starts stuck", "six points of Fig. 9 that start stuck",
        "six points of Fig. 11 that pivot", "ring of Fig. 8", "ring of Fig. 11", "six points of Fig. 11",
    ],
)  # fmt: skip
def test_motion_and_phases_are_those_of_the_plain_reference(system, start, end, sticks):
    times = np.linspace(0.0, end, 301)
    plain, found = simulate(system, start, times), simulate(system, start, times, compiled=True)
    assert len(plain.stick_phases) >= sticks
    # Each run takes a tenth of the tolerance a step or less, and these motions forget errors in some 30 s.
    assert np.max(np.abs(found.states - plain.states)) < 2e-8
    assert [phase.kind for phase in found.phases] == [phase.kind for phase in lasting(plain)]
    for mine, other in zip(found.phases, lasting(plain), strict=True):
        assert (mine.start, mine.end) == pytest.approx((other.start, other.end), abs=5e-8)
        np.testing.assert_allclose(mine.initial_state, other.initial_state, atol=5e-8)


@pytest.mark.parametrize(
    ("pin", "start"),
    [
        (replace(FIG5, disc_speed=-1.5), (0.3, 0.1, -0.2, 0.3)),
        (replace(FIG5, disc_speed=0.0), (0.3, 0.1, -0.2, 0.3)),
        (replace(FIG5, friction_force=0.0), (0.3, 0.0, -0.2, 0.1)),
        (replace(FIG5, stiffness=0.0), (0.3, 0.0, -0.2, 0.1)),
        (replace(FIG5, mass=1e-3, offset=1e3), (900.0, 0.0, 1.0, 0.0)),
        (replace(FIG5, friction_force=0.25), (0.12, 0.1, -0.15, 0.18)),
    ],
    ids=["clockwise", "disc at rest", "no friction", "no springs", "light and far", "stuck for ever"],
)
def test_other_pins_move_as_the_reference_says_from_any_time_on(pin, start):
    rate = max(pin.natural_frequency, abs(pin.disc_speed))
    times = np.linspace(-7.0, -7.0 + 40.0 / rate, 97)
    plain = simulate(pin, start, times, tolerance=1e-11)
    found = simulate(pin, start, times, compiled=True)
    scale = max(np.hypot(*start[:2]), abs(pin.offset)) * np.array([1.0, 1.0, rate, rate])
    assert np.max(np.abs(found.states - plain.states) / scale) < 2e-8
    assert [phase.kind for phase in found.phases] == [phase.kind for phase in plain.phases]
    assert (found.phases[0].start, found.phases[-1].end) == (times[0], times[-1])
    np.testing.assert_array_equal(found.states[0], start)


@pytest.mark.parametrize(("system", "start"), [(FIG5, SECOND), (STICKING, turning_with(STICKING, -0.08))])
def test_the_times_that_are_asked_for_do_not_change_the_motion(system, start):
    times = np.linspace(0.0, 60.0, 1201)
    fine = simulate(system, start, times, compiled=True)
    coarse = simulate(system, start, times[::48], compiled=True)
    np.testing.assert_array_equal(fine.states[::48], coarse.states)
    assert fine.stick_times.tolist() == coarse.stick_times.tolist()
    assert fine.solution.steps == coarse.solution.steps


def test_too_little_room_for_checkpoints_at_first_does_not_change_the_motion(monkeypatch):
    times = np.linspace(0.0, 60.0, 3)
    usual = simulate(FIG5, SECOND, times, compiled=True)
    monkeypatch.setattr(recording, "ROOM_TO_SPARE", 0)
    found = simulate(FIG5, SECOND, times, compiled=True)
    np.testing.assert_array_equal(found.states, usual.states)
    assert found.stick_times.tolist() == usual.stick_times.tolist()


@pytest.mark.parametrize(
    ("system", "start"),
    [(FIG5, SECOND), (FIG8, [0.3, 0.0, 0.0, 0.1, 0.0, 0.5]), (on_six(FIG11), [0.1, 0.0, 0.0, 0.0, 0.0, 1.0])],
    ids=["pin", "ring", "six points"],
)
def test_a_tolerance_means_the_same_steps_in_a_single_run_and_in_an_ensemble(system, start):
    found = simulate(system, start, [0.0, 37.3], tolerance=1e-8, compiled=True)
    ensemble = simulate_ensemble(system, start, duration=37.3, tolerance=1e-8, early_end=False)
    assert found.solution.steps == ensemble.steps[0]
    assert np.max(np.abs(found.at_end - ensemble.states[0])) < 1e-8


def test_the_error_falls_with_the_tolerance_at_all_times():
    times = np.linspace(0.0, 60.0, 200)
    exact = simulate(FIG5, SECOND, times, tolerance=1e-13).states
    tolerances = np.array([1e-5, 1e-7, 1e-9])
    errors = [
        np.max(np.abs(simulate(FIG5, SECOND, times, tolerance=tolerance, compiled=True).states - exact))
        for tolerance in tolerances
    ]
    # An error per step of the tolerance and steps that grow like tolerance^(−1/8): slope 7/8.
    assert np.polyfit(np.log(tolerances), np.log(errors), 1)[0] == pytest.approx(7.0 / 8.0, abs=0.25), errors


def test_a_single_time_tells_in_which_phase_the_motion_begins():
    stuck = simulate(HARD, turning_with(HARD, -0.02), [3.0], compiled=True)
    assert [(phase.kind, phase.start, phase.end) for phase in stuck.phases] == [("stick", 3.0, 3.0)]
    assert simulate(FIG5, SECOND, [3.0], compiled=True).phases[0].kind == "slip"


@pytest.mark.parametrize(
    ("system", "options", "message"),
    [
        (replace(FIG5, hardening=2.0), {}, "hardening = 2: compiled runs need a linear support"),
        (
            replace(FIG9, stop_gap=0.1, stop_stiffness=3.0), {},
            "stop_stiffness = 3: compiled runs need a linear support",
        ),
        (replace(FIG9, contact_points=25), {}, "contact_points = 25: compiled runs support up to 24"),
        (FIG9, {"contact": ThreeTermRing(0.1)}, "compiled runs support only the law of the system's parameters"),
        (FIG5, {"contact": Ring(0.1)}, "a pin has point contact"),
        (FIG5, {"tolerance": 1.0}, "tolerance = 1: it must lie between"),
        (FIG5, {"times": [0.0, -1.0]}, "times must increase"),
        (FIG5, {"initial_state": [0.0]}, "initial_state"),
        ("pin", {}, "it must be a PinOnDisc or a DiscOnDisc"),
    ],
)  # fmt: skip
def test_what_compiled_code_does_not_know_is_refused_by_name(system, options, message):
    size = system.state_size if isinstance(system, (PinOnDisc, DiscOnDisc)) else 4
    arguments = {"initial_state": [0.1] * size, "times": [0.0, 1.0]} | options
    with pytest.raises(ValueError, match=message):
        simulate(system, compiled=True, **arguments)


def test_a_run_that_is_given_up_says_when(monkeypatch):
    monkeypatch.setattr(recording, "ROUNDED", -0.1)  # as if it had not come to its end
    with pytest.raises(SimulationError, match=r"the compiled run failed 50 s after its start"):
        simulate(FIG5, SECOND, [0.0, 50.0], compiled=True)


CREEPING = replace(FIG5, offset=0.0, damping=2.0, friction_force=0.1, disc_speed=0.5)
"""Slip dies out like exp(−t/2) for ever: the smaller root of λ² − 2λ + 3/4 = 0, see ``pin_slip.creeps_steadily``."""


def as_disc(pin, points):
    """A disc that does not turn against the master disc, so that its centre moves as the pin does."""
    return DiscOnDisc(
        mass=pin.mass, stiffness=pin.stiffness, damping=pin.damping, friction_force=pin.friction_force,
        disc_speed=pin.disc_speed, offset=pin.offset, polar_inertia=0.02, contact_radius=0.2, shaft_damping=0.0,
        shaft_speed=0.0, contact_points=points,
    )  # fmt: skip


def slip_of(motion):
    n = motion.states.shape[1] // 2
    omega, (x, y), (vx, vy) = motion.system.disc_speed, motion.states.T[:2], motion.states.T[n : n + 2]
    return np.hypot(vx + omega * y, vy - omega * x)


@pytest.mark.parametrize("points", ["pin", None, 6], ids=["pin", "ring", "six points"])
def test_slip_that_dies_out_for_ever_is_followed_to_any_time(points):
    system, start = CREEPING, [0.5, 0.0, 0.0, 0.0]
    if points != "pin":
        system, start = as_disc(CREEPING, points), [0.5, 0.0, 0.0, 0.0, 0.0, 0.5]
    early = simulate(system, start, [0.0, 5.0, 10.0], compiled=True)
    assert early.states == pytest.approx(simulate(system, start, [0.0, 5.0, 10.0]).states, abs=1e-9)
    late = simulate(system, start, [0.0, 20.0, 24.0, 28.0, 32.0, 1000.0], compiled=True)
    assert [phase.kind for phase in late.phases] == ["slip"]
    assert late.solution.steps < 5000
    # To leading order s ~ exp(−t/2): what is left out is of the order of s itself, and rounding of x of 1e-17/s.
    assert np.diff(np.log(slip_of(late)[1:5])) == pytest.approx(-2.0, rel=1e-4)
    assert late.radius[-1] == pytest.approx(sticking_radius(CREEPING), rel=1e-9)


def straight_swing(share, times):
    """Place and velocity of a free pin with k = 1 that starts at rest in 1: each half swing loses 2μN/C exactly."""
    half = np.floor(times / np.pi)
    side = 1.0 - 2.0 * (half % 2.0)
    swing = 1.0 - (2.0 * half + 1.0) * share
    phase = times - np.pi * half
    return side * (share + swing * np.cos(phase)), -side * swing * np.sin(phase)


@pytest.mark.parametrize("tolerance", [1e-7, 1e-9, 1e-11])
@pytest.mark.parametrize(
    ("points", "number"), [("pin", 100), (None, 10), (4, 10)], ids=["pin", "ring", "four points"]
)
def test_what_reverses_on_a_line_loses_what_the_closed_form_says(points, number, tolerance):
    rng = np.random.default_rng(35)
    errors = []
    for share, angle in zip(
        10.0 ** rng.uniform(-3.0, -1.5, number), rng.uniform(0.0, 6.28, number), strict=True
    ):
        along = np.array([np.cos(angle), np.sin(angle)])
        times = np.linspace(0.0, min(200.0, np.pi * (0.5 / share - 0.5)), 50)  # until it sticks
        system = PinOnDisc(
            mass=1.0, stiffness=1.0, damping=0.0, friction_force=share, disc_speed=0.0, offset=0.0
        )
        system = system if points == "pin" else as_disc(system, points)
        start = np.zeros(system.state_size)
        start[:2] = along
        states = simulate(system, start, times, tolerance=tolerance, compiled=True).states
        x, v = straight_swing(share, times)
        at = system.state_size // 2
        errors += [states[:, :2] - np.outer(x, along), states[:, at : at + 2] - np.outer(v, along)]
    assert np.max(np.abs(errors)) < 26.0 * tolerance


LIGHT = replace(as_disc(CREEPING, None), mass=1e-6, contact_radius=1e3, damping=1e6)


def test_each_time_that_is_asked_for_takes_no_more_than_the_step_in_which_it_lies():
    """From a first step anew, as a trajectory begins, it would take some 600 evaluations."""
    times = np.linspace(0.0, 50.0, 1001)
    found = simulate(LIGHT, [0.5, 0.0, 0.0, 0.0, 0.0, 0.5], times, compiled=True)
    assert found.solution.evaluations - 12 * found.solution.steps < 20 * len(times)


def test_a_light_disc_with_a_strong_damper_moves_as_slowly_as_the_balance_of_forces_says():
    found = simulate(LIGHT, [0.5, 0.0, 0.0, 0.0, 0.0, 0.5], [0.0, 50.0], compiled=True)
    assert found.solution.steps < 5000
    # β·v = −C·z + μN·i·z/|z| (the slip is that of the master disc below) to the first order in C/β and μN/β.
    z = 0.5 * np.exp(-50e-6) * np.exp(1j * 0.1 / 0.5 * 50e-6)
    assert complex(*found.at_end[:2]) == pytest.approx(z, abs=1e-9)


def test_random_pins_within_four_decades_of_every_parameter_are_followed_through_50_periods():
    rng = np.random.default_rng(13)
    for _ in range(150):
        m, stiffness, damping, friction, speed, offset, size = 10.0 ** rng.uniform(-2.0, 2.0, 7)
        pin = PinOnDisc(
            mass=m, stiffness=stiffness, damping=damping, friction_force=friction,
            disc_speed=speed * rng.choice((-1.0, 1.0)), offset=offset * rng.choice((0.0, 1.0)),
        )  # fmt: skip
        k = pin.natural_frequency
        start = size * rng.normal(size=4) * np.array([1.0, 1.0, k, k])
        found = simulate(pin, start, [0.0, 50.0 * 2.0 * np.pi / k], compiled=True)
        assert found.solution.steps < 400_000


def test_states_between_steps_that_strong_damping_shortens_are_as_accurate_as_ends():
    pin = PinOnDisc(
        mass=1.0, stiffness=1.0, damping=8.3458546, friction_force=0.00348404708, disc_speed=3.83354141,
        offset=2.108728,
    )  # fmt: skip
    start, times = (0.01498423, -0.0328726, 0.04863351, -0.1851470), np.linspace(0.0, 27.656, 1001)
    found = simulate(pin, start, times, compiled=True)
    for i in (90, 350, 513, 577, 800):
        end = simulate(pin, start, times[[0, i]], tolerance=1e-12).at_end
        assert found.states[i] == pytest.approx(end, abs=2e-9)


def test_a_creeping_ring_at_the_tightest_tolerance_stays_where_friction_comes_to_hold_it():
    """Slip as slow as rounding must not be followed by the closed form of coming to rest for as long as it lasts."""
    disc = DiscOnDisc(
        mass=1.0, polar_inertia=0.022142264315993105, stiffness=1.0, damping=7.606038494632967, shaft_damping=0.0,
        friction_force=0.013290975255736146, disc_speed=0.26217015225390883, shaft_speed=0.06502856857572112,
        contact_radius=6.118735000726501, offset=0.0,
    )  # fmt: skip
    start = [1.19260846e-01, -5.32574504e-03, -1.80470287e-03, 8.97937173e-02, -8.01634282e-04, 5.81735776e01]
    found = simulate(disc, start, [0.0, 200.0, 300.0], tolerance=1e-12, compiled=True)
    place = (found.states[:, 0] + 1j * found.states[:, 1]) * np.exp(-1j * disc.disc_speed * found.times)
    assert abs(place[2] - place[1]) < 1e-11  # some 8 s at 2e-14 m/s are left


def test_a_disc_that_is_handed_over_and_back_needs_no_other_code_than_one_that_is_not():
    simulate(on_six(FIG11), [0.1, 0.0, 0.0, 0.0, 0.0, 1.0], [0.0, 1.0], compiled=True)
    known = len(run_points.kinds)
    found = simulate(on_six(HARD), turning_with(HARD, -0.02), [0.0, 40.0], compiled=True)
    assert found.stick_phases
    assert found.phases[-1].kind == "slip"
    assert len(run_points.kinds) == known


def test_a_disc_on_points_is_with_the_plain_reference_only_until_it_slips(monkeypatch):
    disc = DiscOnDisc(
        mass=1.0, polar_inertia=0.542, stiffness=1.0, damping=2.66, friction_force=8.11, disc_speed=-0.888,
        offset=1.48, contact_radius=2.23, shaft_damping=1.26, shaft_speed=-0.381, contact_points=6,
    )  # fmt: skip
    parts = []

    def watched(*arguments, **options):
        parts.append(simulate_with(*arguments, **options))
        return parts[-1]

    monkeypatch.setattr(driver, "simulate_with", watched)
    start, times = turning_with(disc, -4.0), np.linspace(0.0, 60.0, 301)
    found, tight = (
        simulate(disc, start, times, tolerance=tolerance, compiled=compiled)
        for tolerance, compiled in ((1e-9, True), (1e-11, False))
    )
    slips = [phase.end - phase.start for phase in found.phases[:-1] if phase.kind == "slip"]
    by_reference = [p.end - p.start for part in parts for p in part.phases if p.kind == "slip"]
    assert len(slips) > 5
    assert sum(by_reference) < 0.4 * sum(slips)
    assert len(parts) <= len(found.stick_phases) + 1
    assert np.max(np.abs(found.states - tight.states)) < 1e-8  # of 4 m and 3.5 m/s


def test_a_single_run_takes_the_steps_of_one_lane_to_the_same_bits():
    for system, start in (
        (FIG5, SECOND),
        (FIG8, [0.3, 0.0, 0.0, 0.1, 0.0, 0.5]),
        (on_six(FIG11), [0.1, 0.0, 0.0, 0.0, 0.0, 1.0]),
    ):
        alone = simulate_ensemble(system, start, duration=37.3, early_end=False)
        beside = simulate_ensemble(system, [start, start], duration=37.3, early_end=False)
        assert alone.steps[0] == beside.steps[1]
        np.testing.assert_array_equal(alone.states[0], beside.states[1])


def test_the_law_of_the_parameters_may_be_named():
    times, start = [0.0, 3.0], turning_with(FIG9, 0.1)
    named = simulate(FIG9, start, times, contact=Ring(FIG9.contact_radius), compiled=True)
    np.testing.assert_array_equal(named.states, simulate(FIG9, start, times, compiled=True).states)


def test_the_plain_reference_starts_without_the_compiler():
    code = "import sys, reference_model; sys.exit('numba' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0


def test_a_run_is_compiled_where_it_can_be_if_none_says_how():
    start, times = [0.1, 0.0, 0.0, 0.1], [0.0, 1.0]
    known, unknown = FIG5, replace(FIG5, hardening=1.0)
    methods = {
        pin: simulate(pin, start, times, compiled=None).solution.method.startswith("compiled")
        for pin in (known, unknown)
    }
    assert methods == {known: True, unknown: False}
