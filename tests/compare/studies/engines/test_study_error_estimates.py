"""The study of error estimates: errors that are known are covered and exceeded as computed."""

from dataclasses import replace

import numpy as np
import pytest
from faults.reference import simulate
from studies_under_test import engine_named
from tested_studies import ERROR_ESTIMATES

from compare.claims.claim import Verdict
from compare.claims.error_estimates import COARSENING, ROUNDING, SAFETY
from compare.claims.parameters import FIG5
from compare.engines import Engine
from compare.studies.engines.error_estimates.study import STUDY, simulated
from compare.studies.engines.error_estimates.theory import KNOWN, PROBLEMS, Calibration, Problem, calibrated

CLOSED = [kind for kind in PROBLEMS if not kind.startswith("any motion")]


def of(motions):
    """Return the arguments with which so many random motions are measured."""
    return {"coverage": {"motions": motions}, "over_estimate": {"motions": motions}}


def thrown_rings_off(system, *arguments, **options):
    """Put thrown rings off by 1e-6 of their way."""
    trajectory = simulate(system, *arguments, **options)
    thrown = system.stiffness == 0.0
    return replace(trajectory, states=trajectory.states * (1.0 + 1e-6 * thrown))


def test_native_contact_has_error_bars_that_mean_something_in_all_that_it_simulates():
    engine = engine_named("exudyn-native")
    found = STUDY.measure(engine, of(36))
    assert len(found.claims) == 2 * len(simulated(engine)) > 0
    assert {claim.verdict for claim in found.claims} == {Verdict.AGREES}, [c.note for c in found.claims]
    assert found.not_simulated == "exudyn-native does not simulate a disc on a continuous ring"
    figures = STUDY.draw({"exudyn-native": found.data, "reference": ERROR_ESTIMATES.found("reference").data})
    assert set(figures) == set(STUDY.figures)


@pytest.mark.parametrize("kind", CLOSED)
def test_closed_form_is_what_the_reference_comes_to_at_its_tightest(kind):
    random = np.random.default_rng(3)
    for _ in range(5):
        problem = PROBLEMS[kind](random)
        found = problem.measured(engine_named("reference"), 1e-13)
        # The response is a mean over X0, which takes as many digits as X0 is small.
        accuracy = 1e-4 if kind == "response to an offset" else 3e-12
        assert np.max(np.abs(found - problem.exact)) <= accuracy * np.max(np.abs(problem.exact))


def off_by(error):
    """Return an engine that is exact in a motion at rest but for ``error(tolerance)``."""

    def simulated(system, initial_state, times, *, tolerance=1e-9):
        trajectory = simulate(system, initial_state, times)
        return replace(trajectory, states=np.full_like(trajectory.states, 1.0 + error(tolerance)))

    return Engine("off", simulated)


ONES = Problem(
    FIG5, np.zeros(4), np.array([0.0, 1.0]), lambda trajectory: trajectory.states[-1].copy(), np.ones(4)
)


@pytest.mark.parametrize("power", [1 / 3, 0.5, 1.0, 2.0])
def test_an_error_that_falls_as_a_power_of_the_tolerance_is_covered_and_exceeded_as_computed(power):
    found = calibrated(off_by(lambda tolerance: tolerance**power), [(ONES, 1e-5)] * 3)
    assert found.motions == 3
    assert found.coverage == 1.0
    assert found.over_estimate == pytest.approx(SAFETY * (1.0 - COARSENING**-power), rel=1e-3)


def test_an_error_that_does_not_fall_is_not_covered():
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


def test_one_of_several_numbers_that_changes_by_nothing_by_chance_is_covered_by_the_others():
    def errors(tolerance):
        return np.array([tolerance, 0.5e-5, -tolerance, 2.0 * tolerance])  # the second does not change

    two = replace(ONES, quantity=lambda trajectory: trajectory.states[-1].copy())
    found = calibrated(off_by(errors), [(two, 1e-5)])
    assert found.coverage == 1.0
    assert found.ratios[1] == pytest.approx(2.0 * (1.0 - 1.0 / COARSENING) / 0.5, rel=1e-3)


def test_an_error_below_what_is_known_of_the_motion_counts_as_that():
    found = Calibration(np.zeros(2, dtype=int), np.array([0.0, KNOWN / 3.0]), np.full(2, ROUNDING))
    assert found.over_estimate == pytest.approx(ROUNDING / KNOWN)


def test_rounding_of_a_release_counts_for_the_place_too_only_if_both_are_of_one_size():
    """Else the estimate of the place would be far above its error, whatever the engine does."""
    random = np.random.default_rng(5)
    for _ in range(20):
        assert np.all(np.abs(PROBLEMS["stick and release"](random).exact[4:]) < 7.0)
        size = np.abs(PROBLEMS["stick and release"](random).exact)
        assert np.hypot(*size[:2]) == pytest.approx(1.0)
        assert np.hypot(*size[2:4]) == pytest.approx(1.0)
