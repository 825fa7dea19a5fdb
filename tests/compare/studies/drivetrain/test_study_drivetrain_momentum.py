"""The study of an isolated drivetrain agrees, and finds out a moment from outside and a shaft without its arm."""

from itertools import combinations
from typing import Any

import exudyn.itemInterface
import numpy as np
from study_harness import BLIND, SEES
from wrong_parts import WrongPartTests

import exudyn_models
from compare.studies.drivetrain.momentum import DRAWN, DRIVETRAINS, KINDS, STUDY

items: Any = exudyn.itemInterface

FEW = (("planar", "planar", "planar"), DRAWN)


def moment_from_outside(moment):
    """Let a moment in N m act on the disc, where it is planar."""

    def put(patch):
        add = exudyn_models.add_radial_support

        def with_moment(mbs, base, disc, **parameters):
            marker = mbs.AddMarker(items.MarkerNodeCoordinate(nodeNumber=disc, coordinate=2))
            mbs.AddLoad(items.LoadCoordinate(markerNumber=marker, load=moment))
            return add(mbs, base, disc, **parameters)

        patch.setattr(exudyn_models, "add_radial_support", with_moment)

    return put


def shaft_of_exudyns_own_springs(patch):
    """Let the shaft's force act on either body at that body's own centre, and not along the line between them."""

    def springs(mbs, base, disc, *, stiffness, damping, offset):
        mbs.AddObject(
            items.CartesianSpringDamper(
                markerNumbers=[
                    mbs.AddMarker(items.MarkerNodePosition(nodeNumber=node)) for node in (base, disc)
                ],
                stiffness=[stiffness] * 3,
                damping=[damping] * 3,
                offset=[*offset, 0.0],
            )
        )

    patch.setattr(exudyn_models, "add_radial_support", springs)


class TestDrivetrainMomentum(WrongPartTests):
    study = STUDY
    few = {"momentum": {"drivetrains": (*FEW, ("rotor", "Tait-Bryan", "planar"))}}
    few_of_faults = {"momentum": {"drivetrains": FEW}}
    faults = {
        "a moment of 1e-9 N m": moment_from_outside(1e-9),
        "a moment of 1e-7 N m": moment_from_outside(1e-7),
        "a shaft of Exudyn's own springs": shaft_of_exudyns_own_springs,
    }
    columns = ("momentum/explicit", "momentum/implicit")
    table = {
        "a moment of 1e-9 N m": (SEES, BLIND),
        "a moment of 1e-7 N m": (SEES, SEES),
        "a shaft of Exudyn's own springs": (SEES, SEES),
    }

    def test_every_drivetrain_finds_out_a_shaft_without_its_arm(self):
        for column in self.columns:
            (claim,) = self.claims_of_fault("a shaft of Exudyn's own springs", column)
            assert np.all(claim.difference > 1e-5)

    def test_every_kind_of_each_body_meets_every_kind_of_the_others(self):
        for first, second in combinations(range(3), 2):
            kinds = {(drivetrain[first], drivetrain[second]) for drivetrain in DRIVETRAINS}
            discs = len(KINDS) - 1  # no rotor
            assert len(kinds) == len(KINDS) * (discs if 1 in (first, second) else len(KINDS))

    def test_the_bodies_do_exchange_angular_momentum(self):
        change = np.abs(np.diff(self.found("exudyn").data["each"][[0, -1]], axis=0))
        # Friction has a moment of some 0.1 N times 0.1 m, over 5 s.
        assert change[0, 0] > 0.025
        assert change[0, 2] > 0.025
