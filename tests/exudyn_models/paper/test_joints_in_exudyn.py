"""Exudyn's joints move like the closed forms."""

import numpy as np
import pytest

import exudyn_models
from reference_model import FrictionJoint, SimulationError, simulate

JOINT = FrictionJoint(inertia=0.5, friction_moment=2.0, static_ratio=1.5)
SPRUNG = FrictionJoint(
    inertia=0.5, friction_moment=1.5, static_ratio=1.4, damping=0.3, stiffness=4.0, offset=0.3,
    moment=((0.0, 0.0), (1.0, 6.0), (2.5, -7.0), (4.0, 2.0)),
)  # fmt: skip
TIMES = np.linspace(0.0, 4.0, 17)


def errors(engine, joint, state, *tolerances):
    exact = simulate(joint, state, TIMES).states
    runs = [engine(joint, state, TIMES, tolerance=tolerance).states for tolerance in tolerances]
    return [float(np.max(abs(run - exact))) for run in runs]


@pytest.mark.parametrize(
    ("joint", "state"), [(JOINT, (0.1, -3.0)), (SPRUNG, (0.2, 1.0)), (SPRUNG, (0.0, 0.0))]
)
def test_joint_with_exact_stick_converges_to_the_closed_form(joint, state):
    coarse, fine = errors(exudyn_models.simulate, joint, state, 1e-7, 1e-9)
    assert fine < max(0.03 * coarse, 1e-9)  # of second order in the step, which is √tolerance
    assert fine < 1e-6


def test_joint_with_exact_stick_rests_for_an_hour_and_breaks_away_at_its_static_moment():
    held = FrictionJoint(inertia=0.5, friction_moment=2.0, static_ratio=1.5, moment=((0.0, 2.99),))
    run = exudyn_models.simulate(held, (0.1, 0.0), [0.0, 1800.0, 3600.0])
    assert np.all(run.states == (0.1, 0.0))
    ramp = FrictionJoint(inertia=0.5, friction_moment=2.0, static_ratio=1.5, moment=((0.0, 0.0), (4.0, 6.0)))
    coarse, fine = errors(exudyn_models.simulate, ramp, (0.0, 0.0), 1e-7, 1e-9)
    assert fine < min(0.03 * coarse, 1e-5)


def test_native_friction_of_a_joint_converges_and_holds():
    coarse, fine = errors(exudyn_models.simulate_with_native_contact, JOINT, (0.1, -3.0), 1e-7, 1e-9)
    # static friction ends at a speed of the order √tolerance
    assert fine < min(0.15 * coarse, 3e-3)
    held = FrictionJoint(inertia=0.5, friction_moment=2.0, moment=((0.0, 1.0),))
    run = exudyn_models.simulate_with_native_contact(held, (0.0, 0.0), [0.0, 5.0, 10.0], tolerance=1e-8)
    assert np.all(np.abs(run.states[1:]) <= (0.5 * 1e3 * 1e-8, 1e-12))  # half of its limit


def test_invalid_joint_motion_in_exudyn_is_refused():
    with pytest.raises(ValueError, match="a joint takes an angle and a spin"):
        exudyn_models.simulate(JOINT, (0.0, 0.0, 0.0, 0.0), [0.0, 1.0])
    fast = FrictionJoint(inertia=1e-6, friction_moment=2.0, stiffness=1e6)
    with pytest.raises(SimulationError, match="more than 5,000,000 steps are needed"):
        exudyn_models.simulate(fast, (0.0, 1.0), [0.0, 1.0])
