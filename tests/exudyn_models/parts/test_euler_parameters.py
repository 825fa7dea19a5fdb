"""Friction and support of bodies with Euler parameters, Exudyn's default, under implicit solvers."""

import exudyn as exu
import numpy as np
import pytest
from free_bodies import settings_of
from pairs_of_bodies import EULER, bodies_of, conserved, momenta_and_energy

from exudyn_models import (
    add_energy_balance,
    add_radial_support,
    add_ring_friction,
    largest_stable_step,
    solve_dynamic,
)

RING = {"friction_coefficient": 0.25, "normal_load": 2.0, "contact_radius": 0.12, "regularisation": 0.01}


def model(kinds, friction=True):
    mbs, nodes = bodies_of(kinds)
    if friction:
        return mbs, nodes, add_ring_friction(mbs, *nodes, **RING)
    return mbs, nodes, add_radial_support(mbs, *nodes, stiffness=20.0, damping=0.3, hardening=10.0)


@pytest.mark.parametrize(
    ("kinds", "friction"),
    [((EULER, EULER), True), ((EULER, EULER), False), (("rotor", EULER), False), ((EULER, "planar"), False)],
    ids=str,
)
@pytest.mark.filterwarnings("ignore:the energy balance is off")  # the test asserts how far
def test_momentum_is_kept_to_rounding_and_angular_momentum_and_energy_to_second_order(kinds, friction):
    drifts, leaks = [], []
    for steps in (50, 100):
        mbs, nodes, contact = model(kinds, friction)
        stored = [] if friction else [contact.stored_energy]
        read = add_energy_balance(mbs, gains={}, losses={"contact": contact.power}, stored=stored)
        mbs.Assemble()
        before, _ = momenta_and_energy(mbs, kinds, nodes)
        solve_dynamic(mbs, settings_of(0.2, steps, newton=1e-12), exu.DynamicSolverType.TrapezoidalIndex2)
        change = np.abs(momenta_and_energy(mbs, kinds, nodes)[0] - before)
        assert all(change[[i for i in conserved(kinds) if i < 3]] < 1e-11)
        drifts.append(max(change[conserved(kinds)]))
        balance = read()
        assert balance.losses["contact"][-1] > 1e-3
        leaks.append(np.max(np.abs(balance.residual)))
    for errors in (drifts, leaks):
        assert np.log2(errors[0] / errors[1]) == pytest.approx(2.0, abs=0.2)


def test_an_explicit_solver_is_refused_with_the_node_that_serves():
    mbs, _, _ = model((EULER, EULER))
    with pytest.raises(
        ValueError, match=r"ignore constraints, and this model has 2;.*NodeRigidBodyEP.*RotVecLG"
    ):
        solve_dynamic(mbs, settings_of(0.2, 10), exu.DynamicSolverType.RK44)
    with pytest.raises(ValueError, match="2 constraint equations, which an explicit solver would ignore"):
        largest_stable_step(mbs, exu.DynamicSolverType.RK44)
