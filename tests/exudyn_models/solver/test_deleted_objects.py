"""Contacts after ``mbs.DeleteObject``, which renumbers objects and nodes."""

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
PLANAR = pytest.mark.parametrize("planar", [False, True])


def wheel(mbs, planar):
    return planar_body(mbs, 1.0, 0.5, [0.0] * 3, [0.0, 0.0, 3.0]) if planar else rotor(mbs, 0.5, 3.0)


def run(mbs, solve=solve_dynamic):
    mbs.Assemble()
    return solve(mbs, settings_of(0.1, 100), exu.DynamicSolverType.TrapezoidalIndex2)


@PLANAR
@pytest.mark.parametrize(
    ("regularisation", "solve", "last_load"),
    [(None, solve_dynamic, 800.0), *((1e-9, solve, 300.0) for solve in SOLVE)],
)
def test_a_contact_rubs_and_measures_after_a_contact_and_a_body_are_deleted_between_runs(
    regularisation, solve, last_load, planar
):
    mbs, law = new_model(), FRICTION | {"regularisation": regularisation}
    body, braked = (planar_body(mbs, 1.0, 0.5, [0.0] * 3, [1.0, 2.0, 7.0]) for _ in range(2))
    other = add_ring_friction(mbs, None, braked, normal_load=0.0, **law)
    friction = add_ring_friction(mbs, None, wheel(mbs, planar), normal_load=400.0, **law)
    quantities = "relative_spin", "transmitted_moment", "power", "heat"
    sensors = [friction.add_sensor(quantity) for quantity in quantities]
    for deleted, load in ((None, 400.0), (other.item, 400.0), (body, last_load)):
        if deleted is not None:
            mbs.DeleteObject(int(deleted), deleteDependentItems=deleted is body)
        friction.change(normal_load=load)
        changes = run(mbs, solve)
        moment = 0.03 * load
        spin = max(0.0, 3.0 - moment * 0.1 / 0.5)
        slides = spin > 0.0
        if not slides:
            assert [change.time for change in changes] == pytest.approx([3.0 * 0.5 / moment], abs=1e-9)
        heat = 0.5 * (3.0**2 - spin**2) / 2.0
        # Exudyn's own run starts without the rate of heat.
        accuracy = 1e-6 if solve is solve_dynamic else 1e-2
        shown = [float(mbs.GetSensorValues(sensor)) for sensor in sensors]
        assert shown == pytest.approx([spin, -moment * slides, moment * spin, heat], rel=accuracy, abs=1e-9)


@PLANAR
@pytest.mark.parametrize("solve", SOLVE)
def test_a_deleted_contact_releases_its_bodies(planar, solve):
    mbs = new_model()
    friction = add_ring_friction(mbs, None, wheel(mbs, planar), normal_load=800.0, **FRICTION)
    assert len(run(mbs)) == 1
    mbs.DeleteObject(friction.item, deleteDependentItems=False)
    run(mbs, solve)
    assert mbs.systemData.GetODE2Coordinates_t()[-1] == pytest.approx(3.0)


USES = {
    "change": lambda mbs, friction, support: friction.change(normal_load=1.0),
    "transmitted_moment": lambda mbs, friction, support: run(mbs, exu.MainSystem.SolveDynamic),
    "heat": lambda mbs, friction, support: run(mbs, exu.MainSystem.SolveDynamic),
    "stored energy": lambda mbs, friction, support: support.stored_energy(mbs),
}


@pytest.mark.parametrize("use", USES)
def test_a_deleted_part_cannot_be_changed_or_measured(use):
    mbs = new_model()
    node = wheel(mbs, True)
    friction = add_ring_friction(mbs, None, node, normal_load=8.0, regularisation=1.0, **FRICTION)
    support = add_radial_support(mbs, None, node, stiffness=1e3)
    if use in ("transmitted_moment", "heat"):
        friction.add_sensor(use)
    run(mbs)
    part, name = (support, "radial support 0") if use == "stored energy" else (friction, "friction contact 0")
    mbs.DeleteObject(part.item, deleteDependentItems=False)
    mbs.Assemble()
    with pytest.raises((ValueError, exu.ExudynError), match=f"'{name}' was deleted"):
        USES[use](mbs, friction, support)


def test_a_contact_without_its_constraints_is_refused():
    mbs = new_model()
    friction = add_ring_friction(mbs, None, wheel(mbs, True), normal_load=800.0, **FRICTION)
    mbs.DeleteObject(int(friction.item) + 1, deleteDependentItems=False)
    with pytest.raises(ValueError, match=r"object 1, 'friction contact 0': constraints .* were deleted"):
        run(mbs)


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


def test_a_thermal_node_finds_its_temperature_after_an_earlier_one_is_deleted():
    mbs = new_model()
    _, kept = (add_thermal_node(mbs, heat_capacity=1.0, start=start) for start in (30.0, 50.0))
    rotor(mbs, 1.0, 0.0)
    for deleted in (False, True):
        if deleted:
            mbs.DeleteObject(0)
        run(mbs)
        assert kept.temperature(mbs) == pytest.approx(50.0)
