"""Periodic orbits by shooting: the whirl with an offset, its fold and branch, and the modulated cycle."""

import functools
import math
from dataclasses import replace

import numpy as np
import pytest
from disc_equations import assert_same_eigenvalues

from compare.claims.parameters import FIG11
from reference_model import PinOnDisc, last_whirl, self_centred_equilibria, simulate, whirl_orbit, whirls
from reference_model.contact.contact_law import ThreeTermRing
from reference_model.orbits import modulated_cycle, whirl_branch
from reference_model.orbits.release_map import stick_slip_orbits

FIG_5 = PinOnDisc(mass=1.0, stiffness=1.0, damping=0.1, friction_force=0.09, disc_speed=1.5, offset=0.1)
FIG_6 = replace(FIG_5, friction_force=0.12, disc_speed=1.2)
HEAVY = PinOnDisc(mass=2.3, stiffness=5.1, damping=0.7, friction_force=0.4, disc_speed=2.2, offset=0.15)
CYCLE = 1e-10  # tolerance of the modulated cycle, whose period is 37 turns
ROUNDING = 1e-12  # error of a stable orbit at a tolerance of 1e-12


def turned(z, angle):
    z *= np.exp(1j * angle)
    return z.real, z.imag


BACKWARDS = replace(FIG11, friction_force=0.08, disc_speed=-1.5, shaft_speed=-1.25)


@pytest.mark.parametrize(
    ("system", "law", "error"),
    [
        (replace(HEAVY, offset=0.0, disc_speed=-2.2), None, 1e-9),
        # Differences over 3e-4 are less accurate for discs, because the law is steep near U = W.
        (FIG11, None, 1e-8),
        (BACKWARDS, ThreeTermRing(0.12), 1e-8),
    ],
)
def test_whirl_without_offset_agrees_with_its_formula_and_eigenvalues(system, law, error):
    (whirl,) = whirls(system, law)
    orbit = whirl_orbit(system, simulate=functools.partial(simulate, contact=law), guess=whirl, samples=64)
    assert orbit.residual <= 1e-12
    assert orbit.state == pytest.approx(whirl.state, abs=ROUNDING * 10)
    assert orbit.period == pytest.approx(2.0 * math.pi / abs(whirl.frequency), rel=ROUNDING * 10)
    assert orbit.frequency == pytest.approx(abs(whirl.frequency), rel=ROUNDING * 10)
    assert orbit.mean == pytest.approx([0.0, 0.0], abs=ROUNDING * 10)
    multipliers = np.exp(np.array(whirl.eigenvalues) * orbit.period)
    assert_same_eigenvalues(orbit.multipliers, multipliers, tolerance=error / np.abs(multipliers).max())
    assert orbit.stable == whirl.stable


@pytest.mark.parametrize(
    "pin", [FIG_6, replace(HEAVY, offset=0.05), replace(FIG_5, disc_speed=3.0, offset=-0.1)]
)
def test_whirl_with_an_offset_is_periodic_and_has_a_multiplier_of_one(pin):
    orbit = whirl_orbit(pin)
    assert orbit.residual <= 1e-12
    assert orbit.state[1] == 0.0
    assert min(abs(multiplier - 1.0) for multiplier in orbit.multipliers) < 1e-5
    states = orbit.trajectory.states
    size = np.abs(states).max()
    assert np.abs(states[-1] - states[0]).max() < ROUNDING * size
    # The motion also returns after three periods at another tolerance.
    later = simulate(pin, orbit.state, [0.0, 3.0 * orbit.period], tolerance=1e-13)
    assert np.abs(later.at_end - orbit.state).max() < 10 * ROUNDING * size
    assert orbit.trajectory.times[-1] == orbit.period
    assert orbit.system == pin


@pytest.fixture(scope="module")
def fold():
    return last_whirl(FIG_6)


