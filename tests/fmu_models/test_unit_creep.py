"""What creeps is stiff: co-simulation goes through it by another method, in few steps and without error."""

from dataclasses import asdict

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import reference_model
from reference_model.systems import COLUMNS, DiscOnDisc

RESTING = DiscOnDisc(
    mass=1.0, polar_inertia=0.02, stiffness=1.0, damping=0.1, friction_force=0.4, disc_speed=1.2, offset=0.1,
    contact_radius=0.12, shaft_damping=0.005, shaft_speed=0.0, contact_points=3,
)  # fmt: skip
START = (0.3, 0.1, 0.0, 0.2, 0.3, 0.4)


def test_points_that_come_to_rest_cost_no_more_and_err_less_the_slower_they_creep(instance):
    reference = reference_model.simulate(RESTING, START, [0.0, 30.0], tolerance=1e-12)
    assert [phase.kind for phase in reference.phases] == ["slip", "pivot", "stick"]
    starts = dict(zip([name for name, _ in COLUMNS[DiscOnDisc]], START, strict=True))
    errors = []
    for epsilon in (1e-5, 1e-7):  # explicit steps would be 8e-5 s long, or 8e-7 s
        unit = instance("disc", **asdict(RESTING), **starts, regularisation=epsilon).started()
        unit.to(30.0)
        assert unit.steps() < 15000
        errors.append(np.max(np.abs(unit.state - reference.at_end)))
    assert abs(np.log10(errors[0] / errors[1]) - 2.0) < 1e-3, errors


@pytest.mark.parametrize(
    "contact", [{"inner_radius": 0.06}, {"contact_points": 5.0}], ids=["annulus", "points"]
)
def test_a_clutch_that_holds_moves_as_another_solver_says(instance, contact):
    held = {"speed_a": 100.0, "speed_b": 99.999, "offset": 1e-4, "static_ratio": 1.2, "regularisation": 1e-5}
    unit, other = (instance("clutch", **held, **contact).started() for _ in range(2))

    def rates(time, state):
        other.state = state
        return other.rates

    def jacobian(time, state):
        other.state = state
        columns = [other.along(**{one.name: 1.0}) for one in other.model.states]
        return np.array([[column[one.name] for column in columns] for one in other.model.derivatives])

    run = solve_ivp(rates, (0.0, 0.01), unit.state, "Radau", [0.01], rtol=1e-9, atol=1e-13, jac=jacobian)
    unit.to(0.01)
    x, y, vx, vy, heat = np.abs(unit.state - run.y[:, -1])
    assert max(x, y) < 1e-13
    assert max(vx, vy) < 1e-11
    assert heat < 1e-9
    assert unit["slip_speed"] > 1e-5
    assert unit.steps() < 1000
