"""Branches of motions along one parameter."""

from dataclasses import replace

import numpy as np
import pytest
from long_sweeps import silent

from compare.claims.parameters import FIG5
from compare.claims.shares import of_counts
from compare.sweep.compute.executors import InProcess
from compare.sweep.compute.motions import Motion, matched, motions_of
from compare.sweep.compute.run import run
from compare.sweep.compute.theory import theory_branches
from compare.sweep.distributions import Uncertain
from compare.sweep.plan import Continuation
from compare.sweep.quantities import Axis
from compare.sweep.store import SweepStore
from compare.sweep.summary import summary
from reference_model import whirls
from reference_model.ensemble import EndState

STARTS = (Uncertain("x", "uniform", (-0.3, 0.5)), Uncertain("vx", "uniform", (-0.4, 0.4)))
PLAN = Continuation(
    system=FIG5,
    duration=12000.0,
    tolerance=1e-6,
    seed=1,
    start=(0.0,) * 4,
    x=Axis("disc_speed", 1.05, 3.0, 4),
    varied=STARTS,
    samples=50,
)


def test_motions_with_equal_ends_are_separated_by_their_radii():
    ends = np.array([EndState.WHIRL] * 4 + [EndState.UNDECIDED, EndState.STUCK, EndState.STUCK], dtype="u1")
    largest = np.array([0.5, 1.0, 0.501, 0.502, np.nan, 0.1, 0.4])
    found = motions_of(ends, 0.5 * largest, largest)
    assert found == [
        Motion(EndState.WHIRL, 3, 0.2505, 0.501),
        Motion(EndState.WHIRL, 1, 0.5, 1.0),
        Motion(EndState.STUCK, 2, 0.125, 0.25),
    ]


def test_motions_are_matched_by_extrapolation():
    # two crossing lines, and a motion of another kind at two values
    up, down = (lambda i: Motion(2, 1, 0.0, 1.0 + 0.1 * i)), (lambda i: Motion(2, 1, 0.0, 1.5 - 0.1 * i))
    found = [[up(i), down(i)] if i % 2 else [down(i), up(i)] for i in range(6)]
    found[3].append(Motion(1, 1, 0.0, 1.3))
    found[4].append(Motion(1, 1, 0.0, 1.3))
    branches = matched(found, lambda motion: motion.end)
    assert sorted(sorted(branch) for branch in branches) == [[0, 1, 2, 3, 4, 5], [0, 1, 2, 3, 4, 5], [3, 4]]
    assert branches[0] == {i: down(i) for i in range(6)}
    assert branches[1] == {i: up(i) for i in range(6)}


@pytest.mark.parametrize("radius", ["least", "largest"])
def test_motions_that_differ_in_one_radius_only_are_matched_by_that(radius):
    one, other = (Motion(2, 1, 0.4, 1.0)._replace(**{radius: size}) for size in (0.5, 0.9))
    found = [[one, other], [other, one], [one, other], [other, one]]
    first, second = matched(found, lambda motion: motion.end)
    assert (first, second) == (dict.fromkeys(range(4), one), dict.fromkeys(range(4), other))


def test_a_jump_begins_a_new_branch():
    found = [[Motion(2, 1, 0.0, radius)] for radius in (1.0, 1.0, 0.5, 0.5)]
    assert [sorted(branch) for branch in matched(found, lambda motion: motion.end)] == [[0, 1], [2, 3]]


@pytest.fixture(scope="module")
def store(tmp_path_factory):
    store = SweepStore.create(tmp_path_factory.mktemp("continuation") / "s", PLAN, 70)
    run(store, InProcess(), silent)
    return store


def test_shares_and_radii_along_the_speed(store):
    result = store.get("result")
    ends = result["end"].values
    for i in range(PLAN.x.points):
        expected = of_counts(np.bincount(ends[i], minlength=len(EndState)))
        for end in EndState:
            found = [float(result[name][i, end]) for name in ("share", "share_low", "share_high")]
            assert found == list(expected[end])
    assert result["motion_end"].values.tolist() == [EndState.SELF_CENTRED, EndState.WHIRL]
    share = result["motion_share"].values
    assert share[0, 0] == 1.0  # no start whirls at the lowest speed; their number increases
    assert np.isnan(share[1, 0])
    assert np.all(np.diff(share[1, 1:]) >= 0.0)
    assert np.all(result["motion_share_low"].values[1, 1:] < share[1, 1:])


def test_motions_lie_on_the_branches_that_formulas_and_continuation_give(store):
    result, theory = store.get("result"), store.get("branches")
    assert theory["theory"].values.tolist() == ["self-centred", "whirl"]
    for radius in ("least", "largest"):
        found, expected = result[f"motion_{radius}"].values, theory[f"theory_{radius}"].values
        there = np.isfinite(found)
        np.testing.assert_allclose(found[there], expected[there], rtol=2e-3)  # samples of an orbit
    assert np.all(theory["theory_stable"].values[np.isfinite(expected)] == 1.0)


def test_branches_without_offset_are_those_of_the_formulas():
    centred = replace(PLAN, system=replace(FIG5, offset=0.0))
    (branch,) = theory_branches(centred)
    for i, one in branch.items():
        (whirl,) = whirls(replace(centred.system, disc_speed=PLAN.x.values[i]))
        assert (one.meaning, one.largest, one.stable) == ("whirl", whirl.radius, whirl.stable)
    assert sorted(branch) == [0, 1, 2, 3]


def test_each_motion_has_a_line(store):
    lines = [line for line in summary(store) if "disc_speed from" in line]
    assert len(lines) == 2
    # with 50 starts, the last speed at which one comes to rest is the last but one
    assert lines[0] == (
        "  self centred   disc_speed from 1.05 to 2.35 rad/s: largest radius 0.04359 to 0.04359 m, "
        "share 100.00 to 2.00 %"
    )
