from dataclasses import replace

import numpy as np
import pytest
from tested_studies import FIG06

from compare.studies.pin import fig06 as study
from compare.studies.toolkit.pins import extent
from reference_model import whirl_orbit
from reference_model.formulas.pin import equilibrium_radius, sticking_radius


def test_theory_follows_the_branch_through_the_fold_to_orbits_that_stick():
    found = FIG06.found("theory").data
    loads = found["branch load"]
    fold = int(np.argmin(loads))
    assert 0 < fold < len(loads) - 1
    assert found["branch sticks"][0] == 0.0
    assert found["branch sticks"][-1] == 1.0
    assert np.all(found["branch extent"][:, 0] < found["branch extent"][:, 1])
    outermost = whirl_orbit(study.with_load(study.WHIRL_LOADS[-1]))
    assert found["branch extent"][0] == pytest.approx(extent(outermost), abs=1e-4)


def test_the_equilibrium_ends_where_sticking_begins():
    """(5): at μN = C·X0 the radius (3) is zero, and (9) starts from zero."""
    found = FIG06.found("theory").data
    fig6, limit = study.FIG6, study.LIMIT
    assert np.all(found["equilibrium load"] < limit)
    assert np.all(found["sticking load"] > limit)
    below, above = (replace(fig6, friction_force=factor * limit) for factor in (1.0 - 1e-6, 1.0 + 1e-6))
    assert equilibrium_radius(below) < 2e-3 * fig6.offset
    assert sticking_radius(above) < 1e-5 * fig6.offset
