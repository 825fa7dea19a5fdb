"""The study of thrown discs: its closed forms are those of the contact."""

import math

import numpy as np
import pytest
from tested_studies import THROWN_DISC

from compare.studies.plane import thrown_disc as study


def test_who_has_no_full_disc_is_told_so():
    assert THROWN_DISC.found("exudyn-native").not_simulated == (
        "exudyn-native does not simulate a disc on a continuous ring; "
        "exudyn-native has no model of a full disc"
    )


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
