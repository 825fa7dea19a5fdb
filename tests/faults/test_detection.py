"""Quality of the claims: they catch every fault twice. ``test_every_study`` shows that none fails a sound engine."""

import pytest

from compare.claims.claim import Verdict
from compare.engines import EVERY_KIND, BadTrajectoryError, Engine
from compare.studies.engines.trajectories import STUDY
from compare.studies.engines.trajectories.study import NAMES
from compare.studies.engines.trajectories.theory import ONE_OF_EACH_KIND
from faults import FAULTS
from faults.around_reference import in_single_precision
from faults.catalogue import spoilt
from reference_model.trajectory import SimulationError

OF_ENGINES = [one for one in STUDY.declared if one.of_engine]

MOTIONS = sorted(
    {case: None for one in OF_ENGINES for case, _ in one.cases()},
    key=lambda case: (case not in [NAMES[one] for one in ONE_OF_EACH_KIND], case not in NAMES.values()),
)
"""One motion of each kind first, and random ones last, because they take longest."""


def caught(engine):
    """Yield sentences and kinds of the claims that differ, for each kind of motion.

    If the engine fails, no claim can pass, so the kinds are those of all claims.
    """
    for motion in MOTIONS:
        parts = {one.part(case) for one in OF_ENGINES for case, _ in one.cases() if case == motion}
        try:
            claims = STUDY.measure(engine, only=parts).claims
        except (BadTrajectoryError, SimulationError) as error:
            yield {f"the engine failed: {error}"}, {one.kind for one in OF_ENGINES}
            continue
        differ = [claim for claim in claims if claim.verdict is Verdict.DIFFERS]
        yield {claim.sentence for claim in differ}, {claim.kind for claim in differ}


def caught_twice(engine):
    """Return whether a comparison of trajectories and a claim of another kind differ."""
    kinds = set()
    for _, more in caught(engine):
        kinds |= more
        if "trajectory" in kinds and len(kinds) > 1:
            return True
    return False


@pytest.mark.parametrize("fault", FAULTS, ids=lambda fault: fault.name)
def test_two_kinds_of_claims_catch_every_fault(fault):
    assert caught_twice(fault)


def test_single_precision_is_a_limit_and_no_fault():
    for sentences, _ in caught(spoilt("single-precision", in_single_precision)):
        assert not sentences


def test_engine_that_fails_is_caught_by_all_kinds_of_claims():
    def failing(*_, **options):
        raise SimulationError("too many steps")

    engine = Engine("failing", failing, EVERY_KIND)
    assert caught_twice(engine)
    assert next(caught(engine))[0] == {"the engine failed: too many steps"}
