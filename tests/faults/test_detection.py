"""Quality of the claims: they catch every fault twice and never fail for a sound engine."""

from dataclasses import replace

import pytest

from compare.engines import EVERY_KIND, Engine
from faults import FAULTS, SOUND
from faults.measuring import caught_at_last
from reference_model.trajectory import SimulationError


@pytest.mark.parametrize("fault", FAULTS, ids=lambda fault: fault.name)
def test_two_kinds_of_claims_catch_every_fault(fault):
    assert caught_at_last(fault.engine).twice


@pytest.mark.parametrize("engine", SOUND, ids=lambda engine: engine.name)
def test_no_claim_accuses_a_sound_engine(engine):
    """The engine gets a new name, like a fault, so the test above cannot pass because of a name."""
    assert caught_at_last(replace(engine, name="harmless")).sentences == ()


def test_an_engine_that_fails_counts_as_caught_by_all_kinds():
    def failing(*_, **options):
        raise SimulationError("too many steps")

    found = caught_at_last(Engine("failing", failing, EVERY_KIND))
    assert found.twice
    assert found.sentences == ("the engine failed: too many steps",)
