from dataclasses import replace
from functools import partial

import numpy as np
import pytest
from studies_under_test import DIFFERS, theory_of
from tested_studies import BASINS

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


def test_a_wrong_share_of_the_basin_differs(monkeypatch):
    """Let the middle quarter of the rectangle be the basin of the equilibrium."""
    x, vx = np.meshgrid(np.linspace(-1.0, 1.0, 401), np.linspace(-1.0, 1.0, 401))
    middle = (abs(x) <= 0.5) & (abs(vx) <= 0.5)
    ends = np.where(middle, EndState.SELF_CENTRED, EndState.WHIRL).astype(np.uint8)
    monkeypatch.setattr(study, "ends_on_finer_grid", lambda pin, side: ends)
    (claim,) = STUDY.measure_theory(BASINS.few, only=("area",)).claims
    assert claim.verdict is DIFFERS
    assert claim.measured[claim.named["share at 1.5 rad/s"]] == pytest.approx(0.25, abs=4e-3)


def shifted(right, starts, *pin, **parameters):
    """Shift x0 by 4 mm, the spacing of the grid."""
    return right(np.add(starts, (0.004, 0.0, 0.0, 0.0)), *pin, **parameters)


def slower(right, starts, *pin, **parameters):
    """Let the basin grow with the speed."""
    return right(starts, *pin, **{name: 4.1 - values for name, values in parameters.items()})


def swapped(right, starts, *pin, **parameters):
    found = right(starts, *pin, **parameters)
    return replace(found, end=np.where(found.end == 1, 2, 1).astype(np.uint8))


@pytest.mark.parametrize(
    ("wrong", "functions"),
    [(shifted, ("divides",)), (slower, ("shrinks",)), (swapped, ("divides", "recomputes"))],
)
def test_a_wrong_ensemble_differs(wrong, functions, fresh):
    fresh.setattr(study, "ensemble_of", partial(wrong, study.ensemble_of))
    few = BASINS.few | ({"divides": {"side": 200, "cells": 6}} if wrong is shifted else {})
    assert set(theory_of(STUDY, *functions, few=few).values()) == {DIFFERS}


def test_the_spline_through_a_circle_has_order_four():
    """The spline through n points misses the area of the circle by ~ n⁻⁴."""
    missed = []
    for n in (12, 24):
        turn = np.linspace(0.0, 2.0 * np.pi, n + 1)
        points = np.column_stack((np.cos(turn), np.sin(turn)))
        points[-1] = points[0]
        missed.append(abs(enclosed(smooth(points, 100_000)) - np.pi))
    assert missed[1] < missed[0] / 12.0
