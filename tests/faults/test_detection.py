"""How good the claims are: they catch every fault twice, and accuse no sound engine."""

import os
from dataclasses import replace

from compare.run.workers import Failure
from faults import FAULTS, SOUND
from faults.measuring import caught, caught_by_name, caught_now


def test_two_kinds_of_claims_catch_every_fault_and_none_accuses_a_sound_engine():
    found = caught_by_name(jobs=1 if "PYTEST_XDIST_WORKER" in os.environ else os.cpu_count() or 1)
    assert {fault.name for fault in FAULTS if not found[fault.name].twice} == set()
    assert {engine.name: found[engine.name].sentences for engine in SOUND} == {one.name: () for one in SOUND}


def test_an_engine_that_fails_counts_as_caught_by_all_kinds():
    assert caught(Failure("too many steps")).twice


def test_a_sound_engine_under_the_name_of_a_fault_is_not_caught():
    """So the first test fails for a fault that the claims do not see."""
    assert not caught_now(replace(SOUND[0], name="harmless")).twice
