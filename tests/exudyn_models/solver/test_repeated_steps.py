"""Heat, temperature and speeds of implicit runs whose steps are repeated."""

from typing import Any

import exudyn as exu
import exudyn.itemInterface
import numpy as np
import pytest
from free_bodies import rotor

from exudyn_models import add_energy_balance, add_ring_friction, add_thermal_node, solve_dynamic

items: Any = exudyn.itemInterface
SOLVERS = exu.DynamicSolverType

INERTIA, SPEED, MOMENT, UNTIL, CAPACITY = 1.0, 100.0, 48.0, 1.0, 100.0
STEPS = np.unique(np.geomspace(500, 8000, 20).round().astype(int))
DRIVE, FRICTION, ROTOR = 20.0, 6.0, 0.05


def brake_beside_a_clutch_that_sticks_and_slips(steps, solver, breaks=()):
    """Return speed, heat, temperature and the balance's residual at the end; the clutch makes steps be rejected."""
    mbs = exu.SystemContainer().AddSystem()
    wheel, driving, driven = rotor(mbs, INERTIA, SPEED), rotor(mbs, ROTOR, 0.0), rotor(mbs, ROTOR, 0.0)
    lining = add_thermal_node(mbs, heat_capacity=CAPACITY, surroundings=0.0)
    law = {"contact_radius": 0.1, "friction_coefficient": 0.3, "regularisation": 1e-5}
    brake = add_ring_friction(mbs, None, wheel, normal_load=MOMENT / 0.03, thermal_node=lining, **law)
    clutch = add_ring_friction(mbs, driving, driven, normal_load=FRICTION / 0.03, **law)

    def torque(mbs, t, *_):
        return DRIVE * np.sin(10.0 * np.pi * t)

    def drive(mbs, t):
        return torque(mbs, t) * float(mbs.GetNodeOutput(driving, exu.OutputVariableType.Coordinates_t))

    marker = mbs.AddMarker(items.MarkerNodeCoordinate(nodeNumber=driving, coordinate=0))
    mbs.AddLoad(items.LoadCoordinate(markerNumber=marker, loadUserFunction=torque))
    heat, temperature = brake.add_sensor("heat"), lining.add_sensor()
    read = add_energy_balance(
        mbs, gains={"drive": drive}, losses={"brake": brake.power, "clutch": clutch.power}
    )
    settings = exu.SimulationSettings()
    settings.solution.file.write = False
    settings.timeIntegration.endTime, settings.timeIntegration.numberOfSteps = UNTIL, steps
    solve_dynamic(mbs, settings, solver, breaks=breaks)
    speed = float(mbs.GetNodeOutput(wheel, exu.OutputVariableType.Coordinates_t))
    return (
        speed,
        mbs.GetSensorValues(heat),
        mbs.GetSensorValues(temperature)[0],
        np.abs(read().residual).max(),
    )


@pytest.mark.parametrize("breaks", [(), (0.3141,)], ids=["one run", "with a break"])
@pytest.mark.parametrize("solver", [SOLVERS.TrapezoidalIndex2, SOLVERS.GeneralizedAlpha], ids=str)
def test_heat_and_temperature_are_exact_whatever_steps_are_repeated(solver, breaks):
    steps = STEPS[::4] if breaks else STEPS
    found = np.array([brake_beside_a_clutch_that_sticks_and_slips(int(n), solver, breaks) for n in steps])
    # Under a constant moment: ω = ω0 − M·t/J, and all the kinetic energy that is lost becomes heat.
    speed = SPEED - MOMENT * UNTIL / INERTIA
    heat = INERTIA * (SPEED**2 - speed**2) / 2.0
    exact = [speed, heat, heat / CAPACITY]
    np.testing.assert_allclose(found[:, :3], np.broadcast_to(exact, (len(found), 3)), rtol=0.0, atol=1e-6)
    # The clutch comes to stick ten times: a step across such a corner is off by half of the power lost in it.
    corner = FRICTION * (DRIVE + 2.0 * FRICTION) / ROTOR * (UNTIL / steps) ** 2 / 2.0
    assert all(found[:, 3] < 10.0 * corner)
