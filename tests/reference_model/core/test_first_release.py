"""The time of release by four implementations, and slip that begins with hardly enough pull or too much."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from plain_engines import as_disc, pull_on_stuck_pin, stuck_state, turned_with_disc

from reference_model import PinOnDisc, simulate
from reference_model.contact.contact_law import Pin
from reference_model.core.rest import _first_release, holds_for
from reference_model.core.single import law_of
from reference_model.core.units import Units
from reference_model.ensemble.core import laws
from reference_model.formulas import pin as formulas

FIG_6 = PinOnDisc(mass=1.0, stiffness=1.0, damping=0.1, friction_force=0.12, disc_speed=1.2, offset=0.1)
coordinates = st.floats(-0.4, 0.4)


def kinds(trajectory):
    return [phase.kind for phase in trajectory.phases]


@st.composite
def stuck_pins(draw, linear):
    """Draw a pin and a position on the disc where friction can hold it with a margin."""
    pin = PinOnDisc(
        mass=draw(st.floats(0.5, 2.0)),
        stiffness=draw(st.floats(0.0, 2.0)),
        damping=draw(st.floats(0.0, 0.5)),
        friction_force=0.0,
        disc_speed=draw(st.sampled_from([-2.3, -0.9, 0.4, 1.3])),
        offset=draw(st.sampled_from([-0.3, 0.02, 0.1])),
        hardening=0.0 if linear else draw(st.sampled_from([0.0, 1.0, 20.0])),
        stop_gap=draw(st.floats(0.0, 0.4)),
        stop_stiffness=0.0 if linear else draw(st.sampled_from([0.0, 5.0, 200.0])),
    )
    x, y, spare = draw(coordinates), draw(coordinates), draw(st.floats(1e-3, 0.5))
    pull = math.hypot(*pull_on_stuck_pin(pin, stuck_state(pin, x, y)))
    assume(pull > 1e-6)
    return replace(pin, friction_force=(1.0 + spare) * pull), complex(x, y)


def law_on(pin):
    return law_of(pin, Pin(), Units(1.0, 1.0))


def in_compiled_code(pin, z):
    C, beta, load = (value / pin.mass for value in (pin.stiffness, pin.damping, pin.friction_force))
    return laws.release_delay(z, laws.PinLaw(C, beta, load, pin.disc_speed, pin.offset, 0.03, 0.0))


@pytest.mark.parametrize(
    ("release", "linear"),
    [
        (lambda pin, z: _first_release(z.real, z.imag, 0.0, law_on(pin)), False),
        (lambda pin, z: holds_for(z.real, z.imag, 0.0, law_on(pin)), True),
        (in_compiled_code, True),
        (lambda pin, z: formulas.release_time(pin, abs(z), math.atan2(z.imag, z.real)), True),
    ],
    ids=["search", "closed form", "compiled", "formula"],
)
@settings(max_examples=100)
@given(data=st.data())
def test_release_is_the_first_time_when_the_pull_exceeds_friction(release, linear, data):
    pin, z = data.draw(stuck_pins(linear))
    found = release(pin, z)
    turn = 2.0 * math.pi / abs(pin.disc_speed)
    pulls = [
        math.hypot(*pull_on_stuck_pin(pin, turned_with_disc(pin, stuck_state(pin, z.real, z.imag), time)))
        for time in np.linspace(0.0, min(found, turn), 150)
    ]
    assert max(pulls) <= pin.friction_force * (1.0 + 1e-7)
    if found < math.inf:
        assert pulls[-1] == pytest.approx(pin.friction_force, rel=1e-10)


def test_start_at_the_very_moment_of_release_slips():
    pin, radius, angle = FIG_6, 1.1 * formulas.sticking_radius(FIG_6), 4.0
    held = stuck_state(pin, radius * math.cos(angle), radius * math.sin(angle))
    release = formulas.release_time(pin, radius, angle)
    assert release > 0.5
    times = np.linspace(0.0, 1.0, 11)
    trajectory = simulate(pin, turned_with_disc(pin, held, release), times)
    assert kinds(trajectory)[-1] == "slip"
    assert trajectory.phases[-1].start < 1e-11  # rounding decides whether it is held for a moment
    longer = simulate(pin, held, np.concatenate(([0.0], release + times)))
    assert np.abs(trajectory.states - longer.states[1:]).max() < 1e-8


def grazing_pin(excess, radius=0.1):
    """Return a pin, a start whose holding force peaks at (1 + excess)·μN 1.5 rad later, and a width in rad.

    The holding force passes μN this width before the peak, to first order, because the excess is a parabola.
    """
    elastic, viscous = 1.0 - FIG_6.disc_speed**2, 0.1 * FIG_6.disc_speed
    carry = math.hypot(elastic, viscous) * radius
    pin = replace(FIG_6, friction_force=(carry + 0.1) / (1.0 + excess))
    angle = math.pi - math.atan2(viscous, elastic) - 1.5
    width = math.sqrt(2.0 * max(excess, 0.0) / (carry * 0.1)) * (carry + 0.1)
    return pin, stuck_state(pin, radius * math.cos(angle), radius * math.sin(angle)), width


@pytest.mark.parametrize("excess", [-1e-9, 0.0, 1e-15, 1e-9])
def test_holding_force_that_peaks_at_the_friction_force_does_not_release_the_pin(excess):
    pin, start, _ = grazing_pin(excess)
    trajectory = simulate(pin, start, np.linspace(0.0, 50.0, 51))
    assert kinds(trajectory) == ["stick"]
    assert trajectory.radius == pytest.approx(0.1, rel=1e-14)


OUT_OF_REACH = {"stop_gap": 10.0, "stop_stiffness": 1.0}
"""A stop that the pin never meets. The release is then searched for and not computed in closed form."""


def test_slip_that_begins_with_too_large_a_pull_is_the_same_by_series_and_by_collocation():
    start, times = stuck_state(FIG_6, 0.4, 0.3), np.linspace(0.0, 1.0, 21)
    assert math.hypot(*pull_on_stuck_pin(FIG_6, start)) > 1.1 * FIG_6.friction_force
    by_series, by_collocation = (
        simulate(pin, start, times, tolerance=1e-11).states for pin in (FIG_6, replace(FIG_6, **OUT_OF_REACH))
    )
    assert np.abs(by_series - by_collocation).max() < 1e-10


@pytest.mark.parametrize(
    ("excess", "variant"),
    [
        *((excess, lambda pin: pin) for excess in (2e-8, 1e-5, 0.1)),
        (1e-4, lambda pin: replace(pin, **OUT_OF_REACH)),
        (5e-8, lambda pin: as_disc(pin, 6)),  # its force peaks between two samples of the search
    ],
)
def test_holding_force_that_just_exceeds_friction_releases_the_body_briefly_in_each_turn(excess, variant):
    pin, start, width = grazing_pin(excess)
    body, times = variant(pin), np.linspace(0.0, 7.0, 71)
    start = stuck_state(body, *start[:2])
    trajectory, tight = (simulate(body, start, times, tolerance=tolerance) for tolerance in (1e-9, 1e-13))
    assert kinds(trajectory)[:3] == kinds(tight)[:3] == ["stick", "slip", "stick"]
    slip = tight.phases[1]
    # The pull exceeds friction for twice the width. Slip lasts three widths, until the integral of the parabola
    # vanishes. The neglected terms are smaller by a factor of the width.
    assert slip.start == pytest.approx((1.5 - width) / pin.disc_speed, abs=0.2 * width**2)
    assert slip.end - slip.start == pytest.approx(3.0 * width / pin.disc_speed, rel=width)
    # The tolerance, times a size of 0.1, bounds the motion but not the end of slip: friction exceeds the pull there
    # by only three times the excess, so each m/s of error in the slip speed takes so many seconds longer to vanish.
    condition = pin.mass / (3.0 * excess * pin.friction_force)
    assert np.abs(trajectory.states - tight.states).max() < 1e-10
    assert trajectory.stick_times == pytest.approx(tight.stick_times, abs=1e-10 * condition)
