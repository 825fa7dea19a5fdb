"""Motions and phases of compiled runs and ensembles, against the plain reference and closed forms."""

from dataclasses import replace

import numpy as np
import pytest
from plain_engines import stuck_state

from compare.claims.parameters import FIG5, FIG5_STARTS, FIG8, FIG9, FIG11
from reference_model import DiscOnDisc, PinOnDisc, Ring, SimulationError, simulate, sticking_radius
from reference_model.ensemble import recording, simulate_ensemble, single_run
from reference_model.ensemble.disc import driver
from reference_model.motion.exact import simulate_with

SECOND = list(FIG5_STARTS.values())[1]
"""A start with nine stick phases."""

STICKING = DiscOnDisc(
    mass=1.0, polar_inertia=0.034, stiffness=1.0, damping=0.255, friction_force=0.14, disc_speed=1.2, offset=0.1,
    contact_radius=0.28, shaft_damping=0.01, shaft_speed=-0.5,
)  # fmt: skip
HARD = replace(FIG9, friction_force=2.0 * FIG9.friction_force)


def on_six(disc):
    return replace(disc, contact_points=6)


def lasting(motion):
    """Return the phases of nonzero length; the reference has empty slip phases before pivots."""
    return [phase for phase in motion.phases if phase.end - phase.start > 1e-12 * motion.times[-1]]


@pytest.mark.parametrize(
    ("system", "start", "end", "sticks"),
    [
        (FIG5, SECOND, 100.0, 9),
        (STICKING, stuck_state(STICKING, -0.08, 0.0), 100.0, 10),
        (HARD, stuck_state(HARD, -0.02, 0.0), 100.0, 1),
        (on_six(HARD), stuck_state(HARD, -0.02, 0.0), 40.0, 1),
        (on_six(FIG11), stuck_state(FIG11, 0.1, 0.0), 100.0, 0),
        (FIG8, [0.3, 0.0, 0.0, 0.1, 0.0, 0.5], 100.0, 0),
        (FIG11, [0.1, 0.0, 0.0, 0.0, 0.0, 1.0], 100.0, 0),
        (on_six(FIG11), [0.1, 0.0, 0.0, 0.0, 0.0, 1.0], 100.0, 0),
    ],
    ids=[
        "Fig. 5", "sticking ring", "ring of Fig. 9 that starts stuck", "six points of Fig. 9 that start stuck",
        "six points of Fig. 11 that pivot", "ring of Fig. 8", "ring of Fig. 11", "six points of Fig. 11",
    ],
)  # fmt: skip
def test_motion_and_phases_agree_with_the_plain_reference(system, start, end, sticks):
    times = np.linspace(0.0, end, 301)
    plain, found = simulate(system, start, times), simulate(system, start, times, compiled=True)
    assert len(plain.stick_phases) >= sticks
    # A step has an error of up to 10 % of the tolerance, and errors decay in about 30 s.
    assert np.max(np.abs(found.states - plain.states)) < 2e-8
    assert [phase.kind for phase in found.phases] == [phase.kind for phase in lasting(plain)]
    for mine, other in zip(found.phases, lasting(plain), strict=True):
        assert (mine.start, mine.end) == pytest.approx((other.start, other.end), abs=5e-8)
        np.testing.assert_allclose(mine.initial_state, other.initial_state, atol=5e-8)


