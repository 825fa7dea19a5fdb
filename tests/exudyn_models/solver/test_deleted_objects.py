"""Contacts after ``mbs.DeleteObject``, which renumbers objects and nodes."""

import exudyn as exu
import numpy as np
import pytest
from free_bodies import drive, new_model, planar_body, rate_of, rotor, settings_of

from exudyn_models import add_ring_friction, solve_dynamic

FRICTION = {"contact_radius": 0.1, "friction_coefficient": 0.3}


def wheel(mbs, planar):
    return planar_body(mbs, 1.0, 0.5, [0.0] * 3, [0.0, 0.0, 3.0]) if planar else rotor(mbs, 0.5, 3.0)


def run(mbs):
    mbs.Assemble()
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


def test_a_deleted_contact_lets_go_of_what_it_held():
    mbs = new_model()
    node = wheel(mbs, planar=False)
    friction = add_ring_friction(mbs, None, node, normal_load=800.0, **FRICTION)
    assert len(run(mbs)) == 1
    mbs.DeleteObject(friction.item, deleteDependentItems=False)
    drive(mbs, node, 5.0)
    assert run(mbs) == []
    assert rate_of(mbs, node) == pytest.approx(4.0)


def test_a_deleted_contact_cannot_be_changed():
    mbs = new_model()
    friction = add_ring_friction(mbs, None, wheel(mbs, True), normal_load=8.0, regularisation=1.0, **FRICTION)
    mbs.DeleteObject(friction.item, deleteDependentItems=False)
    with pytest.raises(ValueError, match=r"^'friction contact 0' was deleted"):
        friction.change(normal_load=1.0)


def test_a_contact_without_its_constraints_is_refused():
    mbs = new_model()
    friction = add_ring_friction(mbs, None, wheel(mbs, True), normal_load=800.0, **FRICTION)
    mbs.DeleteObject(int(friction.item) + 1, deleteDependentItems=False)
    with pytest.raises(ValueError, match=r"object 1, 'friction contact 0': constraints .* were deleted"):
        run(mbs)