def test_last_whirl_is_a_fold_with_two_multipliers_of_one(fold):
    assert fold.system.friction_force == pytest.approx(0.0783178869, abs=2e-10)
    assert fold.residual <= 1e-12
    first, second, *others = sorted(fold.multipliers, key=lambda multiplier: abs(multiplier - 1.0))
    # The error of a double eigenvalue is the root of the error of the matrix, 1e-10.
    assert abs(first - 1.0) < 1e-5
    assert abs(second - 1.0) < 1e-5
    assert all(abs(other) < 0.1 for other in others)


def test_two_whirls_exist_just_above_the_fold_and_none_just_below(fold):
    x, load = float(fold.state[0]), fold.system.friction_force
    sides = [
        whirl_orbit(FIG_6, guess=fold, at_crossing=x * factor, tolerance=1e-10, samples=2)
        for factor in (1.02, 0.98)
    ]
    assert all(orbit.system.friction_force > load for orbit in sides)
    above = replace(FIG_6, friction_force=max(orbit.system.friction_force for orbit in sides))
    outer, inner = (whirl_orbit(above, guess=orbit, tolerance=1e-10, samples=2) for orbit in sides)
    assert outer.state[0] > 1.01 * x
    assert inner.state[0] < 0.99 * x
    assert outer.stable
    assert not inner.stable
    below = replace(FIG_6, friction_force=load * (1.0 - 1e-3))
    for orbit in (fold, outer, inner):
        with pytest.raises(RuntimeError, match=r"no whirl near the guess for friction_force"):
            whirl_orbit(below, guess=orbit, tolerance=1e-9)


def test_branch_beyond_the_fold_leads_to_orbits_with_stick_phases(fold):
    orbit = fold
    smooth = True
    for x in np.arange(fold.state[0] - 0.06, 0.3, -0.06):
        orbit = whirl_orbit(FIG_6, guess=orbit, at_crossing=float(x), tolerance=1e-11, samples=200)
        kinds = [phase.kind for phase in orbit.trajectory.phases]
        smooth = smooth and kinds == ["slip"]
        assert smooth == (x > 0.5)
    assert kinds == ["slip", "stick", "slip"]
    assert orbit.system.friction_force == pytest.approx(0.101, abs=1e-3)
    assert orbit.residual <= 1e-11
    assert not orbit.stable
    later = simulate(orbit.system, orbit.state, [0.0, 2.0 * orbit.period], tolerance=1e-13)
    # Each turn multiplies the error of this unstable orbit by 1.1, and the tolerances are 1e-11.
    assert np.abs(later.at_end - orbit.state).max() < 1e-10
    # A stick phase preserves one number of the final slip, its time, so two multipliers vanish.
    small = sorted(abs(multiplier) for multiplier in orbit.multipliers)[:2]
    assert max(small) < 1e-5


def test_branch_is_followed_around_the_fold_in_steps_of_any_size(fold):
    start = whirl_orbit(FIG_6, tolerance=1e-10, samples=2)
    coarse, fine = (list(whirl_branch(start, 0.55, step=step, samples=2)) for step in (0.16, 0.08))
    for branch in (coarse, fine):
        x = [orbit.state[0] for orbit in branch]
        assert np.all(np.diff(x) < 0.0)
        assert x[0] == start.state[0]
        assert x[-1] == 0.55
        assert max(orbit.residual for orbit in branch) < 1e-9
        loads = [orbit.system.friction_force for orbit in branch]
        assert np.argmin(loads) not in (0, len(loads) - 1)
        assert min(loads) >= fold.system.friction_force - 1e-10
    assert len(fine) > len(coarse)
    # Newton's method stops at a residual of 1e-9 or less.
    assert coarse[-1].state == pytest.approx(fine[-1].state, abs=1e-8)
    assert coarse[-1].system.friction_force == pytest.approx(fine[-1].system.friction_force, abs=1e-8)


