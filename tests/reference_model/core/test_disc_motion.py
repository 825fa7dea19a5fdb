"""Simulated motions of the friction disc, against closed forms, eq. 7 and limiting cases."""

import cmath
import math
from dataclasses import replace

import numpy as np
import pytest
from disc_equations import STICKING, STICKY
from plain_engines import stuck_state

from compare.claims.parameters import FIG11
from reference_model import PinOnDisc, simulate
from reference_model.contact.contact_law import Ring
from reference_model.core import rest, slip, stiff
from reference_model.core.forces import points
from reference_model.formulas.disc import held_pin
from reference_model.systems import DiscOnDisc


def kinds(trajectory):
    return [phase.kind for phase in trajectory.phases]


def test_crossings_of_equal_slip_and_rim_speed_keep_the_tolerance():
    # U and R|S| are equal five times in 8 s. If no step ended at these logarithms, the error would be 1e-7.
    disc = DiscOnDisc(
        mass=0.8863, polar_inertia=0.01014, stiffness=1.943, damping=0.3917, friction_force=0.04138, disc_speed=1.264,
        contact_radius=0.1603, shaft_damping=0.001154, shaft_speed=-1.842,
    )  # fmt: skip
    start = [0.395575, -0.553647, 0.0, 1.2747005841951533, 0.5507301118799482, 0.799]
    times = np.linspace(0.0, 8.0, 81)
    tight = simulate(disc, start, times, tolerance=1e-14)
    sliding = np.hypot(*tight.slip_velocity.T) - disc.contact_radius * np.abs(
        disc.disc_speed - tight.states[:, 5]
    )
    assert np.sum(np.diff(np.sign(sliding)) != 0.0) >= 4
    tolerances = np.array([1e-8, 1e-9, 1e-10, 1e-11, 1e-12])
    errors = [
        np.abs(simulate(disc, start, times, tolerance=tolerance).states - tight.states).max()
        for tolerance in tolerances
    ]
    # A single error depends on chance positions of the steps.
    assert np.mean(np.log10(errors / tolerances)) < 1.0, errors
    # The law defines the crossings, not the radius of the disc.
    other = simulate(
        replace(disc, contact_radius=0.3), start, times, tolerance=1e-9, contact=Ring(disc.contact_radius)
    )
    assert np.array_equal(other.states, simulate(disc, start, times, tolerance=1e-9).states)


@pytest.mark.parametrize("support", [{}, {"stop_gap": 0.12, "stop_stiffness": 0.5}], ids=["linear", "stop"])
def test_stuck_ring_is_released_like_a_pin_with_the_friction_that_the_moment_leaves(support):
    disc = replace(STICKY, **support)
    pin = held_pin(disc)
    released = 0
    for angle in np.linspace(0.0, 6.0, 7):
        z = 0.05 * cmath.exp(1j * angle)
        trajectory = simulate(disc, stuck_state(disc, z.real, z.imag), [0.0, 5.0])
        if kinds(trajectory)[0] == "stick":
            release = simulate(pin, stuck_state(pin, z.real, z.imag), [0.0, 5.0]).phases[0].end
            assert trajectory.phases[0].end == pytest.approx(release, abs=1e-10)
            released += release < 5.0
    assert released >= 2


@pytest.mark.parametrize("points", [None, 6])
@pytest.mark.parametrize("margin", [0.99, 1.01])
def test_disc_at_the_axis_sticks_if_the_moment_of_its_shaft_is_below_friction(points, margin):
    # At the axis there is no force on the centre, so b(ω − Ω) competes with μN·R alone.
    b = margin * STICKY.friction_force * STICKY.contact_radius / 0.25
    disc = replace(STICKY, offset=0.0, shaft_damping=b, contact_points=points)
    trajectory = simulate(disc, stuck_state(disc, 0.0, 0.0), np.linspace(0.0, 30.0, 31))
    assert kinds(trajectory) == (["stick"] if margin < 1.0 else ["slip"])
    if margin > 1.0:
        # The spin slips until the damper balances friction, b(ω − Ω − S) = μN·R.
        slip = 0.25 - STICKY.friction_force * STICKY.contact_radius / b
        decay = math.exp(-b / disc.polar_inertia * 30.0)
        assert 1.5 - trajectory.at_end[5] == pytest.approx(slip * (1.0 - decay), rel=1e-7)


PIN = PinOnDisc(mass=1.0, stiffness=1.0, damping=0.1, friction_force=0.09, disc_speed=1.5, offset=0.1)
"""The pin of Fig. 5, whose motion from (0.1, 0, 0.03, 0) has five stick phases in 30 s."""


@pytest.fixture(scope="module", params=["pin", None, 3], ids=["pin", "ring", "three points"])
def sticky(request):
    if request.param == "pin":
        return simulate(PIN, [0.1, 0.0, 0.03, 0.0], np.linspace(0.0, 30.0, 61))
    return simulate(replace(STICKY, contact_points=request.param), STICKING, np.linspace(0.0, 12.0, 61))


THRESHOLDS = (
    *((slip, name) for name in ("REST_TIME", "REVERSAL", "COMMON_REST", "USUAL", "SLOW", "CREEP_SHARE")),
    *((stiff, name) for name in ("BRIEF", "RISING", "FAST", "FIRST_SPAN")),
    *((rest, name) for name in ("CREEP", "NARROW")),
    (points, "CLOSE"),
)
"""Limits between the descriptions of slip."""


@pytest.mark.parametrize("factor", [0.5, 2.0])
def test_motion_does_not_depend_on_the_thresholds(sticky, factor, monkeypatch):
    for module, name in THRESHOLDS:
        monkeypatch.setattr(module, name, factor * getattr(module, name))
    changed = simulate(sticky.system, sticky.states[0], sticky.times, compiled=False)
    assert kinds(changed) == kinds(sticky)
    assert np.abs(changed.states - sticky.states).max() < 1e-8
    assert changed.stick_times == pytest.approx(sticky.stick_times, abs=1e-8)


@pytest.mark.parametrize(("inertia", "spin"), [(1e9, 1.3), (1.0, 1e6), (1e-4, 1.3)])
def test_accuracy_of_the_position_depends_on_neither_inertia_nor_spin(inertia, spin):
    disc, start = replace(FIG11, polar_inertia=inertia), [0.02, 0.0, 0.0, 0.0, 0.0, spin]
    coarse, fine = (
        simulate(disc, start, np.linspace(0.0, 10.0, 51), tolerance=tolerance) for tolerance in (1e-9, 1e-12)
    )
    assert np.abs(coarse.states[:, :2] - fine.states[:, :2]).max() < 1e-8 * fine.radius.max()
