"""End states of pins, against runs of full length and the plain reference."""

from dataclasses import replace

import numpy as np
import pytest
from plain_engines import in_units, stuck_state
from scipy.integrate import trapezoid

from compare.claims.parameters import FIG5
from reference_model import (
    PinOnDisc,
    boundary_point,
    self_centred_equilibria,
    simulate,
    stick_slip_orbits,
    sticking_radius,
    whirl_branch,
    whirl_orbit,
    whirls,
)
from reference_model.ensemble import EndState, simulate_ensemble
from reference_model.ensemble.core import laws
from reference_model.ensemble.core.recurrence import converged
from reference_model.ensemble.pin.end_states import (
    depth,
    equilibrium_region,
    orbit_attracts,
    return_derivative,
)
from reference_model.formulas.pin import equilibrium_position

ACCURACY = 1e-4
"""Relative distance from a periodic motion that may remain."""

STICKS = replace(FIG5, friction_force=0.3, disc_speed=0.6)
STICK_SLIP = replace(FIG5, damping=1.173, friction_force=0.658, disc_speed=1.8, offset=-0.42)
CREEPS = replace(FIG5, damping=0.85, friction_force=0.56, disc_speed=-0.46, offset=-0.07)


def starts(n, reach, seed=0):
    return np.random.default_rng(seed).uniform(-reach, reach, (n, 4))


@pytest.mark.parametrize(
    ("pin", "reach", "duration", "expected"),
    [
        (replace(FIG5, disc_speed=-1.5, offset=-0.1), 0.4, 400.0, {"SELF_CENTRED", "WHIRL"}),
        (replace(FIG5, offset=0.0), 0.4, 400.0, {"STUCK", "WHIRL"}),
        (replace(FIG5, disc_speed=0.7), 1.0, 400.0, {"SELF_CENTRED"}),
        (STICKS, 1.0, 400.0, {"STUCK"}),
        (CREEPS, 2.0, 200.0, {"STUCK"}),
        (STICK_SLIP, 1.0, 300.0, {"STICK_SLIP", "STUCK"}),
        (replace(FIG5, friction_force=0.0), 1.0, 400.0, {"SELF_CENTRED"}),
        (replace(FIG5, friction_force=0.0, damping=0.0), 1.0, 100.0, {"UNDECIDED"}),
        (replace(FIG5, damping=0.0), 1.0, 100.0, {"UNDECIDED"}),
    ],
    ids=[
        "Fig. 5 mirrored", "centred", "slow disc", "sticks", "creeps", "stick and slip", "no friction",
        "no friction, no damping", "no damping",
    ],
)  # fmt: skip
def test_early_end_states_agree_with_runs_of_full_length(pin, reach, duration, expected):
    states = starts(200, reach)
    early = simulate_ensemble(pin, states, duration=duration)
    full = simulate_ensemble(pin, states, duration=duration, early_end=False)
    without_known_ends = simulate_ensemble(
        pin, states, duration=duration, parameters={"mass": np.ones(len(states))}
    )
    assert {EndState(end).name for end in early.end} == expected
    # A motion that creeps or passes near a boundary may be undecided at the end of the run.
    for other in (full, without_known_ends):
        decided = (other.end != EndState.UNDECIDED) & (early.end != EndState.UNDECIDED)
        np.testing.assert_array_equal(early.end[decided], other.end[decided])
        assert decided.mean() > 0.95 or expected == {"UNDECIDED"}
    if expected != {"UNDECIDED"}:
        # A stuck pin takes no steps.
        assert early.steps.sum() < 0.7 * full.steps.sum() or expected == {"STUCK"}
    assert np.all(full.time == duration)
    np.testing.assert_array_equal(np.isnan(early.slip_power), early.end == EndState.UNDECIDED)


def test_radii_and_power_of_the_whirl_agree_with_shooting():
    orbit = whirl_orbit(FIG5, samples=2048)
    found = simulate_ensemble(FIG5, [0.5, 0.0, 0.3, 0.3], duration=400.0)
    radius = orbit.trajectory.radius
    assert found.end[0] == EndState.WHIRL
    # The extremes of samples have an error of second order in their distance.
    assert found.least_radius[0] == pytest.approx(radius.min(), abs=2e-6)
    assert found.largest_radius[0] == pytest.approx(radius.max(), abs=2e-6)
    slip = orbit.trajectory.slip_speed[:-1]
    assert found.slip_power[0] == pytest.approx(FIG5.friction_force * slip.mean(), rel=1e-7)
    known = {"offset": [FIG5.offset]}  # without neighbourhoods of end states, which are those of one system
    other = simulate_ensemble(FIG5, [0.5, 0.0, 0.3, 0.3], duration=400.0, parameters=known)
    for name in ("least_radius", "largest_radius", "slip_power"):
        assert getattr(other, name)[0] == pytest.approx(getattr(found, name)[0], rel=2.0 * ACCURACY)


