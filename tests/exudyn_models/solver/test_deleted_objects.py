"""Contacts after ``mbs.DeleteObject``, which renumbers objects and nodes."""

import itertools

import exudyn as exu
import numpy as np
import pytest
from free_bodies import drive, new_model, planar_body, rotor, settings_of

from exudyn_models import (
    add_energy_balance,
    add_radial_support,
    add_ring_friction,
    add_thermal_node,
    solve_dynamic,
)

FRICTION = {"contact_radius": 0.1, "friction_coefficient": 0.3}
SOLVE = solve_dynamic, exu.MainSystem.SolveDynamic


def wheel(mbs, planar):
    return planar_body(mbs, 1.0, 0.5, [0.0] * 3, [0.0, 0.0, 3.0]) if planar else rotor(mbs, 0.5, 3.0)


def run(mbs):
    return solve_dynamic(mbs, settings_of(0.1, 100), exu.DynamicSolverType.TrapezoidalIndex2)


@pytest.mark.parametrize("regularisation", [None, 1e-3])
@pytest.mark.parametrize("planar", [False, True])
@pytest.mark.parametrize("deleted", ["a body", "a contact"])
def test_a_contact_rubs_and_measures_after_earlier_objects_were_deleted(deleted, planar, regularisation):
    mbs, law = new_model(), FRICTION | {"normal_load": 400.0, "regularisation": regularisation}
    body, braked = (planar_body(mbs, 1.0, 0.5, [0.0] * 3, [0.0, 0.0, 3.0]) for _ in range(2))
    other = add_ring_friction(mbs, None, braked, **law)
    friction = add_ring_friction(mbs, None, wheel(mbs, planar), **law)
    spin, moment = (friction.add_sensor(quantity) for quantity in ("relative_spin", "transmitted_moment"))
    if deleted == "a body":
        mbs.DeleteObject(int(body))  # with its node
        other.change(normal_load=0.0)
    else:
        mbs.DeleteObject(other.item, deleteDependentItems=False)
    friction.change(normal_load=800.0)
    changes = run(mbs)
    stops = 3.0 * 0.5 / 24.0
    if regularisation is None:
        assert [change.time for change in changes] == pytest.approx([stops], abs=1e-9)
    times, spins = mbs.GetSensorStoredData(spin).T
    np.testing.assert_allclose(spins, np.maximum(0.0, 3.0 - 48.0 * times), atol=0.04)
    slides = times < 0.9 * stops
    np.testing.assert_allclose(mbs.GetSensorStoredData(moment)[slides, 1], -24.0, rtol=1e-9)


@pytest.mark.parametrize("solve", SOLVE)
@pytest.mark.parametrize("planar", [False, True])
def test_a_deleted_contact_releases_its_bodies(planar, solve):
    mbs = new_model()
    node = wheel(mbs, planar)
    friction = add_ring_friction(mbs, None, node, normal_load=800.0, **FRICTION)
    assert len(run(mbs)) == 1
    mbs.DeleteObject(friction.item, deleteDependentItems=False)
    mbs.Assemble()
    solve(mbs, settings_of(0.1, 100), exu.DynamicSolverType.TrapezoidalIndex2)
    assert mbs.systemData.GetODE2Coordinates_t()[-1] == pytest.approx(3.0)


def test_a_deleted_contact_cannot_be_changed():
    mbs = new_model()
    friction = add_ring_friction(mbs, None, wheel(mbs, True), normal_load=8.0, regularisation=1.0, **FRICTION)
    mbs.DeleteObject(friction.item, deleteDependentItems=False)
    with pytest.raises(ValueError, match=r"^'friction contact 0' was deleted"):
        friction.change(normal_load=1.0)


@pytest.mark.parametrize("quantity", ["transmitted_moment", "heat"])
def test_a_deleted_contact_cannot_be_measured_in_a_run_of_exudyn(quantity):
    mbs = new_model()
    friction = add_ring_friction(mbs, None, wheel(mbs, True), normal_load=8.0, **FRICTION)
    friction.add_sensor(quantity)
    run(mbs)
    mbs.DeleteObject(friction.item, deleteDependentItems=False)
    mbs.Assemble()
    with pytest.raises(exu.ExudynError, match=r"'friction contact 0' was deleted"):
        mbs.SolveDynamic(settings_of(0.1, 100), exu.DynamicSolverType.TrapezoidalIndex2)


def test_a_contact_without_its_constraints_is_refused():
    mbs = new_model()
    friction = add_ring_friction(mbs, None, wheel(mbs, True), normal_load=800.0, **FRICTION)
    mbs.DeleteObject(int(friction.item) + 1, deleteDependentItems=False)
    with pytest.raises(ValueError, match=r"object 1, 'friction contact 0': constraints .* were deleted"):
        run(mbs)


