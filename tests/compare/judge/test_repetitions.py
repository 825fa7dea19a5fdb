"""Right engines with random parameters: none may fail, and wrong ones do; the judge itself draws more of them."""

import functools
import itertools

import pytest
from studies_under_test import altered

from compare.claims.claim import Verdict
from compare.engines import engines
from compare.judge import repetitions
from compare.judge.faults import RIGHT
from compare.judge.repetitions import REPETITIONS, SYSTEMS, random_motions
from compare.studies.engines.trajectories.claims import measure

DRAWN = 12
"""Four of each kind of system, of which two come to rest."""


@functools.cache
def motions():
    return random_motions(DRAWN)


def differing(engine, count):
    """Return what an engine differs in of the first ``count`` motions."""
    few = dict(itertools.islice(motions().items(), count))
    return [claim.sentence for claim in measure(engine, few).claims if claim.verdict is Verdict.DIFFERS]


@pytest.mark.parametrize("engine", RIGHT, ids=lambda engine: engine.name)
def test_no_claim_fails_a_right_engine(engine):
    assert sum(motion.sticks for motion in motions().values()) == 2
    found = measure(engine, motions()).claims
    assert len(found) > 2 * DRAWN
    assert not [claim.sentence for claim in found if claim.verdict is Verdict.DIFFERS]
    agree = sum(claim.verdict is Verdict.AGREES for claim in found)
    assert agree > 0.8 * len(found)  # where a point comes to rest, integrals of forces say little


def test_the_judge_draws_fifty(monkeypatch):
    monkeypatch.setattr(repetitions, "simulate", lambda *arguments, **more: trajectory)
    trajectory = RIGHT[0].simulate(*first_motion())
    assert len(random_motions()) == REPETITIONS == 50


def first_motion():
    motion = next(iter(motions().values()))
    return motion.system, motion.start, [0.0, 0.1]


def test_the_exudyn_models_do_not_fail_either():
    assert not differing(engines(["exudyn"])[0], 6)


@pytest.mark.parametrize("parameter", ["mass", "offset", "friction_force"])
def test_an_engine_that_is_wrong_by_1e_5_fails_with_every_kind_of_system(parameter):
    wrong = differing(altered(**{parameter: 1.0 + 1e-5}), 3)
    for kind in SYSTEMS:
        assert any(kind in sentence for sentence in wrong)