def test_radii_of_periodic_motions_agree_with_the_reference():
    rng = np.random.default_rng(11)
    n = 80
    varied = {
        "damping": rng.uniform(0.2, 0.6, n), "friction_force": rng.uniform(0.03, 0.3, n),
        "disc_speed": rng.choice((-1.0, 1.0), n) * rng.uniform(1.2, 2.5, n), "offset": rng.uniform(0.02, 0.2, n),
    }  # fmt: skip
    found = simulate_ensemble(FIG5, starts(n, 1.0), duration=1000.0, parameters=varied)
    periodic = np.flatnonzero((found.end == EndState.WHIRL) | (found.end == EndState.STICK_SLIP))
    assert len(periodic) > 40
    for i in periodic[::8]:
        pin = replace(FIG5, **{name: float(values[i]) for name, values in varied.items()})
        # A whirl takes one turn of the pin or disc, whichever is slower, and a cycle with stick up to two.
        times = np.linspace(0.0, 4.0 * np.pi, 2001)
        radius = simulate(pin, found.states[i], times, tolerance=1e-10).radius
        assert found.least_radius[i] == pytest.approx(radius.min(), rel=ACCURACY)
        assert found.largest_radius[i] == pytest.approx(radius.max(), rel=ACCURACY)


def test_power_of_a_stick_slip_cycle_agrees_with_the_reference():
    found = simulate_ensemble(STICK_SLIP, [0.5, 0.0, 0.3, 0.3], duration=400.0)
    assert found.end[0] == EndState.STICK_SLIP
    times = np.linspace(0.0, 20.0, 10_001)
    trajectory = simulate(STICK_SLIP, found.states[0], times, tolerance=1e-10)
    first, last = (phase.end for phase in trajectory.stick_phases[-3:-1])
    cycle = (times >= first) & (times <= last)
    power = STICK_SLIP.friction_force * trapezoid(trajectory.slip_speed[cycle], times[cycle]) / (last - first)
    assert found.slip_power[0] == pytest.approx(power, rel=1e-3)


def test_motions_and_end_states_do_not_depend_on_units():
    length, time, mass = 2.0**20, 2.0**-9, 2.0**-5  # without rounding
    states = starts(50, 0.4)
    scaled = in_units(FIG5, mass, length, time)
    size = np.array([length, length, length / time, length / time])
    for early_end in (False, True):
        one = simulate_ensemble(FIG5, states, duration=300.0, early_end=early_end)
        other = simulate_ensemble(scaled, states * size, duration=300.0 * time, early_end=early_end)
        np.testing.assert_array_equal(one.end, other.end)
        np.testing.assert_allclose(other.states / size, one.states, rtol=0.0, atol=1e-10)
        np.testing.assert_allclose(other.least_radius / length, one.least_radius, rtol=1e-7)
        np.testing.assert_allclose(other.slip_power, one.slip_power * mass * length**2 / time**3, rtol=1e-7)


# The first pin has no offset. It slips more and more slowly and never rests. The others slip briefly in each turn.
OVERDAMPED = replace(FIG5, stiffness=15.0, damping=9.0, friction_force=12.0, disc_speed=1.0, offset=0.0)
WEAKLY_DAMPED = replace(FIG5, damping=0.128, friction_force=0.2424, disc_speed=-0.26, offset=-0.2275)
STRONGLY_DAMPED = replace(FIG5, damping=4.5, friction_force=0.19, disc_speed=0.41, offset=-0.16)
CENTRED = replace(FIG5, offset=0.0)


def beyond(pin, share, slip=(0.0, 0.0)):
    """Return a start at a ``share`` of the sticking radius."""
    return stuck_state(pin, share * sticking_radius(pin), 0.0) + np.array([0.0, 0.0, *slip])


