"""The plain engine, against closed forms and against the reference."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from compare.claims.parameters import FIG5, FIG11
from reference_model import SimulationError, plain, simulate

STUCK_DISC = replace(FIG11, friction_force=0.3, disc_speed=0.7, shaft_speed=0.6, offset=0.05)
MOTIONS = {
    "a pin that sticks twice": (FIG5, [0.1, 0.0, 0.03, 0.0]),
    "a pin that runs into a stop": (
        replace(FIG5, hardening=2.0, stop_gap=0.05, stop_stiffness=3.0),
        [0.1, 0.0, 0.1, 0.0],
    ),
    "a ring that comes to stick": (STUCK_DISC, [0.3, 0.0, 0.0, 0.0, 0.1, 0.5]),
    "points that come to stick": (replace(STUCK_DISC, contact_points=6), [0.3, 0.0, 0.0, 0.0, 0.1, 0.5]),
}
TIMES = np.linspace(0.0, 6.0, 7)


@pytest.mark.parametrize("motion", MOTIONS)
def test_motions_agree_with_the_reference_within_the_estimated_error(motion):
    system, start = MOTIONS[motion]
    exact = simulate(system, start, TIMES, tolerance=1e-11).states
    coarse, fine = (plain.simulate(system, start, TIMES, tolerance=size).states for size in (1e-4, 1e-6))
    estimate = np.max(np.abs(fine - coarse))
    # ε causes an error of about 1e-5 of the motion, and the steps 1e-7.
    assert np.max(np.abs(fine - exact)) < min(estimate, 5e-5)


def test_a_single_time_is_the_start():
    found = plain.simulate(FIG5, [0.1, 0.0, 0.03, 0.0], [2.0])
    assert found.states.tolist() == [[0.1, 0.0, 0.03, 0.0]]
    assert [(phase.kind, phase.start, phase.end) for phase in found.phases] == [("slip", 2.0, 2.0)]


def test_invalid_times_and_tolerance_are_refused():
    with pytest.raises(ValueError, match="times must increase"):
        plain.simulate(FIG5, [0.1, 0.0, 0.0, 0.0], [0.0, 0.0])
    with pytest.raises(ValueError, match="tolerance = 1"):
        plain.simulate(FIG5, [0.1, 0.0, 0.0, 0.0], [0.0, 1.0], tolerance=1.0)


def test_failed_integration_is_reported(monkeypatch):
    failed = SimpleNamespace(success=False, message="steps too small", t=np.array([0.0]))
    monkeypatch.setattr(plain, "solve_ivp", lambda *_, **__: failed)
    with pytest.raises(SimulationError, match="steps too small; try a larger tolerance"):
        plain.simulate(FIG5, [0.1, 0.0, 0.0, 0.0], [0.0, 1.0])
