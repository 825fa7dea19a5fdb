"""The exact solver of trains against closed forms, so that it can judge the package."""

import math

import pytest
from exact_trains import GROUND, OPEN, Link, Signal, Train, exact_motion

RAMP = Signal(slope=10.0)
NONE = Signal()


def times_and_modes(train, end):
    changes, speeds = exact_motion(train, end)
    return [(change.time, change.link, change.before, change.after) for change in changes], speeds


def brakes(*moments, ratio=1.5):
    return tuple(Link(GROUND, 0, Signal(moment), ratio) for moment in moments)


@pytest.mark.parametrize("moments", [(10.0, 8.0), (6.0, 6.0, 6.0)])
def test_parallel_brakes_hold_the_sum_of_their_static_moments(moments):
    train = Train((0.5,), (0.0,), (RAMP,), brakes(*moments))
    changes, (speed,) = times_and_modes(train, 3.0)
    assert changes == [(pytest.approx(2.7, abs=1e-10), k, 0, 1) for k in range(len(moments))]
    assert speed == pytest.approx((5.0 * (9.0 - 2.7**2) - 18.0 * 0.3) / 0.5, rel=1e-9)


def test_a_loop_of_contacts_holds_what_its_weakest_cut_can():
    """Statically 9 N m from a to the ground, and 6 N m from b, which a drives through 9 N m: released at 15 N m."""
    links = Link(GROUND, 0, Signal(6.0), 1.5), Link(GROUND, 1, Signal(4.0), 1.5), Link(0, 1, Signal(6.0), 1.5)
    changes, speeds = times_and_modes(Train((0.5, 0.3), (0.0, 0.0), (RAMP, NONE), links), 1.8)
    assert changes == [(pytest.approx(1.5, abs=1e-10), k, 0, 1) for k in range(2)]
    assert speeds == pytest.approx([2.4375, 2.4375], rel=1e-9)  # (5·(1.8² − 1.5²) − 10·0.3)/0.8


def test_two_rotors_reach_a_common_speed_and_part_when_the_clutch_carries_too_much():
    """Together they carry 5·t·0.5/1.5 N m, which exceeds 1.2·2 N m at 1.44 s."""
    links = (Link(0, 1, Signal(2.0), 1.2),)
    changes, speeds = times_and_modes(Train((1.0, 0.5), (3.0, 0.0), (Signal(slope=5.0), NONE), links), 2.0)
    sticks = (6.0 - math.sqrt(36.0 - 4.0 * 2.5 * 3.0)) / 5.0  # 3 − 6t + 2.5t² = 0
    assert changes == [
        (pytest.approx(sticks, abs=1e-10), 0, -1, 0),
        (pytest.approx(1.44, abs=1e-10), 0, 0, -1),
    ]
    assert 1.0 * speeds[0] + 0.5 * speeds[1] == pytest.approx(3.0 + 2.5 * 4.0, rel=1e-9)


def test_a_prescribed_shaft_drags_a_rotor_until_its_acceleration_is_too_large():
    """1 kg m² follows 0.25·sin 20t rad/s up to an acceleration of 4 rad/s²; a brake of 1 N m has to be overcome."""
    shaft = Signal(amplitude=0.25, frequency=20.0 / (2.0 * math.pi), phase=-math.pi / 2.0)
    train = Train((1.0, 1.0), (0.0, -0.25), (NONE, NONE), (Link(0, 1, Signal(4.0)),), {0: shaft})
    changes, _ = times_and_modes(train, 0.07)
    assert changes == [(pytest.approx(math.asin(0.8) / 20.0, abs=1e-10), 0, 0, -1)]


def test_a_one_way_clutch_overruns_and_engages():
    """8·sin 5t N m drive 1 kg m², and 1 N m brakes 0.5 kg m²."""
    moments = Signal(amplitude=8.0, frequency=5.0 / (2.0 * math.pi)), Signal(-1.0)
    train = Train((1.0, 0.5), (4.0, 4.0), moments, (Link(0, 1, Signal(1e3), one_way=True),))
    start = (math.pi + math.asin(1.0 / 0.5 / 8.0)) / 5.0
    changes, _ = times_and_modes(train, 1.6)
    assert [change[2:] for change in changes] == [(0, 1), (1, 0)]
    assert changes[0][0] == pytest.approx(start, abs=1e-10)
    engaged = changes[1][0]
    assert -(engaged - start) / 0.5 == pytest.approx(
        1.6 * (math.cos(5.0 * start) - math.cos(5.0 * engaged)), abs=1e-8
    )


def test_coupled_clutches_of_modelica_change_their_modes_at_the_published_times():
    """The times are those of ``docs/from-modelica.md``; the first capacity is 10·cos 0.4πt N m up to 1.25 s."""
    first = Signal(amplitude=10.0, frequency=0.2, phase=math.pi / 2.0)
    capacities = first, Signal(steps=((0.4, 10.0),)), Signal(steps=((0.9, 10.0),))
    links = tuple(Link(k, k + 1, capacity, 1.1) for k, capacity in enumerate(capacities))
    moments = Signal(amplitude=10.0, frequency=5.0), NONE, NONE, NONE
    changes, speeds = times_and_modes(Train((1.0,) * 4, (10.0, 0.0, 0.0, 0.0), moments, links), 1.2499)
    assert [change[2:] for change in changes if OPEN in change[2:]] == [(OPEN, -1)] * 2
    found = [round(change[0], 4) for change in changes]
    assert found == pytest.approx([0.4, 0.7096, 0.7917, 0.8311, 0.9, 0.9068, 1.0003, 1.144], abs=1.5e-4)
    assert speeds[1] == pytest.approx(2.463, abs=1e-3)
