import numpy as np
import pytest

from compare.studies.pin import fig03 as study


def test_the_limit_load_is_extrapolated_from_exact_positions():
    loads = (0.05, 0.08)
    positions = study.positions(loads)
    limit, error = study.vanishing_load(loads, positions, np.array([1e-9, 1e-9]))
    assert limit == pytest.approx(0.1, rel=1e-14)
    moved, _ = study.vanishing_load(loads, positions * (1.0 + 1e-9 / 0.06), np.zeros(2))
    assert abs(moved - limit) < error
