"""The study of thrown discs: what its claims see, and that its closed forms are those of the contact."""

import math

import numpy as np
import pytest
from studies_under_test import altered, fault
from study_harness import BLIND, LEFT_OUT, SEES, StudyTests, engine_named

import exudyn_models
from compare.engines import Engine
from compare.studies.plane import thrown_disc as study
from compare.studies.plane.thrown_disc import STUDY
from reference_model.contact.annulus import Annulus
from reference_model.contact.contact_law import Ring


def by_ring(patch):
    patch.setattr(study, "Annulus", lambda inner, outer: Ring(outer))


def with_a_small_hole(patch):
    patch.setattr(study, "Annulus", lambda inner, outer: Annulus(0.02 * outer, outer))


def part_with_a_small_hole(patch):
    add = exudyn_models.add_ring_friction
    hole = {"inner_radius": 0.02 * study.RADIUS}
    patch.setattr(exudyn_models, "add_ring_friction", lambda *nodes, **contact: add(*nodes, **contact | hole))


class TestThrownDisc(StudyTests):
    study = STUDY
    sound = ("reference", "intact", "exudyn", "exudyn-native")
    not_claimed = {"intact": ("on_full_disc",), "exudyn-native": ("on_ring", "on_full_disc")}
    faults = {
        name: fault(name)
        for name in (
            "moment-of-wrong-sign",
            "uncoupled-slip-and-spin",
            "expansion-for-ring",
            "one-point-too-few",
        )
    } | {
        "friction 0.01 % off": altered(friction_force=1.0001),
        "inertia 0.01 % off": altered(polar_inertia=1.0001),
        "a ring in place of the full disc": ("reference", by_ring),
        "a small hole": ("reference", with_a_small_hole),
        "a small hole in Exudyn's part": ("exudyn", part_with_a_small_hole),
    }
    columns = ("on_ring", "on_points", "on_full_disc")
    table = {
        "moment-of-wrong-sign": (SEES, SEES, LEFT_OUT),
        "uncoupled-slip-and-spin": (SEES, BLIND, LEFT_OUT),
        "expansion-for-ring": (SEES, BLIND, LEFT_OUT),
        # As long as a disc only slides or only spins, friction does not depend on their number.
        "one-point-too-few": (LEFT_OUT, BLIND, LEFT_OUT),
        "friction 0.01 % off": (SEES, SEES, LEFT_OUT),
        "inertia 0.01 % off": (SEES, SEES, LEFT_OUT),
        "a ring in place of the full disc": (LEFT_OUT, LEFT_OUT, SEES),
        "a small hole": (LEFT_OUT, LEFT_OUT, SEES),
        "a small hole in Exudyn's part": (LEFT_OUT, LEFT_OUT, SEES),
    }

    @classmethod
    def measured_with(cls, fault, few, only):
        if isinstance(cls.faults[fault], Engine):
            return super().measured_with(fault, few, only)
        name, broken = cls.faults[fault]
        with pytest.MonkeyPatch.context() as patch:
            broken(patch)
            return STUDY.measure(engine_named(name), few, only)

    def test_who_has_no_full_disc_is_told_so(self):
        assert self.found("exudyn-native").not_simulated == (
            "exudyn-native does not simulate a disc on a continuous ring; "
            "exudyn-native is not asked for a full disc, which no engine promises"
        )

    def test_nothing_is_drawn_of_nothing(self):
        assert STUDY.draw({}) == {}


def mean_over_ring(ratio, directions=2000):
    """Force over μN and moment over μNR of a ring with U/W = ratio, by the mean over its directions."""
    chi = (np.arange(directions) + 0.5) * 2.0 * math.pi / directions
    along, rim = ratio - np.sin(chi), np.cos(chi)
    speed = np.hypot(along, rim)
    return np.mean(along / speed), np.mean((rim * np.cos(chi) - along * np.sin(chi)) / speed)


@pytest.mark.parametrize("throw", study.RING, ids=lambda throw: throw.name)
def test_what_friction_takes_of_a_throw_on_a_ring_is_the_mean_over_its_directions(throw):
    ratio = throw.sliding / abs(throw.rim) if throw.rim else 1e9
    force, moment = mean_over_ring(ratio)
    assert [force, moment] == pytest.approx([throw.force, throw.moment], abs=1e-5)


@pytest.mark.parametrize("throw", study.FULL, ids=lambda throw: throw.name)
def test_what_friction_takes_of_a_throw_on_a_full_disc_is_the_mean_over_its_rings(throw):
    radii = np.sqrt((np.arange(200) + 0.5) / 200)  # each with as much of the area
    found = []
    for radius in radii:
        force, moment = mean_over_ring(throw.sliding / (radius * abs(throw.rim)) if throw.rim else 1e9)
        found.append((force, radius * moment))
    assert np.mean(found, axis=0) == pytest.approx([throw.force, throw.moment], abs=1e-3)


@pytest.mark.parametrize("throw", [*study.RING, *study.FULL], ids=lambda throw: throw.name)
def test_a_throw_loses_its_momenta_to_force_and_moment_at_once(throw):
    """Linear and angular momentum over force and moment: the same time for both where there are both."""
    times = [
        start * inertia / (study.DECELERATION * taken)
        for start, inertia, taken in (
            (throw.sliding, 1.0, throw.force),
            (abs(throw.rim), throw.inertia, throw.moment),
        )
        if start > 0.0
    ]
    assert times == pytest.approx([throw.time] * len(times))
    assert throw.seen_at(np.array([1.0]))[0, 3:] == pytest.approx(0.0)
