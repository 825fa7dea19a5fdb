"""Periodic motions with a stick phase, and the saddle of Fig. 5 that separates its two motions."""

import math
from dataclasses import replace

import numpy as np
import pytest

from compare.claims.parameters import FIG5
from reference_model import (
    PinOnDisc,
    self_centred_equilibria,
    simulate,
    stick_slip_orbits,
    whirl_orbit,
)
from reference_model.orbits.release_map import ReleaseMap

HEAVY = PinOnDisc(mass=2.3, stiffness=5.1, damping=0.7, friction_force=0.4, disc_speed=2.2, offset=0.15)
DAMPED = PinOnDisc(mass=1.0, stiffness=1.0, damping=0.85, friction_force=0.47, disc_speed=2.4, offset=0.46)
"""A pin with a stick–slip cycle; friction can hold it on the axis."""


@pytest.fixture(scope="module")
def saddle():
    (orbit,) = stick_slip_orbits(FIG5)
    return orbit


@pytest.fixture(scope="module")
def cycle():
    (orbit,) = stick_slip_orbits(DAMPED)
    return orbit


def release_angles(pin, state, duration):
    """The angles by which the pull lags behind that of the offset at releases, from (1) as it is printed."""
    angles = []
    trajectory = simulate(pin, state, [0.0, duration], tolerance=1e-12)
    for before, phase in zip(trajectory.phases, trajectory.phases[1:], strict=False):
        if before.kind == "stick" and before.end - before.start > 1e-6:
            x, y, vx, vy = phase.initial_state
            springs = -pin.stiffness * complex(x - pin.offset, y) - pin.damping * complex(vx, vy)
            pull = springs + pin.mass * pin.disc_speed**2 * complex(x, y)
            angles.append(-math.copysign(1.0, pin.disc_speed * pin.offset) * np.angle(pull * pin.offset))
    return angles


# ---------------------------------------------------------------- releases


@pytest.mark.parametrize(
    "pin", [FIG5, HEAVY, DAMPED, replace(HEAVY, disc_speed=-2.2), replace(HEAVY, offset=-0.15, damping=0.0)]
)
@pytest.mark.parametrize("angle", [0.3, 1.2, 2.8])
def test_at_a_release_the_pin_rests_on_the_disc_and_its_growing_pull_is_friction(pin, angle):
    releases = ReleaseMap(pin, 1e-9)
    x, y, vx, vy = releases.state(angle)
    assert complex(vx, vy) == pytest.approx(1j * pin.disc_speed * complex(x, y))

    def pull(z):
        v = 1j * pin.disc_speed * z
        springs = -pin.stiffness * (z - pin.offset) - pin.damping * v
        return abs(springs + pin.mass * pin.disc_speed**2 * z)

    z, later = complex(x, y), np.exp(1j * 1e-6 * np.sign(pin.disc_speed))
    assert pull(z) == pytest.approx(pin.friction_force, rel=1e-13)
    assert pull(z / later) < pin.friction_force < pull(z * later)
    assert releases.angle((x, y, vx, vy)) == pytest.approx(angle, abs=1e-13)


def test_without_a_pull_that_changes_while_the_pin_sticks_there_are_no_orbits():
    for name in ("offset", "friction_force", "disc_speed", "stiffness"):
        assert stick_slip_orbits(replace(FIG5, **{name: 0.0})) == ()
    resonant = replace(FIG5, disc_speed=FIG5.natural_frequency, damping=0.0)
    assert stick_slip_orbits(resonant) == ()


# ---------------------------------------------------------------- the saddle of Fig. 5


def test_saddle_of_fig_5_sticks_once_a_period_and_comes_back(saddle):
    assert saddle.residual < 1e-12
    (stick,) = saddle.trajectory.stick_phases
    assert stick.end - stick.start == pytest.approx(saddle.stick_time, abs=1e-12)
    assert saddle.system == FIG5
    assert not saddle.stable
    # After n periods an error of 1e-12 has grown to 1e-12·multiplier^n.
    later = simulate(FIG5, saddle.release, [0.0, 4.0 * saddle.period], tolerance=1e-13).at_end
    assert later == pytest.approx(saddle.release, abs=1e-12 * saddle.multiplier**4)


