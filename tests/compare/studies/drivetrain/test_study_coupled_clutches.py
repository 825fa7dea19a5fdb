from dataclasses import replace

import numpy as np
import pytest
from studies_under_test import engine_named
from wrong_parts import coupled_off, first_load_late

import compare.studies.drivetrain.coupled_clutches.study as claims
from compare.claims.claim import Verdict
from compare.studies.drivetrain.coupled_clutches.study import STUDY
from compare.studies.drivetrain.coupled_clutches.theory import published

NATIVE = replace(engine_named("exudyn-native"), contact_only=False)


def of_bristles(name, fault=None):
    """Return the verdict of the claim about speeds of Exudyn's built-in connector, with a fault."""
    with pytest.MonkeyPatch.context() as patch:
        if fault is not None:
            fault(patch)
        (claim,) = STUDY.measure(replace(NATIVE, name=name), {}, ("moves",)).claims
    return claim.verdict


def test_exudyns_built_in_connector_agrees():
    assert of_bristles("bristles") is Verdict.AGREES


@pytest.mark.parametrize(
    "fault",
    [coupled_off(COEFFICIENT=1.005), first_load_late, coupled_off(coarse=False, STATIC_RATIO=1.0 / 1.1)],
)
def test_a_wrong_built_in_connector_differs(fault):
    assert of_bristles(f"wrong bristles {id(fault)}", fault) is Verdict.DIFFERS


@pytest.mark.parametrize(
    ("change", "function"),
    [
        (
            lambda record: replace(record, speeds=np.add(record.speeds, [0.0, 2e-4, 0.0, 0.0])),
            "published_speeds",
        ),
        (lambda record: replace(record, angles=record.angles * 1.0001), "published_angles"),
        (lambda record: replace(record, times=record.times + 2e-5), "published_switches"),
    ],
)
def test_a_wrong_published_record_differs(change, function, monkeypatch):
    record = change(published())
    monkeypatch.setattr(claims, "published", lambda: record)
    (claim,) = STUDY.measure_theory({}, (function,)).claims
    assert claim.verdict is Verdict.DIFFERS
