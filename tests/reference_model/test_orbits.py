"""Periodic orbits: the whirl with an offset, its fold, and the branch with stick phases."""

import math
from dataclasses import replace

import numpy as np
import pytest

from reference_model import PinOnDisc, last_whirl, simulate, whirl_orbit, whirls
from reference_model import pin_formulas as formulas
from reference_model.orbits import Flow, whirl_branch

FIG_5 = PinOnDisc(mass=1.0, stiffness=1.0, damping=0.1, friction_force=0.09, disc_speed=1.5, offset=0.1)
FIG_6 = replace(FIG_5, friction_force=0.12, disc_speed=1.2)
HEAVY = PinOnDisc(mass=2.3, stiffness=5.1, damping=0.7, friction_force=0.4, disc_speed=2.2, offset=0.15)
ROUNDING = 1e-12  # of an orbit at a tolerance of 1e-12 whose errors die out


@pytest.mark.parametrize("pin", [FIG_5, FIG_6, replace(HEAVY, disc_speed=-2.2)])
def test_whirl_without_offset_is_that_of_11_with_its_eigenvalues(pin):
    pin = replace(pin, offset=0.0)
    orbit, (whirl,) = whirl_orbit(pin), whirls(pin)
    assert orbit.residual <= 1e-12
    expected = [whirl.radius, 0.0, 0.0, whirl.radius * whirl.frequency]
    assert orbit.state == pytest.approx(expected, abs=ROUNDING * whirl.radius * 10)
    assert orbit.period == pytest.approx(2.0 * math.pi / abs(whirl.frequency), rel=ROUNDING)
    assert orbit.frequency == pytest.approx(abs(whirl.frequency), rel=ROUNDING)
    assert orbit.mean == pytest.approx([0.0, 0.0], abs=ROUNDING * whirl.radius * 10)
    # Multipliers come from differences over 1e-5 of the size: right to its square, and 1e-12/1e-5.
    multipliers = sorted(np.exp(np.array(whirl.eigenvalues) * orbit.period), key=lambda m: (-abs(m), -m.imag))
    found = sorted(orbit.multipliers, key=lambda m: (-abs(m), -m.imag))
    assert found == pytest.approx(multipliers, abs=1e-7)
    assert orbit.stable == whirl.stable


@pytest.mark.parametrize(
    "pin", [FIG_5, FIG_6, replace(HEAVY, offset=0.05), replace(FIG_5, disc_speed=3.0, offset=-0.1)]
)
def test_whirl_with_an_offset_is_periodic_and_has_a_multiplier_of_one(pin):
    orbit = whirl_orbit(pin)
    assert orbit.residual <= 1e-12
    assert orbit.state[1] == 0.0
    assert min(abs(multiplier - 1.0) for multiplier in orbit.multipliers) < 1e-5
    states = orbit.trajectory.states
    size = np.abs(states).max()
    assert np.abs(states[-1] - states[0]).max() < ROUNDING * size
    # The shooting is right if the motion comes back after three periods, found at another tolerance.
    later = simulate(pin, orbit.state, [0.0, 3.0 * orbit.period], tolerance=1e-13)
    assert np.abs(later.at_end - orbit.state).max() < 10 * ROUNDING * size
    assert orbit.trajectory.times[-1] == orbit.period
    assert orbit.system == pin


@pytest.mark.parametrize("pin", [FIG_5, FIG_6])
def test_mean_of_the_orbit_is_that_of_a_long_simulation_over_whole_periods(pin):
    orbit = whirl_orbit(pin)
    times = np.linspace(0.0, 5.0 * orbit.period, 5 * 64 + 1)
    mean = simulate(pin, orbit.state, times, tolerance=1e-12).states[:-1, :2].mean(axis=0)
    # 64 samples a period leave the harmonics from the 64th on.
    assert orbit.mean == pytest.approx(mean, abs=1e-10)


def test_whirl_on_a_disc_that_turns_the_other_way_is_mirrored():
    orbit, mirrored = whirl_orbit(FIG_6), whirl_orbit(replace(FIG_6, disc_speed=-1.2))
    mirror = np.array([1.0, -1.0, 1.0, -1.0])
    assert mirrored.state == pytest.approx(mirror * orbit.state, abs=ROUNDING * 10)
    assert mirrored.period == pytest.approx(orbit.period, rel=ROUNDING)
    assert mirrored.mean == pytest.approx(mirror[:2] * orbit.mean, abs=ROUNDING * 10)


@pytest.mark.parametrize("disc_speed", [1.3, 1.5, 2.0, 3.0, -1.5])
def test_error_of_the_first_order_mean_falls_like_the_third_power_of_the_offset(disc_speed):
    pin = replace(FIG_6, disc_speed=disc_speed)
    errors = []
    for offset in (0.02, 0.01):  # of the radius; the next term is smaller by (w·0.02)², w = ω/(ω − k) <= 4.4
        small = replace(pin, offset=offset * formulas.whirl_radius(pin))
        mean = whirl_orbit(small, samples=64).mean
        errors.append(math.dist(mean, formulas.first_order_whirl_shift(small)))
    assert math.log2(errors[0] / errors[1]) == pytest.approx(3.0, abs=0.05), errors


# ---------------------------------------------------------------- where the whirl ends


@pytest.fixture(scope="module")
def fold():
    return last_whirl(FIG_6)