def test_saddle_is_the_orbit_that_shooting_finds_in_the_space_of_states(saddle):
    # From elsewhere: the period of the guess is that of the disc, and its state is a part in a thousand off.
    state = saddle.from_the_right().state * (1.0 + 1e-3)
    orbit = whirl_orbit(FIG5, guess=replace(saddle.from_the_right(), state=state))
    assert len(orbit.trajectory.stick_phases) == 1
    assert orbit.period == pytest.approx(saddle.period, abs=1e-11)
    radii = [np.max(motion.trajectory.radius) for motion in (orbit, saddle.from_the_right())]
    assert radii[0] == pytest.approx(radii[1], abs=1e-4)  # between samples


@pytest.mark.parametrize("which", ["saddle", "cycle"])
def test_multiplier_is_an_eigenvalue_of_the_monodromy_matrix_and_the_others_are_one_zero_and_zero(
    which, request
):
    orbit = request.getfixturevalue(which)
    found = sorted(np.linalg.eigvals(orbit.monodromy), key=abs, reverse=True)
    # A double eigenvalue of a matrix known to 1e-9 is known to the root of that.
    assert found[:2] == pytest.approx(orbit.multipliers[:2], abs=2e-9)
    assert found[2:] == pytest.approx([0.0, 0.0], abs=1e-4)
    assert sorted(map(abs, orbit.multipliers)) == pytest.approx(sorted([0.0, 0.0, 1.0, orbit.multiplier]))


@pytest.mark.parametrize("deviation", [1e-5, -1e-5])
def test_small_deviations_from_the_saddle_grow_by_its_multiplier_from_release_to_release(saddle, deviation):
    state = ReleaseMap(FIG5, 1e-12).state(saddle.release_angle + deviation)
    angles = release_angles(FIG5, state, 5.5 * saddle.period)
    growth = (np.array(angles) - saddle.release_angle) / deviation
    assert len(growth) == 5
    # Of the second order is left what the deviation is, times a curvature of order one.
    largest = abs(deviation) * saddle.multiplier ** len(growth)
    assert growth[1:] / growth[:-1] == pytest.approx(saddle.multiplier, rel=2.0 * largest)


def test_both_sides_of_the_saddle_lead_to_the_two_motions_of_fig_5(saddle):
    releases = ReleaseMap(FIG5, 1e-10)
    before, behind = (
        simulate(FIG5, releases.state(saddle.release_angle + side), np.linspace(0.0, 400.0, 4001))
        for side in (-1e-6, 1e-6)
    )
    (equilibrium,) = self_centred_equilibria(FIG5)
    assert before.at_end == pytest.approx(equilibrium.state, abs=1e-5)
    whirl = whirl_orbit(FIG5).trajectory.radius
    last = behind.radius[-400:]  # some six periods
    assert [last.min(), last.max()] == pytest.approx([whirl.min(), whirl.max()], abs=1e-3)


def test_multiplier_next_to_a_gap_is_the_slope_of_the_map_there():
    # Here the stick phase of the saddle has nearly vanished: at larger angles the pin does not stick in this turn.
    releases = ReleaseMap(replace(FIG5, disc_speed=1.19705), 1e-11)
    angle = 2.340178286
    assert releases.change(angle) == pytest.approx(0.0, abs=1e-9)
    assert not abs(releases.change(angle + 2e-3)) < 2e-3
    # The slope changes by some 3 a radian.
    backward = 1.0 + (releases.change(angle) - releases.change(angle - 1e-5)) / 1e-5
    assert releases.slope(angle) == pytest.approx(backward, abs=1e-4)


# ---------------------------------------------------------------- a stable cycle


def test_stable_cycle_is_what_a_long_simulation_comes_to(cycle):
    assert cycle.stable
    *_, angle = release_angles(DAMPED, [0.4, 0.0, 0.0, 0.0], 20.0 * cycle.period)
    assert angle == pytest.approx(cycle.release_angle, abs=1e-10)
