"""An implicit run starts with the actual power of friction, and reports load jumps."""

import warnings

import exudyn as exu
import numpy as np
import pytest
from free_bodies import new_model, rotor, settings_of

from exudyn_models import add_energy_balance, add_ring_friction, solve_dynamic
from exudyn_models.solver.checks.jumps import JumpCheck

pytestmark = pytest.mark.filterwarnings("ignore:the energy balance is off")  # a load jumps within a step

SOLVERS = pytest.mark.parametrize(
    "solver", [exu.DynamicSolverType.GeneralizedAlpha, exu.DynamicSolverType.TrapezoidalIndex2], ids=str
)
INERTIA, SPEED, MOMENT, STEP = 0.5, 50.0, 0.3 * 800.0 * 0.1, 5e-3


def warnings_of(*arguments, **options):
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        solve_dynamic(*arguments, **options)
    return [str(one.message) for one in caught]


def run(load, solver, *, step=STEP, unit=1.0, balance=True, breaks=()):
    """Brake a rotor under a load for 0.25 s; return the warnings, and the balance if there is one."""
    mbs = new_model()
    law = {"contact_radius": 0.1, "friction_coefficient": 0.3, "regularisation": 1e-2}
    friction = add_ring_friction(mbs, None, rotor(mbs, INERTIA, SPEED), normal_load=load, **law)
    if not balance:
        friction.add_sensor("heat")
    else:
        read = add_energy_balance(mbs, gains={}, losses={"brake": friction.power}, unit=unit)
    settings = settings_of(0.25, round(0.25 / step))
    settings.solution.sensors.writePeriod = 0.0
    return warnings_of(mbs, settings, solver, breaks=breaks), read() if balance else None


@SOLVERS
def test_works_are_exact_from_the_first_step_and_from_a_break_on_where_power_is_linear(solver):
    # The trapezoidal rule is exact here; without the initial power its error would be h/2·M·ω = 3 J.
    _, balance = run(800.0, solver)
    assert balance.losses["brake"][-1] == pytest.approx(MOMENT * (50.0 - 48.0 * 0.125) * 0.25, rel=1e-10)
    assert np.max(np.abs(balance.residual)) < 1e-10 * balance.turnover
    told, balance = run(lambda time: 800.0 * (time > 0.1037), solver, breaks=[0.1037])
    assert told == []
    assert np.max(np.abs(balance.residual)) < 1e-9 * balance.turnover


@SOLVERS
@pytest.mark.parametrize("balance", [True, False])
def test_a_load_jump_is_reported_with_its_time_and_the_remedy(solver, balance):
    (message,), _ = run(lambda time: 800.0 * (time > 0.1037), solver, unit=10.0, balance=balance)
    name = "brake" if balance else "heat"
    # The jump within the step of 5 ms is M·ω0 = 1200 W, less the effect of the deceleration in the step.
    assert message.startswith(
        f"the power '{name}' jumps by 1.2e+03 W between t = 0.1 s and 0.105 s: the energy"
    )
    assert "may be wrong by 3 J" in message
    assert message.endswith("breaks=[...]; otherwise use shorter steps")


@SOLVERS
@pytest.mark.parametrize(("load", "warns"), [(0.1, False), (40.0, True)])
def test_a_jump_that_is_small_compared_with_the_other_powers_is_noise(solver, load, warns):
    """A second brake of 0.15 or 60 W, while the first one turns 1200 W into heat."""
    mbs = new_model()
    wheel, law = rotor(mbs, INERTIA, SPEED), {"contact_radius": 0.1, "friction_coefficient": 0.3}
    loads = {"brake": 800.0, "other brake": lambda time: load * (time > 0.1037)}
    losses = {
        name: add_ring_friction(mbs, None, wheel, normal_load=load, regularisation=1e-2, **law).power
        for name, load in loads.items()
    }
    add_energy_balance(mbs, gains={}, losses=losses)
    told = warnings_of(mbs, settings_of(0.15, 30), solver)
    assert [message.split(" jumps")[0] for message in told] == ["the power 'other brake'"] * warns


def rise(width):
    """Return a load that rises in the middle of a step over about ``width`` steps."""
    return lambda time: 400.0 * (1.0 + np.tanh((time - 20.5 * STEP) / (width * STEP)))


@SOLVERS
@pytest.mark.parametrize(
    ("load", "step"),
    [
        (800.0, 2.5e-3),
        (6000.0, 2.5e-3),  # slip ends
        (lambda time: 3e3 * time, 2.5e-3),
        (lambda time: 3e3 * np.sin(20.0 * time) ** 2, 2.5e-3),
        (rise(0.7), STEP),  # changes 3.4 times as much as in the neighbouring steps
        # The period is four steps, so the load changes in every other step.
        (lambda time: 800.0 + 300.0 * np.sin(np.pi / 2.0 * time / STEP + np.pi / 4.0), STEP),
    ],
)
def test_no_jump_is_reported_for_a_load_that_the_steps_resolve_or_for_the_end_of_slip(solver, load, step):
    assert run(load, solver, step=step)[0] == []


@SOLVERS
def test_close_jumps_a_small_jump_and_a_rise_within_a_step_are_reported(solver):
    jumps = 20.5 * STEP, 23.5 * STEP
    (message,), _ = run(lambda time: 400.0 * ((time > jumps[0]) + 2.0 * (time > jumps[1])), solver)
    assert "and powers do so in 2 steps of this run" in message
    assert len(run(rise(0.3), solver)[0]) == 1
    assert len(run(lambda time: 800.0 + 80.0 * (time > jumps[0]), solver)[0]) == 1


@pytest.mark.parametrize("step", range(3, 9))
def test_a_jump_is_reported_once_at_any_place_in_a_batch_of_steps(step, monkeypatch):
    monkeypatch.setattr("exudyn_models.solver.checks.jumps.TOGETHER", 8)
    load, solver = lambda time: 800.0 * (time > (step + 0.5) * STEP), exu.DynamicSolverType.TrapezoidalIndex2
    (message,), _ = run(load, solver)
    assert f"between t = {step * STEP:.9g} s and {(step + 1) * STEP:.9g} s: the energy" in message


def test_rows_at_the_same_time_do_not_overflow():
    """Contacts that stick exactly choose their modes in several attempts at the start."""
    mbs = new_model()
    add_energy_balance(mbs, gains={}, losses={"brake": lambda mbs, t: 0.0})
    mbs.Assemble()
    check = JumpCheck(mbs)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        for step in range(-2, 20):
            check.look(1e-3 * max(0, step), np.array([24.0 * step]))
        check.warn()


@pytest.mark.parametrize(("later", "told"), [(1.0, 1), (1e3, 0)])
def test_a_jump_is_noise_if_powers_become_much_larger_after_it(later, told, monkeypatch):
    monkeypatch.setattr("exudyn_models.solver.checks.jumps.TOGETHER", 8)
    mbs = new_model()
    add_energy_balance(mbs, gains={}, losses={"brake": lambda mbs, t: 0.0})
    mbs.Assemble()
    check = JumpCheck(mbs)
    for step in range(40):
        power = float(step > 10) + (later - 1.0) * np.clip((step - 20) / 20.0, 0.0, 1.0)
        check.look(1e-3 * step, np.array([power]))
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        check.warn()
    assert len(caught) == told
