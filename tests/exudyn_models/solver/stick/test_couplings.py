"""Gears with losses, differentials and one-way clutches, against closed forms and the exact solver."""

import math
from itertools import pairwise

import exudyn as exu
import numpy as np
import pytest
from free_bodies import changes_of, drive, items, new_model, planar_body, rate_of, rotor, settings_of
from random_couplings import KINDS, STEP, TIMES, RandomTrain, check
from scipy.optimize import brentq

from exudyn_models import (
    add_differential,
    add_energy_balance,
    add_gear,
    add_one_way_clutch,
    add_planetary,
    add_ring_friction,
)
from reference_model.trajectory import SimulationError

IMPLICIT = [exu.DynamicSolverType.TrapezoidalIndex2, exu.DynamicSolverType.GeneralizedAlpha]
SEEDS = (2, 5, 7, 10, 13, 17, 22, 33)
"""At the start of 10, a clutch slips forward and backward within one step."""


def changes_in(trains):
    return sum(check(train, solver) for train in trains for solver in IMPLICIT)


def test_random_trains_with_loads_by_moments_of_parts_move_exactly():
    """In 32 and 44 a sliding differential loads a clutch on one of its sides."""
    assert changes_in(RandomTrain(seed, loaded=True) for seed in (1, 4, 9, 32, 44, 60)) > 18


def test_random_trains_of_sliders_points_and_bodies_move_exactly():
    """The parts act on positions of sliders and points, and on angles of planar bodies."""
    assert changes_in(RandomTrain(seed, kinds=("rotor", "slider", "point", "body")) for seed in SEEDS) > 50


def test_random_trains_of_rotors_move_exactly():
    assert changes_in(map(RandomTrain, SEEDS)) > 50


def test_random_trains_of_any_parts_with_shifts_and_controllers_move_exactly():
    """In 16 the load of a sliding clutch falls to zero, and in 20 a one-way clutch is at rest without load."""
    trains = [RandomTrain(seed, everything=True) for seed in (5, 16, 20, 28)]
    assert changes_in([*trains, RandomTrain(33, everything=True, kinds=KINDS)]) > 40


def test_a_spring_is_pressed_where_its_flanks_touch_at_small_steps():
    """The contact was found a little too early, and another step to it failed."""
    assert check(RandomTrain(351, everything=True), IMPLICIT[0], STEP / 8.0) == 6


def geared(load_of_first, load_of_second, inertias=(1.0, 0.5), **gear):
    """Return the speeds after 1 s of two geared rotors, by default of 1 and 0.5 kg m², and the gear's sensors."""
    mbs = new_model()
    first, second = (rotor(mbs, inertia, 0.0) for inertia in inertias)
    part = add_gear(mbs, first, second, **{"ratio": 2.0} | gear)
    sensors = {
        name: part.add_sensor(name)
        for name in ("moment", "friction", "relative_spin", "mode", "power", "heat")
    }
    balance = add_energy_balance(
        mbs,
        gains={
            "first": lambda mbs, t: load_of_first * rate_of(mbs, first),
            "second": lambda mbs, t: load_of_second * rate_of(mbs, second),
        },
        losses={"gear": part.power},
    )
    drive(mbs, first, load_of_first)
    drive(mbs, second, load_of_second)
    changes_of(mbs, 1.0, STEP)
    values = {name: float(mbs.GetSensorValues(sensor)) for name, sensor in sensors.items()}
    energy = balance()
    assert np.abs(energy.residual).max() <= 1e-9 * max(energy.turnover, 1.0)
    assert values["heat"] == pytest.approx(energy.losses["gear"][-1], abs=1e-12)
    return rate_of(mbs, first), rate_of(mbs, second), values


def test_a_gear_loses_its_share_of_the_power_in_both_directions():
    first, second, values = geared(3.0, 0.0, efficiency=(0.8, 0.6))
    assert first == pytest.approx(3.0 / (1.0 + 0.5 / (4.0 * 0.8)), rel=1e-10)
    assert second == pytest.approx(first / 2.0, rel=1e-12)
    received = 0.5 * second  # its only load, after 1 s of constant acceleration
    assert values["moment"] == pytest.approx(-received / 2.0, rel=1e-10)
    assert -values["moment"] / -(values["moment"] + values["friction"]) == pytest.approx(0.8, rel=1e-10)
    assert values["power"] == pytest.approx((3.0 - first) * first - received * second, rel=1e-9)
    first, second, values = geared(0.0, 3.0, efficiency=(0.8, 0.6))
    assert second == pytest.approx(3.0 / (0.5 + 4.0 / 0.6), rel=1e-10)
    assert (values["moment"] + values["friction"]) / values["moment"] == pytest.approx(0.6, rel=1e-10)


