"""Right engines with random parameters: none may fail, and wrong ones do."""

import functools
import itertools

import pytest
from studies_under_test import altered

from compare.claims.claim import Verdict
from compare.engines import engines
from compare.judge.faults import RIGHT
from compare.judge.repetitions import REPETITIONS, SYSTEMS, random_motions
from compare.studies.engines.trajectories.claims import measure


@functools.cache
def motions():
    return random_motions()


def differing(engine):
    """Return what an engine differs in of the first twelve motions."""
    few = dict(itertools.islice(motions().items(), 12))
    return [claim.sentence for claim in measure(engine, few).claims if claim.verdict is Verdict.DIFFERS]


@pytest.mark.parametrize("engine", RIGHT, ids=lambda engine: engine.name)
def test_no_claim_fails_a_right_engine_in_fifty_repetitions(engine):
    assert len(motions()) == REPETITIONS == 50
    found = measure(engine, motions()).claims
    assert len(found) > 2 * REPETITIONS
    assert not [claim.sentence for claim in found if claim.verdict is Verdict.DIFFERS]
    agree = sum(claim.verdict is Verdict.AGREES for claim in found)
    assert agree > 0.8 * len(found)  # where a point comes to rest, integrals of forces say little


def test_the_exudyn_models_do_not_fail_either():
    assert not differing(engines(["exudyn"])[0])


@pytest.mark.parametrize("parameter", ["mass", "offset", "friction_force"])
def test_an_engine_that_is_wrong_by_1e_5_fails_with_every_kind_of_system(parameter):
    wrong = differing(altered(**{parameter: 1.0 + 1e-5}))
    for kind in SYSTEMS:
        assert any(kind in sentence for sentence in wrong)
