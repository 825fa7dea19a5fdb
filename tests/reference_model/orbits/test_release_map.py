"""Stick-slip orbits, and the saddle of Fig. 5 that separates the basins of its two motions."""

from dataclasses import replace

import numpy as np
import pytest

from compare.claims.parameters import FIG5
from reference_model import (
    PinOnDisc,
    simulate,
    stick_slip_orbits,
    whirl_orbit,
)
from reference_model.orbits.release_map import ReleaseMap

HEAVY = PinOnDisc(mass=2.3, stiffness=5.1, damping=0.7, friction_force=0.4, disc_speed=2.2, offset=0.15)
DAMPED = PinOnDisc(mass=1.0, stiffness=1.0, damping=0.85, friction_force=0.47, disc_speed=2.4, offset=0.46)
"""A pin with a stick-slip cycle, which friction can hold on the axis."""


@pytest.fixture(scope="module")
def saddle():
    (orbit,) = stick_slip_orbits(FIG5)
    return orbit


@pytest.fixture(scope="module")
def cycle():
    (orbit,) = stick_slip_orbits(DAMPED)
    return orbit


@pytest.mark.parametrize(
    "pin", [FIG5, HEAVY, DAMPED, replace(HEAVY, disc_speed=-2.2), replace(HEAVY, offset=-0.15, damping=0.0)]
)
@pytest.mark.parametrize("angle", [0.3, 1.2, 2.8])
def test_state_at_a_release_sticks_and_its_growing_pull_equals_friction(pin, angle):
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


def test_pin_whose_pull_does_not_change_during_stick_has_no_orbits():
    for name in ("offset", "friction_force", "disc_speed", "stiffness"):
        assert stick_slip_orbits(replace(FIG5, **{name: 0.0})) == ()
    resonant = replace(FIG5, disc_speed=FIG5.natural_frequency, damping=0.0)
    assert stick_slip_orbits(resonant) == ()


def test_saddle_of_fig_5_is_periodic_with_one_stick_phase(saddle):
    assert saddle.residual < 1e-12
    (stick,) = saddle.trajectory.stick_phases
    assert stick.end - stick.start == pytest.approx(saddle.stick_time, abs=1e-12)
    assert saddle.system == FIG5
    assert not saddle.stable
    # An error of 1e-12 grows to 1e-12·multiplier^n in n periods.
    later = simulate(FIG5, saddle.release, [0.0, 4.0 * saddle.period], tolerance=1e-13).at_end
    assert later == pytest.approx(saddle.release, abs=1e-12 * saddle.multiplier**4)


def test_saddle_agrees_with_shooting_in_state_space(saddle):
    # The state of the guess is off by 1e-3.
    state = saddle.from_the_right().state * (1.0 + 1e-3)
    orbit = whirl_orbit(FIG5, guess=replace(saddle.from_the_right(), state=state))
    assert len(orbit.trajectory.stick_phases) == 1
    assert orbit.period == pytest.approx(saddle.period, abs=1e-11)
    radii = [np.max(motion.trajectory.radius) for motion in (orbit, saddle.from_the_right())]
    assert radii[0] == pytest.approx(radii[1], abs=1e-4)  # between samples


@pytest.mark.parametrize("which", ["saddle", "cycle"])
def test_eigenvalues_of_the_monodromy_matrix_are_the_multiplier_one_and_two_zeros(which, request):
    orbit = request.getfixturevalue(which)
    found = sorted(np.linalg.eigvals(orbit.monodromy), key=abs, reverse=True)
    # The error of a double eigenvalue is the root of the error of the matrix, 1e-9.
    assert found[:2] == pytest.approx(orbit.multipliers[:2], abs=2e-9)
    assert found[2:] == pytest.approx([0.0, 0.0], abs=1e-4)
    assert sorted(map(abs, orbit.multipliers)) == pytest.approx(sorted([0.0, 0.0, 1.0, orbit.multiplier]))


def test_multiplier_next_to_a_gap_of_the_map_is_its_slope():
    # The stick phase of this saddle is very short. At larger angles the pin does not stick in this turn.
    releases = ReleaseMap(replace(FIG5, disc_speed=1.19705), 1e-11)
    angle = 2.340178286
    assert releases.change(angle) == pytest.approx(0.0, abs=1e-9)
    assert not abs(releases.change(angle + 2e-3)) < 2e-3
    # The slope changes by about 3 per radian.
    backward = 1.0 + (releases.change(angle) - releases.change(angle - 1e-5)) / 1e-5
    assert releases.slope(angle) == pytest.approx(backward, abs=1e-4)


def test_long_simulation_converges_to_the_stable_cycle(cycle):
    assert cycle.stable
    motion = simulate(DAMPED, [0.4, 0.0, 0.0, 0.0], [0.0, 20.0 * cycle.period], tolerance=1e-12)
    *_, last = ReleaseMap(DAMPED, 1e-12).along(motion)
    assert last.angle == pytest.approx(cycle.release_angle, abs=1e-10)
