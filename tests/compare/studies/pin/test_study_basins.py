from dataclasses import replace

import numpy as np
import pytest
from tested_studies import BASINS

from compare.claims.claim import Verdict
from compare.studies.pin.basins import study
from compare.studies.pin.basins.study import STUDY, enclosed, smooth
from reference_model.ensemble import EndState


@pytest.fixture
def fresh(monkeypatch):
    """Clear the caches of the theory before and after the test, and return a ``MonkeyPatch``."""
    cached = (study.ends_on_grid, study.ends_on_finer_grid, study.shares_over_speed)
    for each in cached:
        each.cache_clear()
    yield monkeypatch
    for each in cached:
        each.cache_clear()


def claims_of_theory(*functions, few=BASINS.few):
    return STUDY.measure_theory(few, only=functions).claims


def all_differ(*functions, few=BASINS.few):
    return {claim.verdict for claim in claims_of_theory(*functions, few=few)} == {Verdict.DIFFERS}


def test_a_wrong_share_of_the_basin_differs(monkeypatch):
    """Let the middle quarter of the rectangle be the basin of the equilibrium."""
    x, vx = np.meshgrid(np.linspace(-1.0, 1.0, 401), np.linspace(-1.0, 1.0, 401))
    middle = (abs(x) <= 0.5) & (abs(vx) <= 0.5)
    ends = np.where(middle, EndState.SELF_CENTRED, EndState.WHIRL).astype(np.uint8)
    monkeypatch.setattr(study, "ends_on_finer_grid", lambda pin, side: ends)
    (claim,) = claims_of_theory("area")
    assert claim.verdict is Verdict.DIFFERS
    assert claim.measured[claim.named["share at 1.5 rad/s"]] == pytest.approx(0.25, abs=4e-3)


def test_ends_of_shifted_starts_differ(fresh):
    """Shift x0 by 4 mm, the spacing of the grid."""
    right = study.ensemble_of

    def shifted(starts, *pin, **parameters):
        return right(np.add(starts, (0.004, 0.0, 0.0, 0.0)), *pin, **parameters)

    fresh.setattr(study, "ensemble_of", shifted)
    assert all_differ("divides", few={"divides": {"side": 200, "cells": 6}})


def test_a_basin_that_grows_with_the_speed_differs(fresh):
    right = study.ensemble_of

    def slower(starts, *pin, **parameters):
        return right(starts, *pin, **{name: 4.1 - values for name, values in parameters.items()})

    fresh.setattr(study, "ensemble_of", slower)
    assert all_differ("shrinks")


def test_an_ensemble_with_swapped_ends_differs(fresh):
    right = study.ensemble_of

    def swapped(starts, *pin, **parameters):
        found = right(starts, *pin, **parameters)
        return replace(found, end=np.where(found.end == 1, 2, 1).astype(np.uint8))

    fresh.setattr(study, "ensemble_of", swapped)
    assert all_differ("divides", "recomputes")


def test_the_spline_through_a_circle_has_order_four():
    """The spline through n points misses the area of the circle by ~ n⁻⁴."""
    missed = []
    for n in (12, 24):
        turn = np.linspace(0.0, 2.0 * np.pi, n + 1)
        points = np.column_stack((np.cos(turn), np.sin(turn)))
        points[-1] = points[0]
        missed.append(abs(enclosed(smooth(points, 100_000)) - np.pi))
    assert missed[1] < missed[0] / 12.0