def test_whirl_of_a_disc_with_an_offset_is_periodic_except_for_its_angle():
    disc = replace(FIG11, friction_force=0.08, offset=0.02)
    orbit = whirl_orbit(disc)
    assert orbit.residual <= 1e-12
    assert orbit.state[[1, 2]].tolist() == [0.0, 0.0]
    assert min(abs(multiplier - 1.0) for multiplier in orbit.multipliers) < 1e-5
    assert len(orbit.multipliers) == 5
    assert orbit.stable
    assert np.hypot(*orbit.mean) > 1e-3
    moving = [0, 1, 3, 4, 5]
    later = simulate(
        disc, [*orbit.state[:2], 0.7, *orbit.state[3:]], [0.0, 3.0 * orbit.period], tolerance=1e-13
    )
    assert later.at_end[moving] == pytest.approx(orbit.state[moving], abs=ROUNDING * 10)
    # The spin does not depend on the initial angle.
    angle = orbit.trajectory.at_end[2]
    assert later.at_end[2] == pytest.approx(0.7 + 3.0 * angle, abs=1e-10)


def at_offset(offset):
    return replace(FIG11, offset=offset)


@pytest.fixture(scope="module")
def round_the_axis():
    """Return the whirl of the disc of Fig. 11 at an offset where it still crosses the x axis."""
    return whirl_orbit(at_offset(0.012))


@pytest.fixture(scope="module")
def beside_the_axis(round_the_axis):
    """Return the whirl at a larger offset, where it no longer encloses the axis."""
    orbit = round_the_axis
    for offset in (0.0175, 0.0199):
        orbit = whirl_orbit(at_offset(offset), guess=orbit.from_the_right(), tolerance=1e-10)
    return orbit


def test_whirl_that_does_not_enclose_the_axis_is_found_by_continuation(beside_the_axis):
    assert beside_the_axis.residual <= 1e-10  # its tolerance
    places = beside_the_axis.trajectory.states[:, :2] @ [1.0, 1.0j]
    assert places.imag.min() > 0.0
    assert abs(np.unwrap(np.angle(places))[-1] - np.angle(places[0])) < 1e-9
    angles = np.unwrap(np.angle(places - places[:-1].mean()))
    assert angles[-1] - angles[0] == pytest.approx(2.0 * math.pi, abs=1e-9)
    # The equilibrium is stable as well, because it loses stability at a smaller offset.
    (rest,) = self_centred_equilibria(beside_the_axis.system)
    assert (beside_the_axis.stable, rest.stable) == (True, True)


def test_orbit_started_at_its_rightmost_point_is_the_same_orbit(round_the_axis):
    orbit = round_the_axis
    other = orbit.from_the_right()
    assert other.state[1] > 0.0
    assert other.trajectory.states[0].tolist() == other.state.tolist()
    assert np.delete(other.trajectory.at_end - other.state, 2) == pytest.approx(np.zeros(5), abs=1e-12)
    assert np.ptp(other.trajectory.radius) == pytest.approx(np.ptp(orbit.trajectory.radius), rel=1e-9)
    assert other.mean == pytest.approx(orbit.mean, abs=1e-12)
    assert sorted(map(abs, other.multipliers)) == pytest.approx(sorted(map(abs, orbit.multipliers)), abs=1e-7)


@pytest.fixture(scope="module")
def settled():
    """Return a motion of the disc of Fig. 11 from near the axis to its modulated cycle."""
    times = np.linspace(0.0, 1100.0, 11001)
    return simulate(FIG11, [0.02, 0.0, 0.0, 0.0, 0.0, 1.3], times, tolerance=1e-7)


@pytest.fixture(scope="module")
def cycle(settled):
    return modulated_cycle(FIG11, settled, tolerance=CYCLE)


