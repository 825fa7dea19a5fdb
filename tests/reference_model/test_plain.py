"""The plain engine, against closed forms and against the reference."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from compare.claims.parameters import FIG5, FIG11
from reference_model import SimulationError, plain, simulate
from reference_model.contact.contact_law import Ring

STUCK_DISC = replace(FIG11, friction_force=0.3, disc_speed=0.7, shaft_speed=0.6, offset=0.05)
MOTIONS = {
    "a pin that sticks twice": (FIG5, [0.1, 0.0, 0.03, 0.0]),
    "a pin that stays stuck": (replace(FIG5, friction_force=0.3, disc_speed=0.7), [0.4, 0.0, 0.0, 0.1]),
    "a pin that runs into a stop": (
        replace(FIG5, hardening=2.0, stop_gap=0.05, stop_stiffness=3.0),
        [0.1, 0.0, 0.1, 0.0],
    ),
    "a ring that slips": (FIG11, [0.05, 0.0, 0.0, 0.0, 0.0, 0.5]),
    "a ring that comes to stick": (STUCK_DISC, [0.3, 0.0, 0.0, 0.0, 0.1, 0.5]),
    "points that come to stick": (replace(STUCK_DISC, contact_points=6), [0.3, 0.0, 0.0, 0.0, 0.1, 0.5]),
}
TIMES = np.linspace(0.0, 12.0, 9)
COARSE, FINE = 1e-4, 1e-6


def errors(system, start):
    """Return the error at ``FINE`` against the reference, and its estimate, the change from ``COARSE``."""
    exact = simulate(system, start, TIMES, tolerance=1e-11).states
    coarse, fine = (
        plain.simulate(system, start, TIMES, tolerance=tolerance).states for tolerance in (COARSE, FINE)
    )
    return np.max(np.abs(fine - exact)), np.max(np.abs(fine - coarse))


@pytest.mark.parametrize("motion", MOTIONS)
def test_motions_agree_with_the_reference_within_the_estimated_error(motion):
    error, change = errors(*MOTIONS[motion])
    assert error < min(change, 5e-5)  # ε causes about 1e-5 of the motion, and the steps 1e-7


WRONG = {
    "force": lambda x, y, moment: (-x, -y, moment),
    "moment": lambda x, y, moment: (x, y, -moment),
    "force in y": lambda x, y, moment: (x, -y, moment),
}


@pytest.mark.parametrize("fault", WRONG)
def test_friction_of_the_wrong_sign_is_detected(fault, monkeypatch):
    right = plain.on_ring

    def wrong(*arguments):
        friction = right(*arguments)
        return lambda *slip: WRONG[fault](*friction(*slip))

    monkeypatch.setattr(plain, "on_ring", wrong)
    error, change = errors(*MOTIONS["a ring that slips"])
    assert error > 100.0 * min(change, 5e-5)


@pytest.mark.parametrize("slip", [(0.01, 0.02, 0.5, 0.3), (0.3, -0.1, -0.5, 2.0)])
def test_the_law_of_a_ring_is_the_limit_of_points(slip):
    R = FIG11.contact_radius
    law, points = plain.by_law(0.5, Ring(R)), plain.on_ring(0.5, R, 2000, 0.0)
    assert law(*slip) == pytest.approx(points(*slip), abs=1e-13)


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
