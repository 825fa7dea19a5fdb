"""Stick phases: what friction must hold, when it lets go, and how slip starts, against eq. 1 and eq. 7."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from plain_engines import pull_on_stuck_pin, release_after, stuck_state, turned_with_disc

from reference_model import PinOnDisc
from reference_model.formulas import pin as formulas
from reference_model.motion.pin_equations import SlipMotion
from reference_model.motion.stick import can_hold, release_delay, slip_from_rest

FIG_6 = PinOnDisc(mass=1.0, stiffness=1.0, damping=0.1, friction_force=0.12, disc_speed=1.2, offset=0.1)
HEAVY = PinOnDisc(mass=2.3, stiffness=5.1, damping=0.7, friction_force=1.0, disc_speed=2.2, offset=0.15)
STUCK = [
    replace(pin, disc_speed=sign * pin.disc_speed, offset=side * pin.offset)
    for pin in (FIG_6, HEAVY)
    for sign in (1.0, -1.0)
    for side in (1.0, -1.0)
]

coordinates = st.floats(-0.6, 0.6)


@given(coordinates, coordinates, st.sampled_from(STUCK))
def test_friction_holds_a_pin_where_the_force_of_6_is_within_its_limit(x, y, pin):
    force = math.hypot(*pull_on_stuck_pin(pin, stuck_state(pin, x, y)))
    if abs(force - pin.friction_force) > 1e-14:
        assert can_hold(SlipMotion.of(pin), complex(x, y)) == (force < pin.friction_force)


@pytest.mark.parametrize("pin", STUCK)
@pytest.mark.parametrize("excess", [1.0001, 1.02, 1.3])
def test_pin_lets_go_at_the_first_root_of_7(pin, excess):
    radius = excess * formulas.sticking_radius(pin)
    held = 0
    for angle in np.linspace(-9.0, 9.0, 13):
        z = radius * complex(math.cos(angle), math.sin(angle))
        motion = SlipMotion.of(pin)
        if not can_hold(motion, z):
            continue
        found = release_delay(motion, z)
        # The force passes its limit at an angle: its rounding, over the slope there, is the error in time.
        assert found == pytest.approx(formulas.release_time(pin, radius, angle), abs=1e-11)
        state = stuck_state(pin, z.real, z.imag)
        turn = 2.0 * math.pi / abs(pin.disc_speed)
        assert found == pytest.approx(release_after(pin, state, turn), abs=1e-11)
        held += 1
    assert held > 3


# ---------------------------------------------------------------- how slip starts


def moments_of_release(pin):
    """Stuck positions from which friction lets go that instant, at several excesses of the radius over (9)."""
    for excess in (1.02, 1.2, 1.5):
        radius = excess * formulas.sticking_radius(pin)
        held = next(
            state
            for angle in np.linspace(0.0, 6.0, 40)
            if can_hold(
                SlipMotion.of(pin),
                complex(*(state := stuck_state(pin, radius * math.cos(angle), radius * math.sin(angle)))[:2]),
            )
        )
        turn = 2.0 * math.pi / abs(pin.disc_speed)
        released = turned_with_disc(pin, held, release_after(pin, held, turn))
        yield complex(*released[:2])


def starts_of_slip(pin):
    """Positions at rest from which slip starts: at a release, and where the pull is far more than friction."""
    yield from moments_of_release(pin)
    yield 1.5 + 0.3j
    yield -1.1j


@pytest.mark.parametrize("pin", STUCK)
def test_series_of_slip_solves_the_equations_of_motion(pin):
    motion = SlipMotion.of(pin)
    for z0 in starts_of_slip(pin):
        start = slip_from_rest(motion, z0)
        times = start.duration * np.linspace(0.1, 1.0, 19)
        z, w = start.at(times)
        velocity, acceleration = (
            np.polynomial.polynomial.polyval(times, np.polynomial.polynomial.polyder(series))
            for series in (start.positions, start.slip)
        )
        # The last terms are of 1e-12, of order 20 in time and of some dozen of products.
        allowed = 1e-12 * 20 / start.duration * 10
        assert np.abs(velocity - (w + 1j * motion.disc_speed * z)).max() < allowed
        friction = motion.friction * w / abs(w)
        pull = np.array([motion.pull(*point) for point in zip(z, w, strict=True)])
        assert np.abs(acceleration - (pull - friction)).max() < allowed, z0


@pytest.mark.parametrize("pin", STUCK)
def test_slip_after_a_release_starts_along_the_pull_and_grows_with_the_square_of_time(pin):
    motion = SlipMotion.of(pin)
    for z0 in moments_of_release(pin):
        pull = motion.pull(z0, 0.0)
        turning = 1j * motion.disc_speed * z0 * (motion.pull(1.0, 0.0) - motion.pull(0.0, 0.0))
        growth = (turning * pull.conjugate()).real / abs(pull)  # d|a|/dt of the stuck pin
        time = 1e-5
        _, slip = slip_from_rest(motion, z0).at(np.array([time]))
        assert growth > 0.0
        # The direction is behind the pull's by a further power of time, and by what pull and speed share.
        assert slip[0] == pytest.approx(0.5 * growth * time**2 * pull / abs(pull), rel=1e-2)


@pytest.mark.parametrize("excess", [1e-7, 1e-6, 1e-5, 1e-4])
def test_pin_whose_holding_force_only_just_exceeds_friction_slips_for_three_times_the_time_to_its_peak(
    excess,
):
    # About its peak the excess of the pull is a parabola, (τ² − t²)·const; its integral from −τ vanishes at 2τ.
    radius = 0.1
    elastic, viscous = 1.0 - FIG_6.disc_speed**2, 0.1 * FIG_6.disc_speed
    carry = math.hypot(elastic, viscous) * radius
    pin = replace(FIG_6, friction_force=(carry + 0.1) / (1.0 + excess))
    motion = SlipMotion.of(pin)
    held = release_delay(motion, complex(radius, 0.0))
    peak = (math.pi - math.atan2(viscous, elastic)) % (2.0 * math.pi) / pin.disc_speed
    to_peak = peak - held
    assert to_peak == pytest.approx(
        math.sqrt(2.0 * excess * (carry + 0.1) ** 2 / (carry * 0.1)) / 1.2, rel=0.01
    )
    released = turned_with_disc(pin, stuck_state(pin, radius, 0.0), held)
    start = slip_from_rest(motion, complex(*released[:2]))
    # The next term of the pull, and the Coriolis force on the slip, are smaller by about that time.
    assert start.rest == pytest.approx(3.0 * to_peak, rel=to_peak)
    assert start.rest < start.duration
    _, slip = start.at(start.rest * np.linspace(0.01, 1.0, 12))
    speed = slip / motion.pull(complex(*released[:2]), 0.0)
    assert speed[:-1].real.min() > 0.0
    assert abs(speed[-1]) < 1e-9 * abs(speed).max()