def test_modulated_cycle_returns_rotated_about_the_axis(cycle):
    assert cycle.residual <= 1e-11
    x, y, _, vx, vy, spin = cycle.state
    assert (y, vx) == (0.0, 0.0)
    turns = 2.0
    start = np.array([*turned(complex(x, y), 0.4), 5.0, *turned(complex(vx, vy), 0.4), spin])
    later = simulate(FIG11, start, [0.0, turns * cycle.period], tolerance=1e-13).at_end
    angle = 0.4 + turns * cycle.turn
    expected = [*turned(complex(x, y), angle), *turned(complex(vx, vy), angle), spin]
    # Two periods are 75 natural periods.
    assert later[[0, 1, 3, 4, 5]] == pytest.approx(expected, abs=75 * CYCLE)
    # The rotation is not a multiple of a full turn, so the motion has two frequencies.
    assert abs(math.remainder(cycle.turn, 2.0 * math.pi)) > 0.1


def test_modulated_cycle_has_two_multipliers_of_one_and_is_stable(cycle):
    shift, turn, *others = sorted(cycle.multipliers, key=lambda multiplier: abs(multiplier - 1.0))
    assert abs(shift - 1.0) < 1e-5
    assert abs(turn - 1.0) < 1e-5
    assert all(abs(other) < 0.01 for other in others)
    assert cycle.stable
    assert cycle.carrier == pytest.approx(FIG11.natural_frequency, rel=0.005)


def test_modulated_cycle_is_found_at_a_given_load_and_at_a_given_crossing(cycle):
    load = 0.02247
    held = modulated_cycle(replace(FIG11, friction_force=load), cycle, tolerance=1e-7, samples=64)
    sought = modulated_cycle(FIG11, cycle, at_crossing=float(held.state[0]), tolerance=1e-7, samples=64)
    assert abs(load - FIG11.friction_force) > 100.0 * abs(sought.system.friction_force - load)
    assert sought.system.friction_force == pytest.approx(load, abs=1e-8)
    assert sought.period == pytest.approx(held.period, rel=1e-6)


def test_whirl_of_constant_radius_is_refused_as_a_modulated_cycle():
    steady = replace(FIG11, friction_force=0.03)
    spiral = simulate(steady, [0.052, 0.0, 0.0, 0.0, 0.05, 1.345], np.linspace(0.0, 300.0, 6001))
    with pytest.raises((RuntimeError, ValueError), match=r"no modulated cycle near the guess|does not recur"):
        modulated_cycle(steady, spiral)


def test_failed_shooting_reports_the_parameters_where_it_stopped_and_the_next_guess():
    reported = (
        r"no whirl near the guess .*disc_speed = 1\.2 rad/s.*nearby load.*y = 0 m, from one that starts"
    )
    with pytest.raises(RuntimeError, match=reported):
        whirl_orbit(replace(FIG_6, friction_force=0.078), tolerance=1e-9)


def test_a_mean_has_an_error_below_a_millionth_or_is_refused_with_too_few_samples():
    """The mean of one sample is the initial position, 0.88 m away."""
    exact = whirl_orbit(FIG_5, samples=1024).mean
    for samples in (1, 2, 5, 8, 12):
        with pytest.raises(ValueError, match=f"samples = {samples}: too few for the mean of this orbit"):
            _ = whirl_orbit(FIG_5, samples=samples).mean
    for samples in (16, 21, 64):
        assert whirl_orbit(FIG_5, samples=samples).mean == pytest.approx(exact, abs=1e-8)
    coarse, *fine = (stick_slip_orbits(FIG_5, samples=samples)[0] for samples in (16, 256, 2048))
    assert fine[0].mean == pytest.approx(fine[1].mean, abs=1e-8)
    with pytest.raises(ValueError, match="samples = 16: too few"):
        _ = coarse.mean


def test_an_orbit_that_recurs_after_a_rotation_has_no_mean_and_needs_two_samples(fold):
    with pytest.raises(
        ValueError, match="turn = 2 rad: the mean needs an orbit that recurs without rotation"
    ):
        _ = replace(fold, turn=2.0).mean
    with pytest.raises(ValueError, match="samples = 1: it must be a whole number >= 2"):
        modulated_cycle(replace(FIG_6, offset=0.0), fold, samples=1)
