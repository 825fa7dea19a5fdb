"""The study of an isolated drivetrain agrees, and finds out a moment from outside and a shaft without its arm."""

import functools
from itertools import combinations
from typing import Any

import exudyn.itemInterface
import numpy as np
import pytest
from studies_under_test import findings_of, verdicts

import exudyn_models
from compare.claims.claim import Verdict
from compare.studies.drivetrain.momentum import claims as study

items: Any = exudyn.itemInterface

EXPLICIT, IMPLICIT = (study.SENTENCE.format(name) for name in study.SOLVERS)
FEW = (("planar", "planar", "planar"), study.DRAWN)


@functools.cache
def some():
    return findings_of(study, "exudyn", {"drivetrains": (*FEW, ("rotor", "Tait-Bryan", "planar"))})


def test_every_kind_of_each_body_meets_every_kind_of_the_others():
    for first, second in combinations(range(3), 2):
        kinds = {(drivetrain[first], drivetrain[second]) for drivetrain in study.DRIVETRAINS}
        discs = len(study.KINDS) - 1  # no rotor
        assert len(kinds) == len(study.KINDS) * (discs if 1 in (first, second) else len(study.KINDS))


def test_every_statement_holds():
    assert verdicts(some()) == dict.fromkeys([EXPLICIT, IMPLICIT], Verdict.AGREES)
    assert set(study.draw({"exudyn": some().data})) == set(study.STUDY.figures)
    assert study.draw({}) == {}


def test_the_bodies_do_exchange_angular_momentum():
    change = np.abs(np.diff(some().data["each"][[0, -1]], axis=0))
    # Friction has a moment of some 0.1 N times 0.1 m, over 10 s.
    assert change[0, 0] > 0.05
    assert change[0, 2] > 0.05


@pytest.mark.parametrize(
    ("moment", "expected"),
    [
        (1e-9, {EXPLICIT: Verdict.DIFFERS, IMPLICIT: Verdict.AGREES}),
        (1e-7, {EXPLICIT: Verdict.DIFFERS, IMPLICIT: Verdict.DIFFERS}),
    ],
)
def test_a_moment_from_outside_is_found_out(monkeypatch, moment, expected):
    add = exudyn_models.add_radial_support

    def with_moment(mbs, base, disc, **parameters):
        marker = mbs.AddMarker(items.MarkerNodeCoordinate(nodeNumber=disc, coordinate=2))
        mbs.AddLoad(items.LoadCoordinate(markerNumber=marker, load=moment))
        return add(mbs, base, disc, **parameters)

    monkeypatch.setattr(exudyn_models, "add_radial_support", with_moment)
    assert verdicts(findings_of(study, "exudyn", {"drivetrains": FEW[:1]})) == expected


def test_a_shaft_of_exudyns_own_springs_between_two_bodies_is_found_out(monkeypatch):
    """Its force acts on either body at that body's own centre, and not along the line between them."""

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

    monkeypatch.setattr(exudyn_models, "add_radial_support", springs)
    found = findings_of(study, "exudyn", {"drivetrains": FEW})
    assert verdicts(found) == dict.fromkeys([EXPLICIT, IMPLICIT], Verdict.DIFFERS)
    assert all(np.all(claim.difference > 1e-5) for claim in found.claims)
