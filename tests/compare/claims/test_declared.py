"""Declared claims: properties known before the measurement, and results of the measurement."""

from dataclasses import replace

import numpy as np
import pytest

from compare.claims.claim import THEORY, Grade, Verdict
from compare.claims.measured import Measured, answers_of, asked
from compare.claims.parameters import FIG5
from compare.claims.prose import Prose
from compare.claims.study import Study
from compare.engines import Engine, UnsupportedSystemError
from compare.report.numbers import worst
from reference_model import simulate
from reference_model.orbits import NoOrbitError

LOADS = (0.02, 0.05)
ENGINE = Engine("exact", simulate)


def study_of(*names):
    study = Study("rest", Prose("Rest"), system=FIG5, source="Fig. 5")

    def rests(engine, loads=LOADS):
        off = np.array([[0.0, 1e-4], [3e-3, 0.0]])
        return Measured(
            predicted=np.ones((2, 2)),
            value=np.ones((2, 2)) + off,
            error=1e-3,
            at={"μN in N": loads},
            components=("x", "spin"),
            data={"loads": loads},
        )

    def whirls(engine, speed):
        if engine.name == "lame":
            raise UnsupportedSystemError("lame does not \x1bwhirl")
        return None if engine.contact_only else Measured(predicted=speed, value=speed)

    def sticks(engine):
        return answers_of(*asked(lambda tolerance: [True, tolerance > 1e-12], 1e-9))

    def adds_up(terms=3):
        return Measured(predicted=1.0, value=1.0, error=1.0 / terms, resolution=1.0)

    declared = {
        "rests": (rests, {"resolution": 1e-3, "swept": ("friction_force",), "note": "Declared."}),
        "whirls": (whirls, {"resolution": 1.0, "each": {"slow disc": 1.0, "fast disc": 3.0}}),
        "sticks": (sticks, {"implied_by": rests}),
        "adds_up": (adds_up, {"kind": "formula"}),
    }
    for name in names:
        function, options = declared[name]
        sentence = "A {} whirls" if name == "whirls" else f"It {name}"
        study.claim(sentence, **options)(function)
    return study


ALL = ("rests", "whirls", "sticks", "adds_up")


def test_sentences_are_known_without_measuring():
    study = study_of(*ALL)
    assert study.sentences() == {
        "It rests": "rests",
        "A slow disc whirls": "whirls/slow disc",
        "A fast disc whirls": "whirls/fast disc",
        "It sticks": "sticks",
    }
    assert study.declared[2].implied_by == "It rests"
    assert (study_of("rests").has_theory, study.has_theory) == (False, True)


def repeats(engine, speed):
    return Measured(predicted=speed, value=speed)


def test_a_member_of_a_family_is_implied_by_the_same_member_of_another():
    study = study_of("whirls")
    whirls = study.declared[0].function
    study.claim("A {} repeats", resolution=1.0, each={"slow disc": 1.0}, implied_by=whirls)(repeats)
    assert study.measure(ENGINE, only=("repeats",)).claims[0].implied_by == "A slow disc whirls"


@pytest.mark.parametrize(
    ("engine", "only", "identities", "gaps"),
    [
        (ENGINE, (), ["rest/rests", "rest/whirls/slow-disc", "rest/whirls/fast-disc", "rest/sticks"], []),
        (replace(ENGINE, name="lame"), (), ["rest/rests", "rest/sticks"], 2 * [r"lame does not \x1bwhirl"]),
        (replace(ENGINE, contact_only=True), (), ["rest/rests", "rest/sticks"], []),
        (ENGINE, ("sticks", "whirls/fast disc"), ["rest/whirls/fast-disc", "rest/sticks"], []),
    ],
)
def test_claims_that_the_engine_supports_are_measured(engine, only, identities, gaps):
    found = study_of(*ALL).measure(engine, only=only)
    assert [claim.identity for claim in found.claims] == identities
    assert (found.not_simulated, list(found.gaps.values())) == ("", gaps)


def test_declarations_that_do_not_fit_are_rejected():
    with pytest.raises(ValueError, match="duplicate claim id rest/rests"):
        study_of("rests", "rests")
    study = study_of()
    study.claim("It repeats", each={"disc": 1.0})(repeats)
    with pytest.raises(ValueError, match="no resolution given"):
        study.measure(ENGINE)


def test_a_claim_has_the_declared_properties_and_names_its_elements():
    found = study_of("rests").measure(ENGINE, {"rests": {"loads": (1.0, 0.05)}})
    assert found.data["loads"].tolist() == [1.0, 0.05]
    (claim,) = found.claims
    assert claim.verdict is Verdict.DIFFERS
    assert worst(claim).name == "μN = 0.05 N, x"
    assert worst(replace(claim, axes=())).name == "no. 3 of 4"
    assert claim.parameters.keys() >= {"mass", "offset"}
    assert "friction_force" not in claim.parameters
    assert claim.source == "Fig. 5"


@pytest.mark.parametrize(
    "names",
    [
        {"at": {"t in s": (1.0, 2.0, 3.0)}},
        {"components": ("x",)},
        {"at": {"a": (1, 2), "b": (1, 2), "c": ()}},
    ],
)
def test_names_of_another_shape_are_rejected(names):
    with pytest.raises(ValueError, match=r"numbers of shape \(2, 2\) have names for"):
        _ = Measured(predicted=np.ones((2, 2)), value=np.ones((2, 2)), **names).axes


