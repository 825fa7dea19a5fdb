"""Friction whose load grows with a moment: self-energising brakes and ball ramps, against closed forms."""

import math

import numpy as np
import pytest
from free_bodies import changes_of, drive, new_model, rate_of, rotor

from exudyn_models import add_gear, add_ring_friction, add_torsional_spring, linearise
from reference_model.trajectory import SimulationError

FACING = {"contact_radius": 0.1, "friction_coefficient": 0.3}  # arm 0.03 m
STEP = 1e-3


def brake(gain, moment, **more):
    """Return a model of a wheel of 0.5 kg m² at 2 rad/s with a brake of 800 N, and the wheel."""
    mbs = new_model()
    wheel = rotor(mbs, 0.5, 2.0)
    drive(mbs, wheel, moment)
    add_ring_friction(mbs, None, wheel, **FACING | {"normal_load": 800.0, "load_gain": gain} | more)
    return mbs, wheel


def test_a_self_energising_brake_stops_and_holds_as_in_closed_form():
    mbs, _ = brake(10.0, lambda t: -25.0 if t < 1.0 else -25.0 - 20.0 * (t - 1.0), static_ratio=1.2)
    sliding, static = 24.0 / (1.0 - 0.3), 1.2 * 24.0 / (1.0 - 1.2 * 0.3)
    (stop, *_, mode), (release, *_) = changes_of(mbs, 2.5, STEP)
    assert mode == 0
    assert stop == pytest.approx(2.0 * 0.5 / (sliding + 25.0), abs=1e-9)
    assert release == pytest.approx(1.0 + (static - 25.0) / 20.0, abs=1e-9)


def test_a_leading_shoe_trails_backward():
    """Friction on the disc is negative while it slides forward, with the second gain."""
    mbs, wheel = brake((-10.0, 10.0), -25.0)
    ((stop, *_, mode),) = changes_of(mbs, 0.5, STEP)
    leading, trailing = 24.0 / (1.0 - 0.3), 24.0 / (1.0 + 0.3)
    assert (stop, mode) == (pytest.approx(2.0 * 0.5 / (leading + 25.0), abs=1e-9), -1)
    assert rate_of(mbs, wheel) == pytest.approx(-(25.0 - trailing) / 0.5 * (0.5 - stop), abs=1e-8)


@pytest.mark.parametrize(("way", "tension"), [(1.0, math.exp(1.2) - 1.0), (-1.0, 1.0 - math.exp(-1.2))])
def test_a_band_brake_pulls_more_in_the_direction_of_its_fixed_end(way, tension):
    """The wrap angle is 4 rad, and μ = 0.3; 50 N pull at the slack end."""
    mbs = new_model()
    drum = rotor(mbs, 0.5, 2.0 * way)
    band = {"friction_coefficient": 1.0 - math.exp(-1.2), "load_gain": (0.0, 1.0 / 0.1)}
    add_ring_friction(mbs, None, drum, contact_radius=0.1, normal_load=50.0, **band)
    ((stop, *_, mode),) = changes_of(mbs, 1.0, STEP)
    assert (stop, mode) == (pytest.approx(2.0 * 0.5 / (5.0 * tension), abs=1e-9), 0)


def test_a_brake_whose_friction_falls_with_slip_follows_its_equation():
    """For μ = 0.3·(1 − c·v) the deceleration is 48·(1 − c·v)/(1 − 0.3·(1 − c·v)), and the time an integral."""
    c = 1.0
    mbs, _ = brake(10.0, 0.0, friction_coefficient=lambda slip_speed: 0.3 * (1.0 - c * slip_speed))
    (stop,) = changes_of(mbs, 0.1, 1e-4)
    speeds, weights = np.polynomial.legendre.leggauss(40)
    share = 1.0 - c * 0.1 * (speeds + 1.0)
    assert stop[0] == pytest.approx(np.sum(weights * (1.0 - 0.3 * share) / (48.0 * share)), abs=1e-7)


def test_a_brake_that_locks_itself_is_refused():
    with pytest.raises(ValueError, match=r"load_gain = 40 1/m: .* causes 1.2 times itself"):
        brake(40.0, 0.0)
    mbs, _ = brake(40.0, 0.0, friction_coefficient=lambda time: 0.2 + time)
    with pytest.raises(SimulationError, match="locks itself"):
        changes_of(mbs, 0.5, STEP)


