"""An implicit run starts with the power that friction has, and tells of a load that jumps in it."""

import warnings
from typing import Any

import exudyn as exu
import exudyn.itemInterface
import numpy as np
import pytest

from exudyn_models import add_energy_balance, add_ring_friction, solve_dynamic

items: Any = exudyn.itemInterface
SOLVERS = [exu.DynamicSolverType.GeneralizedAlpha, exu.DynamicSolverType.TrapezoidalIndex2]
INERTIA, SPEED, MOMENT = 0.5, 50.0, 0.3 * 800.0 * 0.1


def settings(steps, end=0.25):
    result = exu.SimulationSettings()
    result.solution.file.write = False
    result.solution.sensors.writePeriod = 0.0
    options = result.timeIntegration
    options.endTime, options.numberOfSteps, options.verboseMode = end, steps, 0
    return result


def brake(load, unit=1.0, balance=True):
    mbs = exu.SystemContainer().AddSystem()
    wheel = mbs.AddNode(items.Node1D(initialVelocities=[SPEED]))
    mbs.AddObject(items.ObjectRotationalMass1D(nodeNumber=wheel, inertia=INERTIA))
    friction = add_ring_friction(
        mbs,
        None,
        wheel,
        contact_radius=0.1,
        friction_coefficient=0.3,
        normal_load=load,
        regularisation=1e-2,
    )
    if not balance:
        return mbs, friction.add_sensor("heat")
    return mbs, add_energy_balance(mbs, gains={}, losses={"brake": friction.power}, unit=unit)


def told(run):
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        run()
    return [str(one.message) for one in caught]


@pytest.mark.parametrize("solver", SOLVERS)
def test_works_are_exact_from_the_first_step_on_where_power_is_linear(solver):
    # The trapezoidal rule is exact then; without the first power it would be wrong by h/2·M·ω = 3 J.
    mbs, read = brake(800.0)
    solve_dynamic(mbs, settings(50), solver)
    balance = read()
    assert balance.losses["brake"][-1] == pytest.approx(MOMENT * (50.0 - 48.0 * 0.125) * 0.25, rel=1e-10)
    assert np.max(np.abs(balance.residual)) < 1e-10 * balance.turnover


@pytest.mark.parametrize("solver", SOLVERS)
def test_works_are_exact_after_a_break_too(solver):
    mbs, read = brake(lambda time: 0.0 if time < 0.1037 else 800.0)
    assert told(lambda: solve_dynamic(mbs, settings(50), solver, breaks=[0.1037])) == []
    balance = read()
    assert np.max(np.abs(balance.residual)) < 1e-9 * balance.turnover


@pytest.mark.parametrize("balance", [True, False])
@pytest.mark.parametrize("solver", SOLVERS)
def test_a_load_that_jumps_is_told_with_its_time_and_the_remedy(solver, balance):
    mbs, _ = brake(lambda time: 0.0 if time < 0.1037 else 800.0, unit=10.0, balance=balance)
    (message,) = told(lambda: solve_dynamic(mbs, settings(50), solver))
    name = "brake" if balance else "heat"
    # Within the step of 5 ms, by M·ω0 = 1200 W less what the step has braked already.
    assert message.startswith(
        f"the power '{name}' jumps by 1.2e+03 W between t = 0.1 s and 0.105 s: the energy"
    )
    assert "may be wrong by 3 J" in message
    assert message.endswith("breaks=[...]; if none does, take shorter steps")


@pytest.mark.parametrize("solver", SOLVERS)
@pytest.mark.parametrize(
    "load", [800.0, 6000.0, lambda time: 3e3 * time, lambda time: 3e3 * np.sin(20.0 * time) ** 2]
)
def test_no_jump_is_told_of_a_load_that_the_steps_resolve_nor_of_the_end_of_slip(solver, load):
    mbs, _ = brake(load)
    assert told(lambda: solve_dynamic(mbs, settings(100), solver)) == []


@pytest.mark.parametrize("step", range(5, 14))
def test_a_jump_is_told_once_wherever_the_steps_looked_at_together_end(step, monkeypatch):
    monkeypatch.setattr("exudyn_models.solver.jumps.TOGETHER", 8)
    mbs, _ = brake(lambda time: 0.0 if time < (step + 0.5) * 5e-3 else 800.0)
    (message,) = told(lambda: solve_dynamic(mbs, settings(50), SOLVERS[1]))
    assert f"between t = {step * 5e-3:.9g} s and {(step + 1) * 5e-3:.9g} s: the energy" in message
