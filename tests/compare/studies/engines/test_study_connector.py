"""The study of the connectors agrees, and finds out a reaction without its arm and a wrong linearisation."""

from dataclasses import replace
from functools import partial

import pytest
from studies_under_test import findings_of, sentences, verdicts

import exudyn_models
from compare.claims.claim import Verdict
from compare.studies.engines.connector import claims as study
from exudyn_models.forces import user_functions
from exudyn_models.forces.jit import taking_lists

RING, POINTS = (f"{study.MOMENTA}: {contact}" for contact in ("ring", "six points"))


@pytest.mark.parametrize(
    ("engine", "expected"),
    [("exudyn", {RING, POINTS, study.LINEARISED}), ("exudyn-native", {POINTS})],
)
def test_every_statement_holds(engine, expected):
    findings = findings_of(study, engine, {})
    assert verdicts(findings) == dict.fromkeys(expected, Verdict.AGREES)
    assert set(study.draw({engine: findings.data})) == set(study.STUDY.figures)
    assert study.draw({}) == {}


def test_the_discs_slip_all_the_time_and_exchange_momentum():
    data = findings_of(study, "exudyn", {}).data
    each = data["six points: angular momenta"]
    assert abs(each[-1, 0] - each[0, 0]) > 0.1


def test_a_reaction_without_the_arm_of_the_force_is_found_out(monkeypatch):
    def without_arm(law, *arguments):
        if len(arguments) > 6:  # the Jacobian stays as it is
            return law(*arguments)
        *on_master, _, fx, fy, moment = law(*arguments)
        return *on_master, -moment, fx, fy, moment

    monkeypatch.setattr(
        user_functions, "taking_lists", lambda law, *sizes: partial(without_arm, taking_lists(law, *sizes))
    )
    assert sentences(findings_of(study, "exudyn", {}), Verdict.DIFFERS) == {RING, POINTS}


def test_a_linearisation_of_another_damping_is_found_out(monkeypatch):
    eigenvalues = exudyn_models.eigenvalues
    monkeypatch.setattr(
        exudyn_models,
        "eigenvalues",
        lambda system, state: eigenvalues(replace(system, damping=system.damping * (1.0 + 1e-6)), state),
    )
    assert sentences(findings_of(study, "exudyn", {}), Verdict.DIFFERS) == {study.LINEARISED}