def test_the_efficiency_of_a_table_depends_on_the_moment():
    """At |T| = t the shares solve (3 − a) = t/η(t) with a = 8·t, the acceleration of the first rotor."""
    table = [[0.0, 0.5, 0.5], [1.0, 0.9, 0.9]]
    first, _, values = geared(3.0, 0.0, efficiency=table)
    moment = brentq(lambda t: 3.0 - 8.0 * t - t / (0.5 + 0.4 * t), 0.0, 1.0, xtol=1e-15)
    assert (first, -values["moment"]) == pytest.approx((8.0 * moment, moment), rel=1e-9)


def test_friction_of_a_gear_may_exceed_the_moment_that_causes_it():
    """Friction is 2.3 times the moment, and nearly all of it changes the moment of a light first rotor."""
    first, _, values = geared(3.0, 0.0, (0.01, 2.0), efficiency=0.3)
    assert first == pytest.approx(3.0 / (0.01 + 2.0 / (4.0 * 0.3)), rel=1e-10)
    assert values["friction"] / values["moment"] == pytest.approx(0.7 / 0.3, rel=1e-10)


@pytest.mark.filterwarnings("ignore:the energy balance is off")  # by 2e-20 J
def test_a_gear_that_locks_itself_holds_any_load_on_its_second_shaft():
    first, second, values = geared(0.0, 30.0, efficiency=(0.5, -0.1))
    assert (first, second, values["mode"], values["heat"]) == pytest.approx((0.0,) * 4, abs=1e-12)
    assert (values["moment"], values["friction"]) == pytest.approx((15.0, -15.0), rel=1e-9)


def test_two_gears_in_a_row_release_at_the_moment_that_both_efficiencies_require():
    """Each of them may hold the first rotor, which changes T of the first gear."""

    def release(efficiency, moment):
        mbs = new_model()
        rotors = [rotor(mbs, inertia, 0.0) for inertia in (1.0, 0.5, 2.0)]
        for pair in pairwise(rotors):
            add_gear(mbs, *pair, ratio=2.0, efficiency=efficiency)
        drive(mbs, rotors[0], moment)
        drive(mbs, rotors[2], -10.0)
        return [(time, *modes) for time, _, *modes in changes_of(mbs, 1.5, STEP)]

    assert release((0.5, -0.1), lambda t: 0.0) == []
    raised = release((0.5, -0.1), lambda t: 10.0 * t)  # 10/(4·0.5²)
    assert raised == [(pytest.approx(1.0, abs=1e-9), 0, 1)] * 2
    lowered = release((0.5, 0.4), lambda t: 1.0 - t)  # 10·0.4²/4
    assert lowered == [(pytest.approx(0.6, abs=1e-9), 0, -1)] * 2


def test_a_gear_that_locks_itself_releases_a_one_way_clutch_and_a_brake_behind_it():
    """The gear rests alone until 0.1 of its moment drives it. Then the brake slips too, because the clutch locks."""
    mbs = new_model()
    first, second, third = (rotor(mbs, inertia, 0.0) for inertia in (1.0, 0.5, 0.3))
    gear = add_gear(mbs, first, second, ratio=2.0, efficiency=(0.7, -0.1))
    add_one_way_clutch(mbs, second, third)
    brake = add_ring_friction(mbs, None, third, contact_radius=1.0, friction_coefficient=1.0, normal_load=0.5)
    drive(mbs, first, lambda t: 6.0 * math.sin(9.0 * t))
    drive(mbs, second, 3.0)
    changes = changes_of(mbs, 0.1, STEP)
    release = pytest.approx(math.asin(0.15 / 6.0) / 9.0, abs=TIMES)
    assert changes == [(release, int(part.item), 0, 1) for part in (gear, brake)]


