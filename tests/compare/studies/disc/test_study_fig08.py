import functools
from dataclasses import replace

import pytest
from studies_under_test import sentences

from compare.claims.claim import Verdict
from compare.studies.disc.fig08 import study
from compare.studies.disc.fig08.study import RING, STUDY
from compare.studies.toolkit.steady_motion import last_load
from reference_model.formulas.disc import positions_by_26


def test_the_printed_equation_26_differs(monkeypatch):
    printed = functools.partial(positions_by_26, as_printed=True)
    monkeypatch.setattr(study, "positions_by_26", lambda disc, as_printed=True: printed(disc))
    findings = STUDY.measure_theory(only=("corrected_26", "printed_26", "end_of_26"))
    assert sentences(findings, Verdict.DIFFERS) == {
        one.sentence for one in STUDY.declared if one.function.__name__ in ("corrected_26", "printed_26")
    }


def test_the_last_load_is_set_by_the_moment_at_small_offsets_and_by_the_springs_at_large_ones():
    moment = 0.003 / 0.12
    small, large = (last_load(replace(RING, offset=offset)) for offset in (1e-6, 10.0))
    assert small == pytest.approx(moment, rel=1e-6)
    assert large == pytest.approx(10.0, rel=1e-4)