@pytest.mark.parametrize(
    ("pin", "start"),
    [
        (replace(FIG5, disc_speed=-1.5), (0.3, 0.1, -0.2, 0.3)),
        (replace(FIG5, offset=-0.1), (-0.1, 0.0, -0.03, 0.0)),
        (replace(FIG5, disc_speed=0.4, friction_force=0.12), (0.3, 0.1, -0.2, 0.3)),
        (replace(FIG5, disc_speed=0.0), (0.3, 0.1, -0.2, 0.3)),
        (replace(FIG5, damping=3.0, friction_force=0.3), (0.3, -0.4, 1.0, 0.3)),
        (replace(FIG5, damping=0.0, offset=0.0), (0.3, 0.0, -0.2, 0.1)),
        (replace(FIG5, friction_force=0.0), (0.3, 0.0, -0.2, 0.1)),
        (replace(FIG5, stiffness=0.0), (0.3, 0.0, -0.2, 0.1)),
        (replace(FIG5, mass=1e-3, offset=1e3), (900.0, 0.0, 1.0, 0.0)),
        (replace(FIG5, friction_force=0.25), (0.12, 0.1, -0.15, 0.18)),
    ],
    ids=[
        "clockwise", "offset to the left", "slow disc", "disc at rest", "overdamped", "undamped, centred",
        "no friction", "no springs", "light and far", "permanently stuck",
    ],
)  # fmt: skip
def test_motion_of_other_pins_from_any_initial_time_agrees_with_the_reference(pin, start):
    rate = max(pin.natural_frequency, abs(pin.disc_speed))
    times = np.linspace(-7.0, -7.0 + 40.0 / rate, 97)
    plain = simulate(pin, start, times, tolerance=1e-11)
    found = simulate(pin, start, times, compiled=True)
    scale = max(np.hypot(*start[:2]), abs(pin.offset)) * np.array([1.0, 1.0, rate, rate])
    assert np.max(np.abs(found.states - plain.states) / scale) < 2e-8
    assert [phase.kind for phase in found.phases] == [phase.kind for phase in plain.phases]
    assert (found.phases[0].start, found.phases[-1].end) == (times[0], times[-1])
    np.testing.assert_array_equal(found.states[0], start)


@pytest.mark.parametrize(
    ("system", "start"), [(FIG5, SECOND), (on_six(FIG9), stuck_state(FIG9, -0.02, 0.0))], ids=["pin", "six points"]
)  # fmt: skip
def test_each_parameter_set_of_an_ensemble_moves_as_alone(system, start):
    rng = np.random.default_rng(2)
    varied = {"friction_force": rng.uniform(0.05, 0.15, 6), "offset": rng.uniform(-0.1, 0.2, 6)}
    together = simulate_ensemble(system, start, duration=20.0, parameters=varied, early_end=False)
    for i, (load, offset) in enumerate(zip(*varied.values(), strict=True)):
        one = replace(system, friction_force=float(load), offset=float(offset))
        alone = simulate_ensemble(one, start, duration=20.0, early_end=False)
        np.testing.assert_array_equal(together.states[i], alone.states[0])


@pytest.mark.parametrize(("system", "start"), [(FIG5, SECOND), (STICKING, stuck_state(STICKING, -0.08, 0.0))])
def test_motion_depends_neither_on_the_requested_times_nor_on_room_for_checkpoints(
    system, start, monkeypatch
):
    times = np.linspace(0.0, 60.0, 1201)
    fine = simulate(system, start, times, compiled=True)
    monkeypatch.setattr(recording, "ROOM_TO_SPARE", 0)
    coarse = simulate(system, start, times[::48], compiled=True)
    np.testing.assert_array_equal(fine.states[::48], coarse.states)
    assert fine.stick_times.tolist() == coarse.stick_times.tolist()
    assert fine.solution.steps == coarse.solution.steps


@pytest.mark.parametrize(
    ("system", "start"),
    [(FIG5, SECOND), (FIG8, [0.3, 0.0, 0.0, 0.1, 0.0, 0.5]), (on_six(FIG11), [0.1, 0.0, 0.0, 0.0, 0.0, 1.0])],
    ids=["pin", "ring", "six points"],
)
def test_single_run_and_ensemble_take_the_same_steps(system, start):
    found = simulate(system, start, [0.0, 37.3], tolerance=1e-8, compiled=True)
    alone, two = (
        simulate_ensemble(system, starts, duration=37.3, tolerance=1e-8, early_end=False)
        for starts in (start, [start, start])
    )
    assert found.solution.steps == alone.steps[0] == two.steps[1]
    np.testing.assert_array_equal(alone.states[0], two.states[1])
    assert np.max(np.abs(found.at_end - alone.states[0])) < 1e-8


def test_error_at_all_times_falls_with_the_tolerance():
    times = np.linspace(0.0, 60.0, 200)
    exact = simulate(FIG5, SECOND, times, tolerance=1e-13).states
    tolerances = np.array([1e-5, 1e-7, 1e-9])
    errors = [
        np.max(np.abs(simulate(FIG5, SECOND, times, tolerance=tolerance, compiled=True).states - exact))
        for tolerance in tolerances
    ]
    # Each step errs by the tolerance, and the number of steps is of order tolerance^(−1/8), so the slope is 7/8.
    assert np.polyfit(np.log(tolerances), np.log(errors), 1)[0] == pytest.approx(7.0 / 8.0, abs=0.25), errors


