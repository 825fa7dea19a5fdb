"""The study of Fig. 6: what its claims see, and that its curves are those of the branch."""

from dataclasses import replace

import numpy as np
import pytest
from studies_under_test import GROSS, altered
from study_harness import BLIND, LEFT_OUT, OPEN, SEES, StudyTests, engine_named

from compare.claims.claim import Verdict
from compare.studies.pin import fig06 as study
from compare.studies.pin.fig06 import STUDY
from compare.studies.toolkit.pins import extent
from reference_model import whirl_orbit
from reference_model.formulas.pin import equilibrium_radius, sticking_radius

NO_ORBIT = "no whirl near the guess"
"""What the search says that finds none; the runner shows the engine as one that failed, with this sentence."""

NO_WHIRL = (SEES, NO_ORBIT)
"""By how rounding leads the search where there is none."""


class TestFig06(StudyTests):
    study = STUDY
    few_of_faults = {"rests": {"loads": (0.04, 0.095)}, "whirls": {"loads": (0.12,)}}
    few = few_of_faults | {"curves": {"innermost": 0.3, "step": 0.25}}
    faults = GROSS | {
        "friction 1 % off": altered(friction_force=0.99),
        "damping 70 % too strong": altered(damping=1.7),
    }
    columns = ("rests", "whirls", "whirl_ends", "coexist", "cycle_exists", "cycle_attracts")
    table = {
        "wrong sign": (SEES, SEES, LEFT_OUT, SEES, SEES, SEES),
        "square": (SEES, SEES, NO_WHIRL, SEES, SEES, SEES),
        # Its cycle is unstable, so that errors grow with what is measured.
        "half the damping": (SEES, SEES, SEES, BLIND, SEES, (SEES, OPEN)),
        "friction 1 % off": (SEES, SEES, LEFT_OUT, BLIND, SEES, SEES),
        # The whirl ends at 1.7 times the load then, 0.13 N. The pin still sticks, and rests in the same place.
        "damping 70 % too strong": (BLIND, NO_WHIRL, NO_ORBIT, SEES, SEES, SEES),
    }

    @pytest.mark.parametrize("claim", ["rests", "whirls", "coexist", "cycle_exists"])
    def test_the_quick_claims_hold_in_exudyn(self, claim):
        (found,) = STUDY.measure(engine_named("exudyn"), self.few_of_faults, only=(claim,)).claims
        assert found.verdict is Verdict.AGREES

    def test_half_the_damping_makes_the_stick_slip_cycle_unstable(self):
        (claim,) = self.claims_of_fault("half the damping", "cycle_attracts")
        assert claim.predicted < 1.0 < claim.measured

    def test_theory_follows_the_branch_through_the_fold_to_orbits_that_stick(self):
        found = self.found("theory").data
        loads = found["branch load"]
        fold = int(np.argmin(loads))
        assert 0 < fold < len(loads) - 1
        assert found["branch sticks"][0] == 0.0
        assert found["branch sticks"][-1] == 1.0
        assert np.all(found["branch extent"][:, 0] < found["branch extent"][:, 1])
        outermost = whirl_orbit(study.with_load(study.WHIRL_LOADS[-1]))
        assert found["branch extent"][0] == pytest.approx(extent(outermost), abs=1e-4)

    def test_the_equilibrium_ends_where_sticking_begins(self):
        """(5): at μN = C·X0 the radius (3) is zero, and (9) starts from zero."""
        found = self.found("theory").data
        fig6, limit = study.FIG6, study.LIMIT
        assert np.all(found["equilibrium load"] < limit)
        assert np.all(found["sticking load"] > limit)
        below, above = (replace(fig6, friction_force=factor * limit) for factor in (1.0 - 1e-6, 1.0 + 1e-6))
        assert equilibrium_radius(below) < 2e-3 * fig6.offset
        assert sticking_radius(above) < 1e-5 * fig6.offset
