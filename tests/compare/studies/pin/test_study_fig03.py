"""The study of Fig. 3: what its claims see, and how the limit (5) is extrapolated."""

import numpy as np
import pytest
from studies_under_test import GROSS
from study_harness import LEFT_OUT, SEES, StudyTests

from compare.studies.pin import fig03 as study
from compare.studies.pin.fig03 import STUDY

LOADS = {"loads": (0.02, 0.06)}


class TestFig03(StudyTests):
    study = STUDY
    sound = ("reference", "exudyn", "intact")
    few = dict.fromkeys(("rests", "semicircle", "vanishes", "eigenvalues", "stable"), LOADS) | {
        "rest_or_turn": {"shares": (0.98, 1.2)}
    }
    faults = GROSS
    columns = ("rests", "semicircle", "vanishes", "rest_or_turn", "eigenvalues", "stable")
    table = {
        "wrong sign": (SEES, SEES, SEES, SEES, SEES, SEES),
        # Friction that is too strong along the diagonals moves the rest, but still damps.
        "square": (SEES, SEES, SEES, LEFT_OUT, SEES, LEFT_OUT),
        # Damping does not move a position of rest, so (3) to (5) are blind to it: what they see of it is a
        # transient that takes longer than it should. The eigenvalues are not blind.
        "half the damping": (LEFT_OUT, LEFT_OUT, LEFT_OUT, LEFT_OUT, SEES, LEFT_OUT),
    }

    def test_half_the_damping_leaves_the_rest_where_it_was(self):
        (claim,) = self.claims_of_fault("half the damping", "rests")
        assert np.max(claim.difference) < 1e-6 * study.PIN.offset


def test_the_limit_load_is_extrapolated_from_exact_positions():
    loads = (0.05, 0.08)
    positions = study.positions(loads)
    limit, error = study.vanishing_load(loads, positions, np.array([1e-9, 1e-9]))
    assert limit == pytest.approx(0.1, rel=1e-14)
    moved, _ = study.vanishing_load(loads, positions * (1.0 + 1e-9 / 0.06), np.zeros(2))
    assert abs(moved - limit) < error
