"""The study of sticking agrees for every sound engine and fails for each broken one."""

import numpy as np
import pytest
from broken_engines import broken_engines
from studies_under_test import findings_of, for_every_sound_engine, sentences, verdicts

from compare.claims.claim import Verdict
from compare.studies.pin.sticking_domain import claims as study
from compare.studies.toolkit.sticking import safest_angle
from reference_model.formulas.pin import squared_holding_force

FEW = {"speeds": (1.4,), "searched": (0.9, 1.0, 1.1)}
ALL = {study.STAYS, study.HOLDS, study.LETS_GO, study.LARGEST, study.RESONANT}


@for_every_sound_engine
def test_every_statement_holds_in_a_sound_engine(engine):
    findings = study.measure(engine, **FEW)
    assert set(verdicts(findings)) == ALL
    assert verdicts(findings) == dict.fromkeys(ALL, Verdict.AGREES)


@pytest.mark.parametrize(
    ("fault", "seen"),
    [
        ("wrong sign", ALL),
        ("square", ALL),
        # Less damping takes less force to carry the pin round, so inside of the radius (9) it sticks all the same.
        ("half the damping", ALL - {study.STAYS, study.HOLDS}),
    ],
)
def test_a_broken_engine_is_found_out(fault, seen):
    findings = study.measure(broken_engines()[fault], **FEW)
    assert seen <= sentences(findings, Verdict.DIFFERS)


def test_the_theory_holds():
    assert set(verdicts(study.theory()).values()) == {Verdict.AGREES}


@pytest.mark.parametrize("speed", study.SPEEDS)
def test_starts_are_where_the_least_force_holds_the_pin(speed):
    pin = study.pin_at(speed)
    angle = safest_angle(pin)
    around = squared_holding_force(pin, 0.01, angle + np.linspace(-np.pi, np.pi, 101))
    assert np.min(around) == pytest.approx(squared_holding_force(pin, 0.01, angle))


def test_the_vertex_of_an_exact_parabola_is_found():
    s = np.array([0.8, 1.0, 1.3])
    found, error = study.vertex(s, 2.0 + 3.0 * (s - 0.9) ** 2, np.full(3, 1e-6))
    assert found == pytest.approx(np.sqrt(0.9), rel=1e-12)
    assert 0.0 < error < 1e-4


def test_figures_are_drawn_whatever_is_there():
    data = {"reference": findings_of(study, "reference", FEW).data, "theory": study.theory().data}
    assert set(study.draw(data)) == set(study.STUDY.figures)
    for part in ({}, {"theory": data["theory"]}, {"reference": data["reference"]}):
        assert set(study.draw(part)) <= set(study.STUDY.figures)