def test_run_with_a_single_time_has_its_first_phase():
    stuck = simulate(HARD, stuck_state(HARD, -0.02, 0.0), [3.0], compiled=True)
    assert [(phase.kind, phase.start, phase.end) for phase in stuck.phases] == [("stick", 3.0, 3.0)]
    assert simulate(FIG5, SECOND, [3.0], compiled=True).phases[0].kind == "slip"


def test_failed_run_reports_its_time(monkeypatch):
    monkeypatch.setattr(single_run, "ROUNDED", -0.1)  # as if the run had not reached its end
    with pytest.raises(SimulationError, match=r"the compiled run failed 50 s after its start"):
        simulate(FIG5, SECOND, [0.0, 50.0], compiled=True)


CREEPING = replace(FIG5, offset=0.0, damping=2.0, friction_force=0.1, disc_speed=0.5)
"""A pin whose slip decays like exp(−t/2) without end, by the smaller root of λ² − 2λ + 3/4 = 0."""


def as_disc(pin, points):
    """Return a disc without relative spin."""
    return DiscOnDisc(
        mass=pin.mass, stiffness=pin.stiffness, damping=pin.damping, friction_force=pin.friction_force,
        disc_speed=pin.disc_speed, offset=pin.offset, polar_inertia=0.02, contact_radius=0.2, shaft_damping=0.0,
        shaft_speed=0.0, contact_points=points,
    )  # fmt: skip


@pytest.mark.parametrize("points", ["pin", None, 6], ids=["pin", "ring", "six points"])
def test_slip_that_decays_without_end_is_followed_to_any_time(points):
    system, start = CREEPING, [0.5, 0.0, 0.0, 0.0]
    if points != "pin":
        system, start = as_disc(CREEPING, points), [0.5, 0.0, 0.0, 0.0, 0.0, 0.5]
    early = simulate(system, start, [0.0, 5.0, 10.0], compiled=True)
    assert early.states == pytest.approx(simulate(system, start, [0.0, 5.0, 10.0]).states, abs=1e-9)
    late = simulate(system, start, [0.0, 20.0, 24.0, 28.0, 32.0, 1000.0], compiled=True)
    assert [phase.kind for phase in late.phases] == ["slip"]
    assert late.solution.steps < 5000
    # s ~ exp(−t/2) to leading order; the next order is s, and rounding of x causes 1e-17/s.
    assert np.diff(np.log(late.slip_speed[1:5])) == pytest.approx(-2.0, rel=1e-4)
    assert late.radius[-1] == pytest.approx(sticking_radius(CREEPING), rel=1e-9)


def straight_swing(share, times):
    """Return position and velocity of a free pin with k = 1 from rest at 1; each half swing loses 2μN/C."""
    half = np.floor(times / np.pi)
    side = 1.0 - 2.0 * (half % 2.0)
    swing = 1.0 - (2.0 * half + 1.0) * share
    phase = times - np.pi * half
    return side * (share + swing * np.cos(phase)), -side * swing * np.sin(phase)


@pytest.mark.parametrize("tolerance", [1e-7, 1e-11])
@pytest.mark.parametrize(
    ("points", "number"), [("pin", 25), (None, 5), (6, 1)], ids=["pin", "ring", "six points"]
)
def test_oscillation_on_a_line_agrees_with_its_closed_form(points, number, tolerance):
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


def test_requested_time_costs_at_most_the_step_that_contains_it():
    """Starting again with a first step would take about 600 evaluations."""
    times = np.linspace(0.0, 50.0, 1001)
    found = simulate(LIGHT, [0.5, 0.0, 0.0, 0.0, 0.0, 0.5], times, compiled=True)
    assert found.solution.evaluations - 12 * found.solution.steps < 20 * len(times)


def test_light_disc_with_a_strong_damper_moves_by_the_balance_of_forces():
    found = simulate(LIGHT, [0.5, 0.0, 0.0, 0.0, 0.0, 0.5], [0.0, 50.0], compiled=True)
    assert found.solution.steps < 5000
    # β·v = −C·z + μN·i·z/|z| to first order in C/β and μN/β, because the slip is that of the master disc.
    z = 0.5 * np.exp(-50e-6) * np.exp(1j * 0.1 / 0.5 * 50e-6)
    assert complex(*found.at_end[:2]) == pytest.approx(z, abs=1e-9)


