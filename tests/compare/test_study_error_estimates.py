from dataclasses import replace

import numpy as np
import pytest
from studies_under_test import altered

from compare.accuracy import COARSENING, SAFETY
from compare.calibration import Calibration, Problem, calibrated
from compare.claim import Verdict
from compare.engines import EVERY_KIND, Engine, engines
from compare.paper import FIG5
from compare.report.style import paper_style, saved
from compare.studies.error_estimates import COVERS, EXCEEDS, STUDY, draw, measure
from compare.studies.error_estimates_problems import PROBLEMS
from reference_model import simulate

CLOSED = [kind for kind in PROBLEMS if not kind.startswith("any motion")]


def verdicts(findings):
    return {claim.sentence: claim.verdict for claim in findings.claims}


@pytest.mark.parametrize("kind", CLOSED)
def test_closed_form_is_what_the_reference_comes_to_at_its_tightest(kind):
    random = np.random.default_rng(3)
    for _ in range(5):
        problem = PROBLEMS[kind](random)
        found = problem.measured(engines(["reference"])[0], 1e-13)
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
    both = Calibration.of([found, replace(found, errors=np.zeros(400))])
    assert both.motions == 200
    assert both.coverage == pytest.approx(0.95)


def test_right_engines_have_error_bars_that_mean_something():
    findings = {name: measure(engines([name])[0], 54) for name in ("reference", "exudyn-native")}
    for found in findings.values():
        assert verdicts(found)[EXCEEDS] is Verdict.AGREES, found.claims[1].measured
        assert found.claims[0].measured >= 0.97, found.claims[
            0
        ].note  # 54 motions, of which one may be missed
    with paper_style():
        figures = draw({name: found.data for name, found in findings.items()})
    assert set(figures) == set(STUDY.figures)
    assert saved(figures["error-estimates"])[1].startswith(b"\x89PNG")


def test_an_engine_with_friction_off_by_1e_6_is_not_covered():
    assert verdicts(measure(altered(friction_force=1.0 + 1e-6), 18))[COVERS] is Verdict.DIFFERS


def test_an_engine_that_takes_no_notice_of_the_tolerance_is_not_covered():
    def deaf(*arguments, tolerance):
        return simulate(*arguments, tolerance=1e-6)

    found = measure(Engine("deaf", deaf, EVERY_KIND), 18)
    assert set(verdicts(found).values()) == {Verdict.DIFFERS}
