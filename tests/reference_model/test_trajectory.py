"""Derived quantities of a trajectory, and its immutability."""

from dataclasses import FrozenInstanceError

import numpy as np
import pytest

from reference_model import PinOnDisc, simulate
from reference_model.trajectory import Phase, Solution, Trajectory

FIG_5 = PinOnDisc(mass=1.0, stiffness=1.0, damping=0.1, friction_force=0.09, disc_speed=1.5, offset=0.1)
STATES = np.array([[3.0, 4.0, 0.5, -0.25], [1.0, 0.0, 0.0, 1.5], [0.0, 0.0, -3.0, 4.0]])


@pytest.fixture
def trajectory():
    phases = (
        Phase("slip", 0.0, 1.0, STATES[0]),
        Phase("stick", 1.0, 1.5, STATES[1]),
        Phase("slip", 1.5, 2.0, STATES[1]),
    )
    solution = Solution(method="by hand", tolerance=1e-9, evaluations=0, steps=0, wall_time=0.0)
    return Trajectory(FIG_5, np.array([0.0, 1.0, 2.0]), STATES.copy(), phases, solution)


def test_radius_slip_and_stick_phases_follow_from_states_and_phases(trajectory):
    assert trajectory.radius == pytest.approx([5.0, 1.0, 0.0], rel=1e-15)
    # (ẋ + ωy, ẏ − ωx) with ω = 1.5; a point that turns with the disc does not slip.
    assert trajectory.slip_velocity == pytest.approx(np.array([[6.5, -4.75], [0.0, 0.0], [-3.0, 4.0]]))
    assert trajectory.slip_speed == pytest.approx([np.hypot(6.5, 4.75), 0.0, 5.0])
    assert trajectory.at_end.tolist() == STATES[-1].tolist()
    assert trajectory.stick_phases == (trajectory.phases[1],)


def test_result_is_immutable_and_describes_the_computation():
    result = simulate(FIG_5, [0.1, 0.0, 0.03, 0.0], [0.0, 1.0, 2.0], tolerance=1e-7)
    for array in (result.times, result.states, result.at_end):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 1.0
    for part, name in ((result, "states"), (result.phases[0], "kind"), (result.solution, "tolerance")):
        with pytest.raises(FrozenInstanceError):
            setattr(part, name, None)
    solution = result.solution
    assert solution.tolerance == 1e-7
    assert solution.evaluations > solution.steps > 0
    assert solution.wall_time > 0.0
    assert "DOP853" in solution.method