def test_random_pins_with_parameters_over_four_decades_take_a_bounded_number_of_steps():
    rng = np.random.default_rng(13)
    for _ in range(60):
        m, stiffness, damping, friction, speed, offset, size = 10.0 ** rng.uniform(-2.0, 2.0, 7)
        pin = PinOnDisc(
            mass=m, stiffness=stiffness, damping=damping, friction_force=friction,
            disc_speed=speed * rng.choice((-1.0, 1.0)), offset=offset * rng.choice((0.0, 1.0)),
        )  # fmt: skip
        k = pin.natural_frequency
        start = size * rng.normal(size=4) * np.array([1.0, 1.0, k, k])
        found = simulate(pin, start, [0.0, 50.0 * 2.0 * np.pi / k], compiled=True)
        assert found.solution.steps < 400_000


def test_states_between_steps_of_a_strongly_damped_pin_are_as_accurate_as_at_its_end():
    pin = PinOnDisc(
        mass=1.0, stiffness=1.0, damping=8.3458546, friction_force=0.00348404708, disc_speed=3.83354141,
        offset=2.108728,
    )  # fmt: skip
    start, times = (0.01498423, -0.0328726, 0.04863351, -0.1851470), np.linspace(0.0, 27.656, 1001)
    found = simulate(pin, start, times, compiled=True)
    for i in (90, 350, 513, 577, 800):
        end = simulate(pin, start, times[[0, i]], tolerance=1e-12).at_end
        assert found.states[i] == pytest.approx(end, abs=2e-9)


def test_creeping_ring_at_the_tightest_tolerance_comes_to_rest():
    """Slip at the level of rounding must not be extrapolated by the closed form of coming to rest."""
    disc = DiscOnDisc(
        mass=1.0, polar_inertia=0.022142264315993105, stiffness=1.0, damping=7.606038494632967, shaft_damping=0.0,
        friction_force=0.013290975255736146, disc_speed=0.26217015225390883, shaft_speed=0.06502856857572112,
        contact_radius=6.118735000726501, offset=0.0,
    )  # fmt: skip
    start = [1.19260846e-01, -5.32574504e-03, -1.80470287e-03, 8.97937173e-02, -8.01634282e-04, 5.81735776e01]
    found = simulate(disc, start, [0.0, 200.0, 300.0], tolerance=1e-12, compiled=True)
    place = (found.states[:, 0] + 1j * found.states[:, 1]) * np.exp(-1j * disc.disc_speed * found.times)
    assert abs(place[2] - place[1]) < 1e-11  # 2e-14 m/s for about 8 s


def test_disc_on_points_uses_the_plain_reference_only_until_it_slips(monkeypatch):
    disc = DiscOnDisc(
        mass=1.0, polar_inertia=0.542, stiffness=1.0, damping=2.66, friction_force=8.11, disc_speed=-0.888,
        offset=1.48, contact_radius=2.23, shaft_damping=1.26, shaft_speed=-0.381, contact_points=6,
    )  # fmt: skip
    parts = []

    def watched(*arguments, **options):
        parts.append(simulate_with(*arguments, **options))
        return parts[-1]

    monkeypatch.setattr(driver, "simulate_with", watched)
    start, times = stuck_state(disc, -4.0, 0.0), np.linspace(0.0, 40.0, 201)
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


def test_contact_law_of_the_parameters_is_accepted():
    times, start = [0.0, 3.0], stuck_state(FIG9, 0.1, 0.0)
    named = simulate(FIG9, start, times, contact=Ring(FIG9.contact_radius), compiled=True)
    np.testing.assert_array_equal(named.states, simulate(FIG9, start, times, compiled=True).states)


@pytest.mark.parametrize("hardening", [0.0, 1.0])
def test_run_is_compiled_by_default_if_the_system_allows_it(hardening):
    pin = replace(FIG5, hardening=hardening)
    method = simulate(pin, [0.1, 0.0, 0.0, 0.1], [0.0, 1.0], compiled=None).solution.method
    assert method.startswith("compiled") == (hardening == 0.0)