@pytest.mark.parametrize(
    ("regularisation", "first", "second"),
    [(None, solve_dynamic, solve_dynamic), *((1e-9, *pair) for pair in itertools.product(SOLVE, repeat=2))],
)
@pytest.mark.parametrize("planar", [False, True])
def test_sensors_show_the_right_coordinates_after_an_object_is_deleted_between_two_runs(
    planar, regularisation, first, second
):
    mbs = new_model()
    body = planar_body(mbs, 1.0, 0.5, [0.0] * 3, [1.0, 2.0, 7.0])
    law = FRICTION | {"normal_load": 400.0, "regularisation": regularisation}
    friction = add_ring_friction(mbs, None, wheel(mbs, planar), **law)
    quantities = "relative_spin", "transmitted_moment", "power", "heat"
    sensors = [friction.add_sensor(quantity) for quantity in quantities]
    mbs.Assemble()
    for solve in (first, second):
        solve(mbs, settings_of(0.1, 100), exu.DynamicSolverType.TrapezoidalIndex2)
        shown = [float(mbs.GetSensorValues(sensor)) for sensor in sensors]
        spin = 3.0 - 12.0 * 0.1 / 0.5
        heat = 0.5 * (3.0**2 - spin**2) / 2.0
        accuracy = (
            1e-6 if solve is solve_dynamic else 1e-2
        )  # Exudyn's own run starts without the rate of heat
        assert shown == pytest.approx([spin, -12.0, 12.0 * spin, heat], rel=accuracy)
        if body is not None:
            mbs.DeleteObject(int(body))  # with its node
            mbs.Assemble()
            body = None


def test_an_energy_balance_notices_a_body_that_replaces_a_deleted_object():
    mbs = new_model()
    first = rotor(mbs, 0.5, 3.0)
    spare, kept = (
        add_ring_friction(mbs, None, first, normal_load=0.0, regularisation=1e-3, **FRICTION)
        for _ in range(2)
    )
    read = add_energy_balance(mbs, gains={}, losses={"friction": kept.power})
    stored = []
    for _ in range(2):
        mbs.Assemble()
        mbs.SolveDynamic(settings_of(0.1, 10), exu.DynamicSolverType.RK44)
        stored.append(read().stored[-1])
        mbs.DeleteObject(spare.item, deleteDependentItems=False)
        rotor(mbs, 1.0, 2.0)
    assert stored == pytest.approx([2.25, 4.25])


@pytest.mark.parametrize("base", [False, True])
@pytest.mark.parametrize("again", [False, True], ids=["before a run", "between runs"])
def test_a_support_shows_its_own_disc_after_an_object_is_deleted(base, again):
    """Only the disc's own coordinates show the deflection of 2 mm."""
    mbs = new_model()
    other = planar_body(mbs, 1.0, 0.5, [0.3, 0.4, 0.0], [0.0] * 3)
    housing = planar_body(mbs, 1e12, 1e12, [0.0] * 3, [0.0] * 3) if base else None
    disc = planar_body(mbs, 1.0, 0.5, [0.002, 0.0, 0.0], [0.0] * 3)
    drive(mbs, disc, 2.0)
    support = add_radial_support(mbs, housing, disc, stiffness=1e3, damping=5.0)
    quantities = "deflection", "force", "stored_energy", "power"
    sensors = [support.add_sensor(quantity) for quantity in quantities]
    add_energy_balance(mbs, gains={}, losses={"damper": support.power}, stored=[support.stored_energy])
    if again:
        run(mbs)
    mbs.DeleteObject(int(other))  # with its node
    run(mbs)
    shown = np.concatenate([np.atleast_1d(mbs.GetSensorValues(sensor)) for sensor in sensors])
    assert shown == pytest.approx([0.002, 0.0, -2.0, 0.0, 0.0, 2e-3, 0.0], abs=1e-9)


def test_a_deleted_support_cannot_be_measured():
    mbs = new_model()
    support = add_radial_support(mbs, None, wheel(mbs, True), stiffness=1e3)
    mbs.DeleteObject(support.item, deleteDependentItems=False)
    mbs.Assemble()
    with pytest.raises(ValueError, match=r"^'radial support 0' was deleted"):
        support.stored_energy(mbs)


def test_a_thermal_node_finds_its_temperature_after_an_earlier_one_is_deleted():
    mbs = new_model()
    _, kept = (add_thermal_node(mbs, heat_capacity=1.0, start=start) for start in (30.0, 50.0))
    rotor(mbs, 1.0, 0.0)
    run(mbs)
    assert kept.temperature(mbs) == pytest.approx(50.0)
    mbs.DeleteObject(0)
    run(mbs)
    assert kept.temperature(mbs) == pytest.approx(50.0)
