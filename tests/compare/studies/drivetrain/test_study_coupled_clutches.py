from dataclasses import replace

import numpy as np
import pytest

import compare.studies.drivetrain.coupled_clutches.study as claims
from compare.claims.claim import Verdict
from compare.studies.drivetrain.coupled_clutches.study import STUDY
from compare.studies.drivetrain.coupled_clutches.theory import published


@pytest.mark.parametrize(
    ("change", "function"),
    [
        ({"speeds": np.add(published().speeds, [0.0, 2e-4, 0.0, 0.0])}, "published_speeds"),
        ({"angles": published().angles * 1.0001}, "published_angles"),
        ({"times": published().times + 2e-5}, "published_switches"),
    ],
)
def test_a_wrong_published_record_differs(change, function, monkeypatch):
    monkeypatch.setattr(claims, "published", lambda: replace(published(), **change))
    (claim,) = STUDY.measure_theory({}, (function,)).claims
    assert claim.verdict is Verdict.DIFFERS
