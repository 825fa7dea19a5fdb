"""Every study: sound engines agree, and each claim differs for a gross and for a small fault."""

import numpy as np
import pytest
from studies_under_test import AGREES, DIFFERS, GROSS, INCONCLUSIVE, verdicts
from tested_studies import TESTED

from compare.studies import STUDIES


@pytest.fixture(scope="module", params=TESTED.values(), ids=TESTED)
def tested(request):
    """Return each study in turn; the scope keeps tests of one study together, because they share findings."""
    return request.param


def test_the_table_contains_every_study():
    assert sorted(TESTED) == sorted(study.name for study in STUDIES)


def test_every_claim_holds_in_every_sound_engine(tested):
    for engine in tested.sound:
        parts, not_claimed = tested.parts.get(engine, ()), tested.not_claimed.get(engine, ())
        expected = {
            sentence
            for sentence, part in tested.study.sentences().items()
            if (name := part.partition("/")[0]) not in not_claimed
            and (not parts or name in parts or part in parts)
        }
        found = tested.found(engine)
        assert (engine, verdicts(found)) == (engine, dict.fromkeys(expected, AGREES))
        assert all(claim.source for claim in found.claims)


def test_the_theory_holds(tested):
    claims = {claim.identity: claim.verdict for claim in tested.found("theory").claims}
    assert len(claims) == sum(not one.of_engine for one in tested.study.declared for _ in one.cases())
    assert {name for name, verdict in claims.items() if verdict is INCONCLUSIVE} == set(tested.open_theory)
    assert DIFFERS not in claims.values()


def test_an_engine_for_points_is_measured_on_points_and_missing_systems_are_reported(tested):
    if "reference" not in tested.sound:
        pytest.skip("the study is not about engines like this one")
    found, everything = tested.found("points"), verdicts(tested.found("reference"))
    assert verdicts(found).items() <= everything.items()
    assert bool(found.not_simulated) == (len(found.claims) < len(everything))


def unbroken(tested, faults, parts):
    """Return those of the claims ``parts`` that agree with every fault, each with its last measurement."""
    left = dict.fromkeys(parts)
    for fault in faults.values():
        only = getattr(fault, "only", ())
        for part in [part for part in left if not only or part.partition("/")[0] in only]:
            try:
                claims = tested.claims_of_fault(fault, (part,))
            except RuntimeError:  # the engine lacks this motion, which a report shows as a failure
                del left[part]
                continue
            if any(claim.verdict is DIFFERS for claim in claims):
                del left[part]
            elif claims:
                (left[part],) = claims
    return left


def too_coarse_for_a_per_cent(claim):
    """Return whether the claim counts answers, is about an order or has a budget above 1 % of its prediction.

    An order deviates by an absolute amount, not by a percentage.
    """
    return claim.kind == "order" or (claim.relative_error > 0.01 and bool(np.any(claim.predicted)))


def test_each_claim_says_whether_half_the_friction_spoils_it(tested):
    """The headline of a report counts the agreements that say so."""
    if not {"reference", "as reported"} & set(tested.sound):
        pytest.skip("tests of the study change the friction of its model")
    wrong = {}
    for part in tested.study.sentences().values():
        try:
            claims = tested.claims_of_fault(GROSS["half the friction"], (part,))
        except RuntimeError:  # no such motion with so little friction
            continue
        wrong |= {one.identity: one.friction for one in claims if (one.verdict is AGREES) == one.friction}
    assert wrong == {}


def test_each_claim_fails_for_a_gross_fault(tested):
    assert set(unbroken(tested, tested.gross, tested.study.sentences().values())) == set()


def test_each_claim_fails_for_a_fault_of_one_per_cent(tested):
    parts = tested.study.sentences()
    sound = [claim for engine in tested.sound for claim in tested.found(engine).claims]
    coarse = {parts[claim.sentence] for claim in sound if too_coarse_for_a_per_cent(claim)}
    left = unbroken(tested, tested.small, [part for part in parts.values() if part not in coarse])
    fine = {part for part, claim in left.items() if claim is None or not too_coarse_for_a_per_cent(claim)}
    assert {part.partition("/")[0] for part in fine} == set(tested.blind)


@pytest.mark.filterwarnings("ignore:No artists with labels")  # from a panel about other systems
def test_figures_are_drawn_from_any_available_data(tested):
    if not tested.drawn:
        pytest.skip("too few numbers, see the study's own test")
    study, theory = tested.study, {"theory": tested.found("theory").data}
    found = {name: tested.found(name).data for name in tested.sound[:1]}
    points = tested.found("points").data if "reference" in tested.sound else {}
    partial = {"points": points} if points else found
    everything = found | theory
    everything["exudyn"] = next(iter(everything.values()))
    for case in (theory, partial, everything):
        present = {name: values for name, values in case.items() if values}
        if not present:
            continue
        figures = study.draw(present)
        assert set(figures) <= set(study.figures)
        if case is everything:
            assert figures or not study.figures
            for figure in figures.values():
                figure.set_layout_engine("none")  # other tests cover the layout
                figure.draw_without_rendering()  # all but the pixels, a quarter of the time
