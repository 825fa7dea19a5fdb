"""The study of an isolated drivetrain contains every pair of bodies, which exchange angular momentum."""

from itertools import combinations

import numpy as np
from tested_studies import MOMENTUM

from compare.studies.drivetrain.momentum import DRIVETRAINS, KINDS


def test_every_pair_of_kinds_of_bodies_occurs():
    for first, second in combinations(range(3), 2):
        kinds = {(drivetrain[first], drivetrain[second]) for drivetrain in DRIVETRAINS}
        discs = len(KINDS) - 1  # no rotor
        assert len(kinds) == len(KINDS) * (discs if 1 in (first, second) else len(KINDS))


def test_the_bodies_exchange_angular_momentum():
    change = np.abs(np.diff(MOMENTUM.found("exudyn").data["each"][[0, -1]], axis=0))
    # Friction has a moment of some 0.1 N times 0.1 m, over 5 s.
    assert change[0, 0] > 0.025
    assert change[0, 2] > 0.025