def test_a_one_way_clutch_does_not_fight_a_friction_clutch_beside_it():
    """Both rest until 6 N m of static friction are too little for the driven rotor to stay as slow as the driver."""
    mbs = new_model()
    driver, driven = rotor(mbs, 1.0, 0.0), rotor(mbs, 0.5, 0.0)
    law = {"contact_radius": 1.0, "friction_coefficient": 1.0, "normal_load": 4.0, "static_ratio": 1.5}
    moments = [
        add_one_way_clutch(mbs, driver, driven).add_sensor("moment"),
        add_ring_friction(mbs, driver, driven, **law).add_sensor("transmitted_moment"),
    ]
    drive(mbs, driver, lambda t: 20.0 - 20.0 * t)
    drive(mbs, driven, lambda t: -20.0 + 20.0 * t)
    changes = changes_of(mbs, 2.0, STEP)
    assert [change[2:] for change in changes] == [(0, 1)] * 2
    assert [change[0] for change in changes] == pytest.approx([1.3] * 2, abs=TIMES)
    one_way, friction = (mbs.GetSensorStoredData(sensor).T for sensor in moments)
    rest = one_way[0] < 1.29
    assert (one_way[1] + friction[1])[rest] == pytest.approx(20.0 - 20.0 * one_way[0][rest], abs=1e-8)
    assert (one_way[1][rest] > -1e-6).all()


def test_a_one_way_clutch_that_starts_in_its_locked_direction_equalises_the_speeds():
    mbs = new_model()
    driver, driven = rotor(mbs, 1.0, 3.0), rotor(mbs, 0.5, 0.0)
    add_one_way_clutch(mbs, driver, driven)
    assert changes_of(mbs, 0.1, STEP) == []
    assert (rate_of(mbs, driver), rate_of(mbs, driven)) == pytest.approx((2.0, 2.0), rel=1e-12)


def test_an_impact_of_one_way_clutches_is_free_of_friction_and_of_tension():
    """A brake at rest takes no share of the impact, and the clutch on the ground overruns.

    Rotors of 1, 1 and 2 kg m² with 3, 0 and 0 rad/s then turn with 3/4 rad/s.
    """
    mbs = new_model()
    line = [rotor(mbs, inertia, speed) for inertia, speed in ((1.0, 3.0), (1.0, 0.0), (2.0, 0.0))]
    for pair in (line[:2], line[1:], [None, line[2]]):
        add_one_way_clutch(mbs, *pair)
    add_ring_friction(mbs, None, line[2], contact_radius=0.1, friction_coefficient=0.3, normal_load=10.0)
    changes_of(mbs, 1e-3, STEP)
    speeds = [rate_of(mbs, one) for one in line]
    assert speeds == pytest.approx([0.75 - 0.3e-3 / 4.0] * 3, rel=1e-12)


def test_one_way_clutches_that_share_a_load_after_an_impact_release_as_one():
    """Both rotors have 4/3 rad/s after the impact, and separate when 5·sin(9·t)/1 = −0.3/2 rad/s²."""
    mbs = new_model()
    first, second = rotor(mbs, 1.0, 2.0), rotor(mbs, 2.0, 1.0)
    drive(mbs, first, lambda t: 5.0 * math.sin(9.0 * t))
    drive(mbs, second, -0.3)
    for _ in range(2):
        add_one_way_clutch(mbs, first, second)
    release = (math.pi + math.asin(0.03)) / 9.0
    changes = changes_of(mbs, 0.4, 1e-3)
    assert [(time, after) for time, _, _, after in changes] == [(pytest.approx(release, abs=1e-6), 1)] * 2


def test_a_locked_one_way_clutch_carries_a_rotor_along_with_a_locked_friction_clutch():
    mbs = new_model()
    rotors = [rotor(mbs, inertia, 0.0) for inertia in (1.0, 0.5, 1.5)]
    add_ring_friction(mbs, *rotors[:2], contact_radius=1.0, friction_coefficient=1.0, normal_load=100.0)
    add_one_way_clutch(mbs, *rotors[1:])
    drive(mbs, rotors[0], 6.0)
    assert changes_of(mbs, 0.1, STEP) == []
    assert [rate_of(mbs, node) for node in rotors] == pytest.approx([0.2] * 3, rel=1e-10)


