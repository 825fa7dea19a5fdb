"""Slip that comes to rest where friction can hardly hold the body."""

import numpy as np
import pytest

from reference_model import PinOnDisc, simulate
from reference_model.motion.slip import landing
from reference_model.motion.slip.landing import Landings

HARDLY_HELD = PinOnDisc(
    mass=1.0, stiffness=1.0, damping=0.011224733781740163, friction_force=4.177781705193454,
    disc_speed=9.397081774781364, offset=0.014432604751170697, hardening=62.05311478353729,
)  # fmt: skip
"""Once a turn the pull exceeds what friction can hold, by a little and for a little while."""

START, TIMES = [0.0746237, -0.01714718, -0.00907985, 0.09159993], np.linspace(0.0, 8.0, 161)


@pytest.fixture
def pieces(monkeypatch):
    """The pieces of polynomials that were taken."""
    taken, found = [], Landings._piece

    def piece(self, y):
        result = found(self, y)
        taken.extend([] if result is None else [result])
        return result

    monkeypatch.setattr(Landings, "_piece", piece)
    return taken


def test_motion_with_landings_is_that_without(monkeypatch, pieces):
    quick = simulate(HARDLY_HELD, START, TIMES)
    assert sum(piece.share == 1.0 for piece in pieces) >= 3
    assert len(quick.stick_phases) >= 4
    monkeypatch.setattr(landing, "DRAWN", np.inf)
    pieces.clear()
    slow = simulate(HARDLY_HELD, START, TIMES)
    assert pieces == []
    assert len(slow.stick_phases) == len(quick.stick_phases)
    assert quick.stick_times == pytest.approx(slow.stick_times, abs=1e-9)
    assert np.abs(quick.states - slow.states).max() < 1e-8
    assert quick.solution.evaluations < 0.8 * slow.solution.evaluations


def test_states_on_a_landing_do_not_depend_on_the_tolerance():
    ends = simulate(HARDLY_HELD, START, TIMES, tolerance=1e-11).stick_times[-6::2]
    times = np.sort([0.0, *(end - delay for end in ends for delay in (1e-4, 1e-3, 3e-3)), ends[-1] + 1e-3])
    usual, tight = (simulate(HARDLY_HELD, START, times, tolerance=tolerance) for tolerance in (1e-9, 1e-11))
    assert np.abs(usual.slip_velocity - tight.slip_velocity).max() < 2e-8
    assert usual.stick_times == pytest.approx(tight.stick_times, abs=1e-8)
