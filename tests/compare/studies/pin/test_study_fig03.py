"""The study of Fig. 3 agrees for every sound engine and fails for each broken one."""

import numpy as np
import pytest
from broken_engines import broken_engines
from studies_under_test import findings_of, for_every_sound_engine, sentences, verdicts

from compare.claims.claim import Verdict
from compare.studies.pin.fig03 import claims as study

FEW = {"loads": (0.02, 0.06), "limits": (0.98, 1.2)}
ALL = {study.RESTS, study.CIRCLE, study.VANISHES, study.GONE, study.EIGENVALUES, study.STABLE}


@for_every_sound_engine
def test_every_statement_holds_in_a_sound_engine(engine):
    findings = study.measure(engine, **FEW)
    assert set(verdicts(findings)) == ALL
    assert verdicts(findings) == dict.fromkeys(ALL, Verdict.AGREES)


@pytest.mark.parametrize(
    ("fault", "seen"),
    [
        ("wrong sign", ALL),
        # Friction that is too strong along the diagonals moves the rest, but still damps.
        ("square", {study.RESTS, study.CIRCLE, study.VANISHES, study.EIGENVALUES}),
        # Damping does not move a position of rest, so (3) to (5) are blind to it: what they see of it is a
        # transient that takes longer than it should. The eigenvalues are not blind.
        ("half the damping", {study.EIGENVALUES}),
    ],
)
def test_a_broken_engine_is_found_out(fault, seen):
    findings = study.measure(broken_engines()[fault], **FEW)
    assert seen <= sentences(findings, Verdict.DIFFERS)


def test_half_the_damping_leaves_the_rest_where_it_was():
    claim = next(
        claim
        for claim in study.measure(broken_engines()["half the damping"], **FEW).claims
        if claim.sentence == study.RESTS
    )
    assert np.max(claim.difference) < 1e-6 * study.PIN.offset


def test_the_theory_holds():
    assert set(verdicts(study.theory()).values()) == {Verdict.AGREES}


def test_the_limit_load_is_extrapolated_from_exact_positions():
    loads = (0.05, 0.08)
    positions = np.array([study.equilibrium_position(study.with_load(load)) for load in loads])
    limit, error = study.vanishing_load(loads, positions, np.array([1e-9, 1e-9]))
    assert limit == pytest.approx(0.1, rel=1e-14)
    moved, _ = study.vanishing_load(loads, positions * (1.0 + 1e-9 / 0.06), np.zeros(2))
    assert abs(moved - limit) < error


def test_figures_are_drawn_whatever_is_there():
    data = {"reference": findings_of(study, "reference", FEW).data, "theory": study.theory().data}
    assert set(study.draw(data)) == set(study.STUDY.figures)
    for part in ({}, {"theory": data["theory"]}, {"reference": data["reference"]}):
        assert set(study.draw(part)) <= set(study.STUDY.figures)
