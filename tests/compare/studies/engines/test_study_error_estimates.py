from dataclasses import replace

import numpy as np
import pytest
from studies_under_test import altered

from compare.claims.claim import Verdict
from compare.claims.error_estimates import COARSENING, ROUNDING, SAFETY
from compare.claims.paper_parameters import FIG5
from compare.engines import EVERY_KIND, Engine, engines
from compare.figures import paper_style, saved
from compare.studies.engines.error_estimates.calibration import KNOWN, Calibration, Problem, calibrated
from compare.studies.engines.error_estimates.claims import COVERS, EXCEEDS, STUDY, draw, measure
from compare.studies.engines.error_estimates.problems import PROBLEMS
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


def of_kind(findings, sentence):
    return {
        kind: claim
        for kind in PROBLEMS
        for claim in findings.claims
        if claim.sentence == sentence.format(kind)
    }


def test_right_engines_have_error_bars_that_mean_something_in_every_kind_of_motion():
    motions = {"reference": 108, "exudyn-native": 36}
    findings = {name: measure(engines([name])[0], number) for name, number in motions.items()}
    for found in findings.values():
        assert len(found.claims) == 2 * len(of_kind(found, COVERS)) == 2 * len(of_kind(found, EXCEEDS))
        for claim in of_kind(found, EXCEEDS).values():
            assert claim.verdict is Verdict.AGREES, claim.note
        for claim in of_kind(found, COVERS).values():
            assert claim.verdict is Verdict.AGREES, claim.note
    assert len(of_kind(findings["reference"], COVERS)) == len(PROBLEMS)
    with paper_style():
        figures = draw({name: found.data for name, found in findings.items()})
    assert set(figures) == set(STUDY.figures)
    assert saved(figures["error-estimates"])[1].startswith(b"\x89PNG")


def test_one_bad_kind_of_motion_is_not_hidden_by_the_others():
    """An engine whose thrown rings are off by 1e-6 of their way."""

    def simulated(system, *arguments, **options):
        trajectory = simulate(system, *arguments, **options)
        thrown = system.stiffness == 0.0
        return replace(trajectory, states=trajectory.states * (1.0 + 1e-6 * thrown))

    found = measure(Engine("off", simulated, EVERY_KIND), 18)
    differing = {kind for kind, claim in of_kind(found, COVERS).items() if claim.verdict is Verdict.DIFFERS}
    assert differing == {"thrown ring"}


def test_an_engine_with_friction_off_by_1e_6_is_not_covered():
    found = of_kind(measure(altered(friction_force=1.0 + 1e-6), 18), COVERS)
    without_friction = {"damped oscillation", "lag of the shaft"}
    differing = {kind for kind, claim in found.items() if claim.verdict is Verdict.DIFFERS}
    assert differing & without_friction == set()
    assert {"whirl", "any motion of a pin", "any motion of a ring", "thrown ring"} <= differing


def test_an_engine_that_takes_no_notice_of_the_tolerance_is_not_covered():
    def deaf(*arguments, tolerance):
        return simulate(*arguments, tolerance=1e-6)

    found = of_kind(measure(Engine("deaf", deaf, EVERY_KIND), 18), COVERS)
    differing = {kind for kind, claim in found.items() if claim.verdict is Verdict.DIFFERS}
    assert differing == set(PROBLEMS) - {"stick and release"}  # which the reference has in closed form
