from itertools import combinations

from compare.studies.drivetrain.momentum import DRIVETRAINS, KINDS


def test_every_pair_of_kinds_of_bodies_occurs():
    for first, second in combinations(range(3), 2):
        kinds = {(drivetrain[first], drivetrain[second]) for drivetrain in DRIVETRAINS}
        discs = len(KINDS) - 1  # no rotor
        assert len(kinds) == len(KINDS) * (discs if 1 in (first, second) else len(KINDS))
