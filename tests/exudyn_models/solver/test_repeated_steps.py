"""Heat, temperature and speeds of implicit runs whose steps are repeated."""

import exudyn as exu
import numpy as np
import pytest
from free_bodies import drive, new_model, rate_of, rotor, settings_of

from exudyn_models import add_ring_friction, add_thermal_node, simulate_fixed_step, solve_dynamic
from reference_model import PinOnDisc

SOLVERS = exu.DynamicSolverType

INERTIA, SPEED, MOMENT, UNTIL, CAPACITY = 1.0, 100.0, 48.0, 1.0, 100.0
STEPS = 500, 1414


def brake_next_to_a_clutch_that_sticks_and_slips(steps, solver, breaks):
    """Return the brake's speed, heat and temperature at the end; the clutch causes rejected steps."""
    mbs = new_model()
    wheel, driving, driven = rotor(mbs, INERTIA, SPEED), rotor(mbs, 0.05, 0.0), rotor(mbs, 0.05, 0.0)
    lining = add_thermal_node(mbs, heat_capacity=CAPACITY, surroundings=0.0)
    law = {"contact_radius": 0.1, "friction_coefficient": 0.3, "regularisation": 1e-5}
    brake = add_ring_friction(mbs, None, wheel, normal_load=MOMENT / 0.03, thermal_node=lining, **law)
    add_ring_friction(mbs, driving, driven, normal_load=200.0, **law)
    drive(mbs, driving, lambda t: 20.0 * np.sin(10.0 * np.pi * t))
    heat, temperature = brake.add_sensor("heat"), lining.add_sensor()
    solve_dynamic(mbs, settings_of(UNTIL, int(steps)), solver, breaks=breaks)
    return rate_of(mbs, wheel), mbs.GetSensorValues(heat), mbs.GetSensorValues(temperature)[0]


@pytest.mark.parametrize("breaks", [(), (0.3141,)], ids=["one run", "with a break"])
@pytest.mark.parametrize("solver", [SOLVERS.TrapezoidalIndex2, SOLVERS.GeneralizedAlpha], ids=str)
def test_heat_and_temperature_are_exact_if_steps_are_repeated(solver, breaks):
    # Under a constant moment ω = ω0 − M·t/J, and all lost kinetic energy becomes heat.
    speed = SPEED - MOMENT * UNTIL / INERTIA
    heat = INERTIA * (SPEED**2 - speed**2) / 2.0
    for steps in STEPS:
        found = brake_next_to_a_clutch_that_sticks_and_slips(steps, solver, breaks)
        np.testing.assert_allclose(found, [speed, heat, heat / CAPACITY], rtol=0.0, atol=1e-6)


def test_generalised_alpha_with_rejected_steps_is_of_second_order_for_a_pin_too():
    pin = PinOnDisc(mass=1.0, stiffness=1.0, damping=0.1, friction_force=0.09, disc_speed=1.5, offset=0.1)
    coarse, fine = (
        simulate_fixed_step(
            pin,
            [0.1, 0.0, 0.03, 0.0],
            [0.0, 10.0, 20.0],
            integrator="GeneralizedAlpha",
            step=step,
            regularisation=1e-4,
        ).states
        for step in (1e-2, 2.5e-3)
    )
    assert np.abs(coarse - fine).max() < 1e-2**2