@pytest.mark.parametrize(
    ("pin", "start", "duration", "end", "radius"),
    [
        (FIG5, [0.1, 0.0, 0.0, 0.0], 400.0, "SELF_CENTRED", np.hypot(*equilibrium_position(FIG5))),
        (STICKS, [0.05, 0.0, 0.0, 0.03], 400.0, "STUCK", 0.05),
        (OVERDAMPED, [0.9, -1.7, 8.0, -60.0], 60.0, "STUCK", sticking_radius(OVERDAMPED)),
        (WEAKLY_DAMPED, beyond(WEAKLY_DAMPED, 1.001), 400.0, "STUCK", sticking_radius(WEAKLY_DAMPED)),
        (STRONGLY_DAMPED, beyond(STRONGLY_DAMPED, 1.08), 150.0, "STUCK", sticking_radius(STRONGLY_DAMPED)),
        # Slip leads outward to the whirl, because ω > k.
        *(
            (CENTRED, beyond(CENTRED, 1.03, slip), 600.0, "WHIRL", 0.9)
            for slip in ((1e-9, 0.0), (0.0, -1e-9))
        ),
    ],
)
def test_end_state_is_found_early_with_the_radius_and_power_of_its_closed_form(
    pin, start, duration, end, radius
):
    early, full = (
        simulate_ensemble(pin, start, duration=duration, early_end=early) for early in (True, False)
    )
    assert early.end[0] == full.end[0] == EndState[end]
    assert early.time[0] < full.time[0] == duration
    accuracy = ACCURACY if end == "WHIRL" else 1e-12
    assert (early.least_radius[0], early.largest_radius[0]) == pytest.approx((radius, radius), rel=accuracy)
    slip = {"STUCK": 0.0, "SELF_CENTRED": pin.disc_speed * radius, "WHIRL": (pin.disc_speed - 1.0) * radius}[
        end
    ]
    assert early.slip_power[0] == pytest.approx(pin.friction_force * slip, rel=2.0 * accuracy)


@pytest.mark.parametrize(("offset", "share"), [(0.0, 1.04), (0.24, 3.5)])
def test_fast_slip_inward_ends_where_the_reference_rests(offset, share):
    pin = replace(FIG5, damping=0.03, friction_force=0.25, disc_speed=0.3, offset=offset)
    start = stuck_state(pin, share * sticking_radius(pin), 0.0)
    found = simulate_ensemble(pin, start, duration=600.0)
    motion = simulate(pin, start, [0.0, 600.0], tolerance=1e-10)
    assert found.end[0] == EndState.STUCK
    assert found.largest_radius[0] == pytest.approx(np.hypot(*motion.at_end[:2]), rel=1e-6)
    assert found.largest_radius[0] < 0.999 * sticking_radius(pin)


def test_pin_that_still_creeps_at_the_end_is_stuck_at_its_final_radius():
    pin = replace(FIG5, damping=30.0, friction_force=0.05, disc_speed=0.25, offset=0.0)
    creeping, early = (simulate_ensemble(pin, [0.3, 0.0, 0.0, 0.0], duration=time) for time in (250.0, 150.0))
    assert creeping.end[0] == EndState.STUCK
    assert creeping.largest_radius[0] == pytest.approx(sticking_radius(pin), rel=1e-12)
    late = simulate(pin, [0.3, 0.0, 0.0, 0.0], [0.0, 250.0, 1000.0])
    assert late.radius[1] > 1.005 * sticking_radius(pin)  # still far from the final radius
    assert late.radius[2] == pytest.approx(sticking_radius(pin), rel=1e-9)
    assert early.end[0] == EndState.UNDECIDED  # the slip has not yet turned towards the pull


def law_of(pin):
    return laws.PinLaw(pin.stiffness, pin.damping, pin.friction_force, pin.disc_speed, pin.offset, 0.03, 0.0)


@pytest.mark.parametrize("pin", [replace(FIG5, disc_speed=-0.4, offset=-0.2), replace(FIG5, damping=2.5)])
def test_lyapunov_form_falls_along_all_motions_within_its_level(pin):
    law = law_of(pin)
    well = equilibrium_region(law)
    about = well.place, well.form
    (equilibrium,) = self_centred_equilibria(pin)
    assert well.place == pytest.approx(complex(equilibrium.x, equilibrium.y), rel=1e-12)
    assert well.level > 0.0
    turn = 1j * pin.disc_speed
    rng = np.random.default_rng(4)
    for _ in range(100):
        z, v = well.place + complex(*rng.normal(size=2)), complex(*rng.normal(size=2))
        share = np.sqrt(well.level / depth(z, v - turn * z, law, *about)) * rng.uniform(0.01, 1.0)
        z, v = well.place + share * (z - well.place), share * v
        w = v - turn * z
        a = -pin.stiffness * (z - pin.offset) - pin.damping * v - pin.friction_force * w / abs(w)
        h = 1e-3
        ahead, behind = (depth(z + s * v, v + s * a - turn * (z + s * v), law, *about) for s in (h, -h))
        assert ahead < behind  # the difference of a quadratic form is its rate


