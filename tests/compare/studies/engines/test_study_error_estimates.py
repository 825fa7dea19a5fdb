from dataclasses import replace

import numpy as np
import pytest
from faults.reference import simulate

from compare.claims.error_estimates import COARSENING, ROUNDING, SAFETY
from compare.claims.parameters import FIG5
from compare.engines import Engine
from compare.studies.engines.error_estimates.theory import KNOWN, PROBLEMS, Calibration, Problem, calibrated


def off_by(error):
    """Return an engine with the error ``error(tolerance)`` in a motion at rest."""

    def simulated(system, initial_state, times, *, tolerance=1e-9):
        trajectory = simulate(system, initial_state, times)
        return replace(trajectory, states=np.full_like(trajectory.states, 1.0 + error(tolerance)))

    return Engine("off", simulated)


ONES = Problem(
    FIG5, np.zeros(4), np.array([0.0, 1.0]), lambda trajectory: trajectory.states[-1].copy(), np.ones(4)
)


@pytest.mark.parametrize("power", [1 / 3, 0.5, 1.0, 2.0])
def test_coverage_and_overestimate_of_an_error_that_is_a_power_of_the_tolerance(power):
    found = calibrated(off_by(lambda tolerance: tolerance**power), [(ONES, 1e-5)] * 3)
    assert found.motions == 3
    assert found.coverage == 1.0
    assert found.over_estimate == pytest.approx(SAFETY * (1.0 - COARSENING**-power), rel=1e-3)


def test_a_constant_error_is_not_covered():
    assert calibrated(off_by(lambda tolerance: 1e-6), [(ONES, 1e-5)]).coverage == 0.0


def test_missing_numbers_are_not_covered():
    two = replace(ONES, quantity=lambda trajectory: trajectory.states[-1, :2].copy())
    found = calibrated(off_by(lambda tolerance: tolerance), [(two, 1e-5), (ONES, 1e-5)])
    assert found.coverage == 0.5
    assert np.all(found.ratios[:4] == 0.0)


def test_standard_error_of_the_coverage_counts_motions_not_numbers():
    motion = np.repeat(np.arange(100), 4)
    errors = np.where(motion < 10, 2.0, 0.5)
    found = Calibration(motion, errors, np.ones(400))
    assert found.coverage == pytest.approx(0.9)
    assert found.coverage_noise == pytest.approx(np.sqrt(0.9 * 0.1 / 99))


def test_a_number_that_does_not_change_by_chance_is_covered_by_the_others():
    def errors(tolerance):
        return np.array([tolerance, 0.5e-5, -tolerance, 2.0 * tolerance])  # the second does not change

    two = replace(ONES, quantity=lambda trajectory: trajectory.states[-1].copy())
    found = calibrated(off_by(errors), [(two, 1e-5)])
    assert found.coverage == 1.0
    assert found.ratios[1] == pytest.approx(2.0 * (1.0 - 1.0 / COARSENING) / 0.5, rel=1e-3)


def test_an_error_below_the_known_accuracy_counts_as_that_accuracy():
    found = Calibration(np.zeros(2, dtype=int), np.array([0.0, KNOWN / 3.0]), np.full(2, ROUNDING))
    assert found.over_estimate == pytest.approx(ROUNDING / KNOWN)


def test_times_and_positions_of_releases_have_the_same_scale():
    """Otherwise rounding of the time would dominate the error estimate of the position."""
    random = np.random.default_rng(5)
    for _ in range(20):
        assert np.all(np.abs(PROBLEMS["stick and release"](random).exact[4:]) < 7.0)
        size = np.abs(PROBLEMS["stick and release"](random).exact)
        assert np.hypot(*size[:2]) == pytest.approx(1.0)
        assert np.hypot(*size[2:4]) == pytest.approx(1.0)