def test_a_planetary_gear_has_its_three_speeds_and_moments():
    """The ring is fixed; 2 N m on the sun are 2·(1 + 2.5) N m on the carrier."""
    mbs = new_model()
    sun, carrier = rotor(mbs, 0.1, 0.0), rotor(mbs, 2.0, 0.0)
    moment = add_planetary(mbs, sun, carrier, None, ratio=2.5).add_sensor("moment")
    drive(mbs, sun, 2.0)
    changes_of(mbs, 1.0, STEP)
    speed = 2.0 * 3.5 / (2.0 + 0.1 * 3.5**2)
    assert (rate_of(mbs, carrier), rate_of(mbs, sun)) == pytest.approx((speed, 3.5 * speed), rel=1e-10)
    assert float(mbs.GetSensorValues(moment)) == pytest.approx(0.1 * 3.5 * speed - 2.0, rel=1e-9)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"ratio": 0.0}, "ratio = 0: it must not be zero"),
        ({"ratio": 2.0, "efficiency": 0.0}, "must be > 0 and <= 1 if the first rotor drives"),
        ({"ratio": 2.0, "efficiency": [1.0, 0.5, 0.5]}, "must be a number, two numbers, or a table"),
        ({"ratio": 2.0, "efficiency": [[1.0, 0.5, 0.5], [0.5, 0.6, 0.6]]}, "must be >= 0 and increase"),
    ],
)
def test_invalid_gears_are_refused(arguments, message):
    mbs = new_model()
    with pytest.raises(ValueError, match=message):
        add_gear(mbs, rotor(mbs, 1.0, 0.0), rotor(mbs, 1.0, 0.0), **arguments)


@pytest.mark.parametrize("efficiency", [1.0, 0.9])
def test_gears_that_repeat_a_constraint_are_named(efficiency):
    mbs = new_model()
    rotors = [rotor(mbs, 1.0, 0.0) for _ in range(2)]
    for _ in range(2):
        add_gear(mbs, *rotors, ratio=2.0, efficiency=efficiency)
    with pytest.raises(SimulationError, match="1 of 2 constraints depend on the others; remove them"):
        changes_of(mbs, 0.1, STEP)


@pytest.mark.parametrize("solver", IMPLICIT)
def test_a_gear_without_losses_is_a_constraint_that_reverses_without_a_change_of_mode(solver):
    mbs = new_model()
    first, second = rotor(mbs, 1.0, -1.0), rotor(mbs, 0.5, 0.5)
    gear = add_gear(mbs, first, second, ratio=-2.0)
    moment = gear.add_sensor("moment")
    drive(mbs, second, -4.0)
    assert changes_of(mbs, 1.0, STEP, solver) == []
    speed = 0.5 - 4.0 / (0.5 + 4.0 * 1.0)
    assert (rate_of(mbs, first), rate_of(mbs, second)) == pytest.approx((-2.0 * speed, speed), rel=1e-9)
    assert float(mbs.GetSensorValues(moment)) == pytest.approx(2.0 * 4.0 / 4.5, rel=1e-6)


def test_a_gear_keeps_its_losses_after_an_object_before_it_is_deleted():
    mbs = new_model()
    spare = mbs.AddObject(items.ObjectGround())
    rotors = [rotor(mbs, inertia, 0.0) for inertia in (1.0, 0.5)]
    gear = add_gear(mbs, *rotors, ratio=2.0, efficiency=0.8)
    moment = gear.add_sensor("moment")
    drive(mbs, rotors[0], 3.0)
    mbs.DeleteObject(int(spare), deleteDependentItems=False)
    mbs.Assemble()
    changes_of(mbs, 1.0, STEP)
    speed = 3.0 / (1.0 + 0.5 / (4.0 * 0.8))
    assert rate_of(mbs, rotors[0]) == pytest.approx(speed, rel=1e-9)
    assert float(mbs.GetSensorValues(moment)) == pytest.approx(-0.125 * speed, rel=1e-9)


def test_rotors_must_be_different_and_solve_dynamic_must_run_them():
    mbs = new_model()
    one, body = rotor(mbs, 1.0, 0.0), planar_body(mbs, 1.0, 1.0, [0.0] * 3, [0.0] * 3)
    with pytest.raises(ValueError, match=r"second = .*: a coupling is between different rotors"):
        add_gear(mbs, one, one, ratio=1.0)
    with pytest.raises(ValueError, match=r"driven = .*: it must be a Node1D"):
        add_one_way_clutch(mbs, one, body)
    with pytest.raises(ValueError, match=r"preload = -1: it must be >= 0"):
        add_differential(mbs, one, rotor(mbs, 1.0, 0.0), rotor(mbs, 1.0, 0.0), preload=-1.0)
    add_gear(mbs, one, None, ratio=1.0, efficiency=0.9)
    mbs.Assemble()
    add_ring_friction(mbs, None, body, contact_radius=0.1, friction_coefficient=0.3, normal_load=5.0)
    with pytest.raises(ValueError, match="a contact in the plane that sticks exactly cannot be combined"):
        changes_of(mbs, 0.1, STEP)
    with pytest.raises(exu.ExudynError, match=r"needs exudyn_models\.solve_dynamic"):
        mbs.SolveDynamic(settings_of(0.1, 10), IMPLICIT[0])