def test_a_budget_that_is_too_small_is_named_and_lowers_the_grade():
    study = study_of()

    @study.claim("It whirls {}", resolution=1e-2, each={"a little": 5e-8, "much": 5e-7})
    def whirls(engine, off):
        return Measured(predicted=1.0, value=1.0 + off, error=1e-8)

    little, much = study.measure(ENGINE).claims
    assert (little.verdict, little.grade) == (Verdict.AGREES, Grade.EXACT)
    assert little.note == "The error budget of 1e-08 was too small for the difference of 5e-08."
    assert much.verdict is Verdict.DIFFERS  # more than NEGLIGIBLE


def test_data_that_cannot_be_drawn_cost_no_verdict():
    study = study_of()

    def of_unequal_lengths():
        return {"change": np.zeros(3) - np.zeros(2)}

    @study.claim("It whirls", resolution=1.0)
    def whirls(engine, data=of_unequal_lengths):
        return Measured(predicted=1.0, value=1.0, data=data)

    found = study.measure(ENGINE)
    assert (found.claims[0].verdict, found.data) == (Verdict.AGREES, {})
    assert "Not drawn, because of ValueError: operands could not be broadcast" in found.claims[0].note
    ragged = study.measure(ENGINE, {"whirls": {"data": {"rows": [[1.0], [1.0, 2.0]]}}})
    assert (ragged.claims[0].verdict, ragged.data) == (Verdict.AGREES, {})


def test_the_theory_has_no_engine():
    (claim,) = study_of(*ALL).measure_theory({"adds_up": {"terms": 4}}).claims
    assert (claim.engine, claim.basis) == (THEORY, "algebra")
    assert float(claim.budget.total) == 0.25


PROSE = """# A title

What the paper
says of {range}.

More of it.

## Finding

{share, 3 digits} % of them.

## Figures

### branches

A caption.
"""


@pytest.fixture
def folder(tmp_path):
    result = tmp_path / "pin" / "title"
    result.mkdir(parents=True)
    (result / "study.md").write_text(PROSE, encoding="utf-8")
    return result


def test_prose_is_read(folder):
    prose = Prose.of(folder / "claims.py", {"range": "0 to 1 N"})
    assert (prose.title, prose.section) == ("A title", "The friction pin")
    assert prose.paper == "What the paper says of 0 to 1 N.\n\nMore of it."
    assert prose.finding == "{share, 3 digits} % of them."
    assert prose.figures == {"branches": "A caption."}
    assert Prose.of(folder / "claims" / "rest.py", {"range": ""}).title == "A title"


def test_a_study_without_captions_has_one_figure_with_its_own_name_and_title(folder):
    (folder / "study.md").write_text("# A title\n\nWhat the paper says.\n", encoding="utf-8")
    study = Study.beside(str(folder / "claims.py"), "title")
    assert study.figures == {}
    study.provides(figures=dict)
    assert study.figures == {"title": "A title"}
    with pytest.raises(TypeError, match="study title cannot provide movies: expected figures, animations"):
        study.provides(movies=dict)


def test_prose_without_title_word_or_group_is_rejected(folder):
    with pytest.raises(ValueError, match=r"\{loads\} is missing"):
        Prose.of(folder / "claims.py", {"loads": "0"})
    (folder / "study.md").write_text(PROSE.replace("# A title", "## A title"), encoding="utf-8")
    with pytest.raises(ValueError, match="must begin with a title"):
        Prose.of(folder / "claims.py", {})
    elsewhere = folder.parents[1] / "elsewhere"
    folder.parent.rename(elsewhere)
    with pytest.raises(ValueError, match="not 'elsewhere'"):
        Prose.of(elsewhere / "title" / "claims.py", {})


def test_a_failed_search_for_an_orbit_is_reported_in_terms_of_the_engine():
    def whirls(engine):
        raise NoOrbitError("no whirl: shooting stopped at a relative residual of 1.1e+01; start elsewhere")

    study = Study("rest", Prose("Rest"), system=FIG5, source="Fig. 5")
    study.claim("It whirls", resolution=1.0)(whirls)
    with pytest.raises(RuntimeError, match=r"^exact has no periodic motion near .* residual of 1.1e\+01\)$"):
        study.measure(ENGINE)


def test_an_orbit_that_returns_only_roughly_is_not_measured_and_no_failure():
    def whirls(engine):
        raise NoOrbitError("no whirl", 2.7e-7)

    study = Study("rest", Prose("Rest"), system=FIG5, source="Fig. 5")
    study.claim("It whirls", resolution=1.0)(whirls)
    found = study.measure(ENGINE)
    assert found.gaps["It whirls"].startswith(
        "exact is too inaccurate for shooting, because it misses its start by 2.7e-07"
    )


@pytest.mark.parametrize(
    ("more", "verdict"),
    [({}, Verdict.DIFFERS), ({"step": 1e-3}, Verdict.AGREES), ({"precision": 1e-6}, Verdict.AGREES)],
)
def test_differences_within_the_resolution_matter_only_for_engines_that_follow_the_tolerance(more, verdict):
    study = Study("rest", Prose("Rest"), system=FIG5, source="Fig. 5")
    study.claim("It rests", resolution=1e-3)(lambda engine: Measured(predicted=1.0, value=1.0001, error=1e-5))
    (claim,) = study.measure(replace(ENGINE, **more)).claims
    assert claim.verdict is verdict
