import numpy as np
import pytest

from compare.claims.claim import Verdict
from compare.studies.disc.simulated_map import DAMPING, SHAFT_DAMPING, STUDY, simulated
from reference_model.ensemble import EndState

CLAIMS = ("leaves_axis", "no_unstable_whirl")


def test_the_disc_of_fig_11_is_modulated():
    column = np.argmin(np.abs(DAMPING - 0.5))
    row = np.argmin(np.abs(SHAFT_DAMPING - 0.015))
    assert simulated()[row, column] == EndState.MODULATED


@pytest.mark.parametrize(
    ("where", "instead", "seen_by"),
    [
        (EndState.SELF_CENTRED, EndState.WHIRL, "leaves_axis"),
        (EndState.MODULATED, EndState.SELF_CENTRED, "leaves_axis"),
        (EndState.MODULATED, EndState.WHIRL, "no_unstable_whirl"),
    ],
)
def test_impossible_ends_differ(where, instead, seen_by):
    ends = simulated()
    wrong = np.where(ends == where, instead, ends).astype(np.uint8)
    findings = STUDY.measure_theory({name: {"ends": wrong} for name in CLAIMS}, only=CLAIMS)
    differing = [claim.verdict is Verdict.DIFFERS for claim in findings.claims]
    assert differing == [name == seen_by for name in CLAIMS]