def test_distances_that_do_not_shrink_do_not_count_as_converged():
    assert converged(1e-5, 2e-5, 4e-5, 1.0)
    assert not converged(1e-3, 2e-3, 4e-3, 1.0)
    assert not converged(1e-5, 1e-5, 4e-5, 1.0)
    assert not converged(1e-5, 4e-5, 1e-5, 1.0)
    assert converged(1e-8, 3e-8, 2e-8, 1.0)
    assert not converged(3e-8, 2e-8, 1e-8, 1.0)  # near a saddle


def test_starts_next_to_the_basin_boundary_end_on_their_own_side():
    """Motions that start near the boundary first approach the saddle."""
    (saddle,) = (orbit for orbit in stick_slip_orbits(FIG5) if not orbit.stable)
    middle = boundary_point(saddle, [0.1, 0.0, 0.0, 0.0], [0.1, 0.0, 0.03, 0.0])
    aside = np.geomspace(1e-9, 1e-5, 5)
    for sign, end in ((-1.0, EndState.SELF_CENTRED), (1.0, EndState.WHIRL)):
        starts = np.tile(middle, (len(aside), 1))
        starts[:, 2] += sign * aside
        assert np.all(simulate_ensemble(FIG5, starts, duration=1000.0, tolerance=1e-12).end == end)


@pytest.fixture(scope="module")
def about_the_fold():
    """Return whirls without stick at different loads: stable ones, the fold and unstable ones."""
    return list(whirl_branch(whirl_orbit(FIG5, samples=512), 0.28, samples=512))


def test_return_map_of_whirls_has_the_multipliers_from_shooting(about_the_fold):
    assert {orbit.stable for orbit in about_the_fold} == {True, False}
    for orbit in about_the_fold[::4]:
        rightmost = np.argmax(orbit.trajectory.states[:, 0])
        x, y, vx, vy = orbit.trajectory.states[rightmost]
        law, derivative = law_of(orbit.system), np.zeros((3, 3))
        assert return_derivative(complex(x, y), complex(vx, vy), orbit.period, law, derivative)
        expected = np.sort(np.abs(orbit.multipliers))
        expected = np.delete(expected, np.argmin(np.abs(expected - 1.0)))  # the multiplier of a shift in time
        # The error is 1e-3 where slip nearly ends, and 1e-5 elsewhere.
        np.testing.assert_allclose(
            np.sort(np.abs(np.linalg.eigvals(derivative))), expected, rtol=1e-3, atol=1e-4
        )
        # A small deviation is multiplied by the derivative from one crossing to the next.
        aside = np.array([1e-3, 2e-3, -1e-3])
        came, left = tuple(derivative @ aside - aside), np.linalg.norm(derivative @ aside)
        turn = complex(x, y), complex(vx, vy), orbit.period, law, came
        assert orbit_attracts.py_func(*turn, 1.001 * left) == orbit.stable
        assert not orbit_attracts.py_func(*turn, 0.999 * left)


def test_whirl_of_a_strongly_damped_pin_is_decided():
    """Deviations decay up to 200 times faster than the motion, which the return map must handle."""
    for damping, speed in ((7.0, -1.6), (9.0, 1.06), (50.0, 5.0)):
        pin = PinOnDisc(
            mass=1.0, stiffness=1.0, damping=damping, friction_force=1.0, disc_speed=speed, offset=0.0
        )
        (whirl,) = whirls(pin)
        assert whirl.stable
        found = simulate_ensemble(pin, [0.4, 0.8, 0.7, -0.3], duration=2000.0, parameters={"mass": [1.0]})
        assert found.end[0] == EndState.WHIRL
        assert found.largest_radius[0] == pytest.approx(whirl.radius, rel=1e-3)


@pytest.mark.parametrize("varied", [False, True])
def test_motion_near_an_unstable_whirl_does_not_end_there(about_the_fold, varied):
    aside = np.geomspace(1e-9, 1e-4, 12)
    directions = np.random.default_rng(2).normal(size=(len(aside), 4))
    for orbit in about_the_fold:
        if orbit.stable:
            continue
        pin = orbit.system
        starts = orbit.state + np.concatenate((aside, -aside))[:, np.newaxis] * np.tile(directions, (2, 1))
        parameters = {"mass": np.ones(len(starts))} if varied else None
        early = simulate_ensemble(pin, starts, duration=5000.0, parameters=parameters)
        full = simulate_ensemble(pin, starts, duration=5000.0, parameters=parameters, early_end=False)
        (rest,) = self_centred_equilibria(pin)
        centred = np.hypot(full.states[:, 0] - rest.x, full.states[:, 1] - rest.y) < 1e-3
        assert 0 < np.sum(centred) < len(starts)
        np.testing.assert_array_equal(
            early.end, np.where(centred, EndState.SELF_CENTRED, EndState.WHIRL), err_msg=f"{orbit.state[0]}"
        )