def test_a_ball_ramp_releases_both_clutches_at_their_common_capacity():
    """The pilot holds 3 N m, and the main clutch 0.03·50 times as much."""
    mbs = new_model()
    shafts = [rotor(mbs, inertia, 0.0) for inertia in (1.0, 2.0)]
    drive(mbs, shafts[0], lambda t: 20.0 * t)
    pilot = add_ring_friction(mbs, *shafts, **FACING, normal_load=100.0)
    main = add_ring_friction(mbs, *shafts, **FACING, normal_load=0.0, load_gain=50.0, load_part=pilot)
    sensors = [one.add_sensor("transmitted_moment") for one in (pilot, main)]
    changes = changes_of(mbs, 1.0, STEP)
    release = 7.5 / (2.0 / 3.0) / 20.0
    assert [time for time, *_ in changes] == pytest.approx([release] * 2, abs=1e-9)
    assert [float(mbs.GetSensorValues(one)) for one in sensors] == pytest.approx([3.0, 4.5], abs=1e-9)
    assert rate_of(mbs, shafts[1]) == pytest.approx(
        20.0 * release**2 / 6.0 + 3.75 * (1.0 - release), abs=1e-8
    )


def test_the_linearisation_turns_a_gear_whose_moment_loads_a_sliding_brake():
    """Friction arm·g·|T| on the first shaft, with T = J₂·ω₂'/i, is an inertia that the brake adds to it."""
    mbs = new_model()
    shafts = [rotor(mbs, 1.0, 3.0), rotor(mbs, 2.0, 1.5)]
    drive(mbs, shafts[0], 6.0)
    gear = add_gear(mbs, *shafts, ratio=2.0)
    add_ring_friction(mbs, None, shafts[0], **FACING, normal_load=10.0, load_gain=20.0, load_part=gear)
    state = linearise(mbs)
    constraint, reaction = state.constraints[0], state.reactions[0]
    assert reaction - constraint == pytest.approx([0.6, 0.0], abs=1e-9)
    assert changes_of(mbs, 0.1, STEP) == []
    # (J₁ + J₂/4)·ω₁' = 6 − 0.3 − 0.6·T, with T = J₂·ω₁'/4.
    assert rate_of(mbs, shafts[0]) == pytest.approx(3.0 + 0.1 * 5.7 / (1.5 + 0.6 * 0.5), abs=1e-8)


def test_the_linearisation_contains_the_slope_of_a_load_that_follows_a_slip_or_a_twist():
    """The load of the brake falls with the slip of the pilot, and grows with the twist of the spring."""
    mbs = new_model()
    shafts = [rotor(mbs, 1.0, spin) for spin in (1.0, 3.0)]
    falling = {"contact_radius": 0.1, "friction_coefficient": lambda slip_speed: 0.3 - 0.5 * slip_speed}
    pilot = add_ring_friction(mbs, *shafts, **falling, normal_load=100.0)
    add_ring_friction(mbs, None, shafts[1], **FACING, normal_load=0.0, load_gain=50.0, load_part=pilot)
    slope = 0.5 * 0.1 * 0.1 * 100.0
    assert linearise(mbs).damping == pytest.approx(
        slope * np.array([[-1.0, 1.0], [1.0, -1.0]]) - 1.5 * slope * np.array([[0.0, 0.0], [-1.0, 1.0]]),
        abs=1e-8,
    )
    mbs = new_model()
    shaft = rotor(mbs, 1.0, 3.0, 0.2)
    spring = add_torsional_spring(mbs, None, shaft, stiffness=40.0, damping=2.0, backlash=0.1)
    add_ring_friction(mbs, None, shaft, **FACING, normal_load=0.0, load_gain=20.0, load_part=spring)
    state = linearise(mbs)
    assert (state.stiffness[0, 0], state.damping[0, 0]) == pytest.approx((1.6 * 40.0, 1.6 * 2.0), abs=1e-7)


def test_other_parts_and_bodies_are_refused():
    mbs = new_model()
    shafts = [rotor(mbs, 1.0, 0.0) for _ in range(2)]
    law = {**FACING, "normal_load": 10.0}
    for more, words in (
        ({"load_gain": -1.0, "load_part": add_ring_friction(mbs, *shafts, **law)}, "load_gain = -1"),
        ({"load_gain": 1.0, "load_part": 3}, "load_part = 3"),
        ({"load_gain": 1.0, "regularisation": 1e-3}, "no regularisation"),
        ({"load_gain": [1.0, 2.0, 3.0]}, "one or two numbers"),
    ):
        with pytest.raises(ValueError, match=words):
            add_ring_friction(mbs, *shafts, **law, **more)