def test_last_whirl_is_a_fold_where_two_multipliers_are_one(fold):
    assert fold.system.friction_force == pytest.approx(0.0783178869, abs=2e-10)
    assert fold.residual <= 1e-12
    first, second, *others = sorted(fold.multipliers, key=lambda multiplier: abs(multiplier - 1.0))
    # A double eigenvalue of a matrix known to 1e-10 is known to the root of that.
    assert abs(first - 1.0) < 1e-5
    assert abs(second - 1.0) < 1e-5
    assert all(abs(other) < 0.1 for other in others)


def test_two_whirls_exist_just_above_the_fold_and_none_just_below(fold):
    x, load = float(fold.state[0]), fold.system.friction_force
    sides = [whirl_orbit(FIG_6, guess=fold, at_crossing=x * factor, samples=2) for factor in (1.02, 0.98)]
    assert all(orbit.system.friction_force > load for orbit in sides)
    above = replace(FIG_6, friction_force=max(orbit.system.friction_force for orbit in sides))
    outer, inner = (whirl_orbit(above, guess=orbit, samples=2) for orbit in sides)
    assert outer.state[0] > 1.01 * x
    assert inner.state[0] < 0.99 * x
    assert outer.stable
    assert not inner.stable
    for orbit in (fold, outer, inner):
        with pytest.raises(RuntimeError, match=r"no whirl near the guess for friction_force"):
            whirl_orbit(replace(FIG_6, friction_force=load * (1.0 - 1e-3)), guess=orbit)


def test_load_near_the_fold_grows_with_the_square_of_the_distance_from_it(fold):
    x, load = float(fold.state[0]), fold.system.friction_force
    more = [
        whirl_orbit(FIG_6, guess=fold, at_crossing=x + step, samples=2).system.friction_force - load
        for step in (-0.01, 0.01, -0.02, 0.02)
    ]
    # Even part: fourth order is left, smaller by about (0.02/x)².
    assert (more[2] + more[3]) / (more[0] + more[1]) == pytest.approx(4.0, rel=0.02)


def test_pin_leaves_the_neighbourhood_of_the_last_whirl_below_the_fold_and_stays_above(fold):
    radius = {}
    for factor in (0.97, 1.03):
        pin = replace(FIG_6, friction_force=factor * fold.system.friction_force)
        start = [*fold.state[:2], *fold.state[2:]] if factor < 1.0 else [0.75, 0.0, 0.0, 0.72]
        radius[factor] = simulate(pin, start, np.linspace(0.0, 300.0, 301)).radius[-50:].max()
    assert radius[0.97] < 0.1 < 0.6 < radius[1.03]


def test_branch_beyond_the_fold_leads_to_orbits_with_stick_phases(fold):
    orbit = fold
    smooth = True
    for x in np.arange(fold.state[0] - 0.04, 0.3, -0.04):
        orbit = whirl_orbit(FIG_6, guess=orbit, at_crossing=float(x), tolerance=1e-11, samples=200)
        kinds = [phase.kind for phase in orbit.trajectory.phases]
        smooth = smooth and kinds == ["slip"]
        assert smooth == (x > 0.5)
    assert kinds == ["slip", "stick", "slip"]
    assert orbit.system.friction_force == pytest.approx(0.101, abs=1e-3)
    assert orbit.residual <= 1e-11
    assert not orbit.stable
    later = simulate(orbit.system, orbit.state, [0.0, 2.0 * orbit.period], tolerance=1e-13)
    # Unstable: each turn multiplies the error of the orbit by 1.1, and the tolerances are 1e-11.
    assert np.abs(later.at_end - orbit.state).max() < 1e-10
    # A stick phase forgets where slip ended but for one number, the moment: two multipliers vanish.
    small = sorted(abs(multiplier) for multiplier in orbit.multipliers)[:2]
    assert max(small) < 1e-5


def test_branch_goes_round_the_fold_in_steps_of_any_size(fold):
    start = whirl_orbit(FIG_6, samples=2)
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
    # Newton's method stops at a miss of 1e-9, mostly far below.
    assert coarse[-1].state == pytest.approx(fine[-1].state, abs=1e-8)
    assert coarse[-1].system.friction_force == pytest.approx(fine[-1].system.friction_force, abs=1e-8)


# ---------------------------------------------------------------- refusals


@pytest.mark.parametrize("load", [0.05, 0.078])
def test_shooting_says_where_it_stopped_if_there_is_no_orbit(load):
    with pytest.raises(RuntimeError, match=r"no whirl near the guess .*disc_speed = 1\.2 rad/s.*nearby load"):
        whirl_orbit(replace(FIG_6, friction_force=load))


@pytest.mark.parametrize("disc_speed", [1.0, 0.9, -0.5])
def test_no_whirl_is_sought_below_the_natural_frequency(disc_speed):
    with pytest.raises(ValueError, match=rf"disc_speed = {disc_speed:g} rad/s: the whirl exists only"):
        whirl_orbit(replace(FIG_6, disc_speed=disc_speed))


def test_orbits_of_another_engine_are_found_with_its_simulate():
    calls = []

    def engine(system, initial_state, times, *, tolerance):
        calls.append(tolerance)
        return simulate(system, initial_state, times, tolerance=tolerance)

    orbit = whirl_orbit(FIG_5, simulate=engine, tolerance=1e-10)
    assert set(calls) == {1e-10}
    assert isinstance(orbit.flow, Flow)
    assert orbit.state == pytest.approx(whirl_orbit(FIG_5).state, abs=1e-9)
