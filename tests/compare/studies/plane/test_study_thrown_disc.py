import pytest
from tested_studies import THROWN_DISC

from compare.studies.plane import thrown_disc as study


def test_an_engine_without_a_full_disc_is_reported():
    assert THROWN_DISC.found("exudyn-native").not_simulated == (
        "exudyn-native does not simulate a disc on a continuous ring; "
        "exudyn-native has no model of a full disc"
    )


@pytest.mark.parametrize("throw", [study.RING[-1], study.FULL[-1]], ids=["ring", "full disc"])
def test_force_and_moment_end_sliding_and_spinning_at_the_same_time(throw):
    spinning = throw.inertia * throw.rim / (study.DECELERATION * throw.moment)
    assert spinning == pytest.approx(throw.time)
