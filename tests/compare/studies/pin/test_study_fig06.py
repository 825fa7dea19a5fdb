import numpy as np
import pytest
from tested_studies import FIG06

from compare.studies.pin import fig06 as study
from compare.studies.toolkit.pins import extent
from reference_model import whirl_orbit


def test_theory_follows_the_branch_through_the_fold_to_orbits_that_stick():
    found = FIG06.found("theory").data
    loads = found["branch load"]
    fold = int(np.argmin(loads))
    assert 0 < fold < len(loads) - 1
    assert found["branch sticks"][0] == 0.0
    assert found["branch sticks"][-1] == 1.0
    assert np.all(found["branch extent"][:, 0] < found["branch extent"][:, 1])
    outermost = whirl_orbit(study.with_load(study.WHIRL_LOADS[-1]))
    assert found["branch extent"][0] == pytest.approx(extent(outermost).value, abs=1e-4)
