"""The study of Fig. 8: its formulas agree with an independent solution."""

import functools
from dataclasses import replace

import numpy as np
import pytest
from studies_under_test import sentences

from compare.claims.claim import Verdict
from compare.studies.disc.fig08 import theory
from compare.studies.disc.fig08.study import STUDY
from compare.studies.disc.fig08.theory import RING
from compare.studies.toolkit.steady_motion import last_load, with_load
from reference_model.formulas.disc import places_by_26


def test_an_uncorrected_26_is_found_out(monkeypatch):
    printed = functools.partial(places_by_26, as_printed=True)
    monkeypatch.setattr(theory, "places_by_26", lambda disc, as_printed=True: printed(disc))
    findings = STUDY.measure_theory(only=("corrected_26", "printed_26", "end_of_26"))
    assert sentences(findings, Verdict.DIFFERS) == {
        one.sentence for one in STUDY.declared if one.function.__name__ in ("corrected_26", "printed_26")
    }


def test_the_spins_of_fig_8_are_those_of_an_independent_solution():
    """Radius and spin from the balances by bisection with quadrature of (20), at four loads."""
    known = {
        0.02: (0.09813, 0.54727, 0.55425),
        0.05: (0.08743, 0.60294, 0.61225),
        0.08: (0.06288, 0.66121, 0.67054),
        0.095: (0.03940, 0.70643, 0.71494),
    }
    for load, (radius, spin, by_26) in known.items():
        disc = with_load(RING, load)
        x, y, found = theory.place_and_spin(disc)
        (place,) = places_by_26(disc)
        assert (np.hypot(x, y), found, place.spin) == pytest.approx((radius, spin, by_26), abs=5.1e-6)


def test_the_end_of_a_tiny_offset_is_that_of_the_moment_and_of_a_large_one_that_of_the_springs():
    moment = 0.003 / 0.12
    small, large = (last_load(replace(RING, offset=offset)) for offset in (1e-6, 10.0))
    assert small == pytest.approx(moment, rel=1e-6)
    assert large == pytest.approx(10.0, rel=1e-4)
