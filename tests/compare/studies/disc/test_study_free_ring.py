from dataclasses import replace

import numpy as np
import pytest
from faults.reference import simulate

from compare.engines import EVERY_KIND, Engine
from compare.studies.disc.free_ring.study import other_ratios, powers
from compare.studies.disc.free_ring.theory import LOPSIDED, OTHERS


@pytest.mark.parametrize(("claim", "throws"), [(other_ratios, OTHERS[::3]), (powers, LOPSIDED[1:3])])
def test_claims_cover_the_error_of_the_engines_time_of_rest(claim, throws):
    def simulated(system, state, times, *, tolerance=1e-9):
        later = replace(system, friction_force=(1.0 - 1e5 * tolerance) * system.friction_force)
        return simulate(later, state, times, tolerance=tolerance)

    measured = claim(Engine("late", simulated, EVERY_KIND), throws)
    off = np.abs(np.subtract(measured.value, measured.predicted))
    assert np.all(off <= np.add(measured.error, measured.model))
