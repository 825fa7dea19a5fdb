"""Friction that heats a capacity, and a coefficient that fades with its temperature."""

import exudyn as exu
import numpy as np
import pytest
from free_bodies import items, new_model, rate_of, rotor, settings_of

from exudyn_models import add_energy_balance, add_ring_friction, add_thermal_node, solve_dynamic

INERTIA, SPEED, LOAD, RADIUS, MU, FADE, CAPACITY = 0.5, 50.0, 800.0, 0.1, 0.3, 5e-3, 8.0


def brake(coefficient, conductance=0.0):
    mbs = new_model()
    wheel = rotor(mbs, INERTIA, SPEED)
    thermal = add_thermal_node(mbs, heat_capacity=CAPACITY, conductance=conductance, surroundings=20.0)
    law = {"contact_radius": RADIUS, "friction_coefficient": coefficient, "normal_load": LOAD}
    friction = add_ring_friction(mbs, None, wheel, **law, regularisation=1e-1, thermal_node=thermal)
    return mbs, wheel, friction, thermal


def fading(temperature):
    return MU * (1.0 - FADE * (temperature - 20.0))


def run(mbs, end=0.5, steps=500, solver=exu.DynamicSolverType.RK67, go_on=False):
    solve_dynamic(mbs, settings_of(end, steps), solver, updateInitialValues=go_on)


def by_hand(t):
    # C·(T − T0) = ½·J·(ω0² − ω²), so ω' = −a·(b + c·ω²), whose solution is a tangent.
    a, c = MU * LOAD * RADIUS / INERTIA, FADE * INERTIA / (2.0 * CAPACITY)
    b = 1.0 - c * SPEED**2
    return np.sqrt(b / c) * np.tan(np.arctan(SPEED * np.sqrt(c / b)) - a * np.sqrt(b * c) * t)


@pytest.mark.parametrize(("solver", "accuracy"), [("RK67", 1e-11), ("TrapezoidalIndex2", 1e-5)])
def test_a_brake_that_fades_slows_down_by_the_closed_form(solver, accuracy):
    mbs, wheel, _, thermal = brake(fading)
    run(mbs, solver=getattr(exu.DynamicSolverType, solver), steps=2000)
    assert rate_of(mbs, wheel) == pytest.approx(by_hand(0.5), rel=accuracy)
    warming = INERTIA * (SPEED**2 - by_hand(0.5) ** 2) / 2.0 / CAPACITY
    assert thermal.temperature(mbs) == pytest.approx(20.0 + warming, rel=accuracy)


@pytest.mark.parametrize(("solver", "rounding"), [("RK44", 1e-13), ("TrapezoidalIndex2", 1e-9)])
def test_heat_is_in_the_capacity_and_in_the_surroundings_to_rounding(solver, rounding):
    """Newton's tolerance is 1e-8 of the coordinates."""
    mbs, _, friction, thermal = brake(fading, conductance=4.0)
    heat, sensor = friction.add_sensor("heat"), thermal.add_sensor()
    read = add_energy_balance(
        mbs, gains={}, losses={"surroundings": thermal.power}, stored=[thermal.stored_energy]
    )
    run(mbs, solver=getattr(exu.DynamicSolverType, solver))
    temperature, lost = mbs.GetSensorValues(sensor)
    total = float(mbs.GetSensorValues(heat))
    assert 0.1 < lost / total < 0.9
    assert CAPACITY * (temperature - 20.0) + lost == pytest.approx(total, rel=rounding)
    if solver == "RK44":
        balance = read()
        assert balance.losses["surroundings"][-1] > 50.0
        assert np.max(np.abs(balance.residual)) < 1e-10 * balance.turnover


def test_a_coefficient_of_temperature_may_read_slip_too_and_be_changed():
    mbs, wheel, friction, thermal = brake(
        lambda temperature, slip_speed: 0.0 * slip_speed + fading(temperature)
    )
    run(mbs, end=0.25, go_on=True)
    assert rate_of(mbs, wheel) == pytest.approx(by_hand(0.25), rel=1e-10)
    friction.change(friction_coefficient=lambda temperature: 0.0)
    run(mbs, end=0.25)
    assert rate_of(mbs, wheel) == pytest.approx(by_hand(0.25), rel=1e-10)
    assert thermal.temperature(mbs) > 30.0


def test_a_hot_node_cools_exponentially_and_another_source_heats_it():
    mbs = new_model()
    mbs.AddObject(items.ObjectMass1D(nodeNumber=mbs.AddNode(items.Node1D()), mass=1.0))
    hot = add_thermal_node(mbs, heat_capacity=8.0, conductance=4.0, surroundings=20.0, start=80.0)
    heated = add_thermal_node(mbs, heat_capacity=8.0)
    heated.heated_by(lambda mbs, t: 3.0 + t)
    run(mbs, end=1.0, steps=100)
    assert hot.temperature(mbs) == pytest.approx(20.0 + 60.0 * np.exp(-0.5), rel=1e-12)
    assert hot.stored_energy(mbs) == pytest.approx(8.0 * 60.0 * np.exp(-0.5), rel=1e-12)
    assert heated.temperature(mbs) == pytest.approx(20.0 + 3.5 / 8.0, rel=1e-13)
