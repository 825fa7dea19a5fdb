"""Grade and sentence for each engine, derived only from verdicts and error bars."""

from dataclasses import replace

import pytest
from fake_studies import AGREEMENT, FAILING, GOOD, VERDICTS, recorded

from compare.report.at_a_glance import cases, glances
from compare.report.matrix import matrix
from compare.run.runner import Run, run

pytestmark = pytest.mark.usefixtures("all_in_this_process")

SLIDES, STICKS, TURNS = "A pin slides", "A pin sticks", "A disc turns"
IN_SHORT = {
    SLIDES: ("slides", "our reference"),
    STICKS: ("sticks", "closed form"),
    TURNS: ("disc", "our reference"),
}
RESOLUTION = 0.01
"""Resolution in m; another friction law changes ten times as much."""


def setting(engine, name, own=True, **off):
    words = {"slides": SLIDES, "sticks": STICKS, "disc": TURNS}
    by_sentence = {words[motion]: both for motion, both in off.items()}
    return recorded(engine, name, by_sentence, resolution=RESOLUTION, own=own, cases=IN_SHORT)


FINE = {"slides": (1e-6, 2e-6), "sticks": (3e-6, 4e-6), "disc": (1e-6, 1e-6)}
BOXES = "box", "as shipped", "pyramid"
WRONG = FINE | {"slides": (0.5, 1e-6)}


def settings():
    return (
        setting("ours", "", **dict.fromkeys(FINE, (1e-12, 1e-12))),
        replace(
            setting("Wrong", "box", **WRONG),
            advice="use small steps",
            reasons={SLIDES: "every body loses speed"},
        ),
        *(replace(setting("Kite", name, **WRONG), law="box", whirl=0.26) for name in BOXES),
        setting("Kite", "a user's", own=False, **dict.fromkeys(FINE, (0.0, 0.0))),
        replace(setting("Kite", "cone", **FINE), law="cone", whirl=1e-6, advice="use small steps"),
        setting("Pins", "cone", slides=(1e-3, 2e-3), sticks=(1e-3, 9e-3)),
        setting("Pins", "box", **WRONG),  # as many motions agree, but one differs
        replace(
            setting("Open", "cone", **FINE | {"disc": (0.0, 0.5)}), reasons={TURNS: "its error bar is 0.5 m"}
        ),
        setting("Blind", "cone", slides=(0.0, 0.5)),
    )


@pytest.fixture(scope="module")
def seen(tmp_path_factory, all_in_this_process):
    study = replace(AGREEMENT, provided=AGREEMENT.provided | {"recorded": settings})
    result = run((study, VERDICTS), (GOOD, FAILING), folder=tmp_path_factory.mktemp("seen"))
    result.versions["good"] = "3"
    return result


@pytest.fixture(scope="module")
def found(seen):
    return {one.engine: one for one in glances(seen, matrix(seen))}


def test_engines_of_the_run_come_first_then_the_recorded_ones_by_grade(found):
    assert list(found) == ["good", "failing", "ours", "Kite", "Open", "Pins", "Blind", "Wrong"]


def test_a_grade_is_the_largest_error_relative_to_the_effect_of_another_law(found):
    grades = {name: one.grade for name, one in found.items()}
    assert grades["ours"] == "exact"  # 1e-12 relative to 0.1 m
    assert grades["Kite"] == "fine"  # 4e-6 relative to 0.1 m
    assert grades["Pins"] == "rough"  # an error bar of 9e-3 relative to 0.1 m
    assert grades["Blind"] == "open"
    assert (grades["Wrong"], grades["good"], grades["failing"]) == ("differs",) * 3


def test_the_best_setting_of_its_own_friction_represents_an_engine(found):
    assert found["Kite"].sentence == (
        "With the setting “cone”, friction is Coulomb's, and the error decreases as the step is refined. Use small "
        "steps. Avoid the settings “box” and “pyramid” and the default settings, because a box replaces the friction "
        "cone. At any step, 1 of 3 motions (“slides”) is wrong, and the radius of the whirl is 26 % off."
    )
    assert (found["Kite"].where, found["Kite"].why) == (
        "?engine=Kite#agreement-recorded/kite",
        "#agreement-recorded/kite",
    )


def test_a_sentence_lists_missing_motions_and_differences(found):
    assert "decreases as the step is refined. We did not simulate “disc”. Avoid" in found["Pins"].sentence
    assert found["Open"].sentence.endswith(". “disc” is undecided: its error bar is 0.5 m.")
    assert found["Blind"].sentence.startswith("With the setting “cone”, the errors are too large to decide. ")
    assert found["Wrong"].sentence == (
        "With the setting “box”, 1 of 3 motions (“slides”) is wrong at any step. Every body loses speed. "
        "In the other motions, use small steps."
    )
    assert found["Pins"].cells[2] is None


def test_an_engine_of_the_run_is_described_by_its_claims(found):
    assert found["good"].sentence == (
        "3 of 5 checks against independent evidence agree. 1 check differs and 1 is inconclusive. "
        "Measured 4 of 5 claims (80 %)."
    )
    assert (found["good"].version, found["good"].why) == ("3", "?engine=good#studies")
    assert found["failing"].sentence == ("1 of 1 checks against independent evidence agree. 4 checks failed.")


def test_an_engine_that_was_also_recorded_has_the_grade_of_its_motions(seen):
    one = Run(
        (seen.studies[0],), ("ours",), outcomes={("agreement", "ours"): seen.outcomes["agreement", "good"]}
    )
    (ours, *_) = glances(one, matrix(one))
    assert (ours.grade, len(ours.cells)) == ("exact", 3)
    headings = {"slides": "our reference", "sticks": "closed form", "disc": "our reference"}
    assert cases(matrix(one).recorded[0]) == headings


def test_an_engine_without_claims_in_the_studies_has_no_row(tmp_path):
    one = run((replace(AGREEMENT, only=("good",)),), (GOOD, FAILING), folder=tmp_path)
    assert [found.engine for found in glances(one, matrix(one))] == ["good"]


def test_without_recorded_motions_the_coarsest_claim_grades(tmp_path):
    one = run((AGREEMENT,), (GOOD,), folder=tmp_path)
    (good,) = glances(one, matrix(one))
    assert (good.grade, good.cells) == ("exact", ())
    nothing = Run((AGREEMENT,), ("good",))
    assert glances(nothing, matrix(nothing))[0].grade == "open"
