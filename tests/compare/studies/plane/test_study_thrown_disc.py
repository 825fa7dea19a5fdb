from studies_under_test import engine_named
from tested_studies import THROWN_DISC


def test_an_engine_without_a_full_disc_is_reported():
    found = THROWN_DISC.study.measure(engine_named("exudyn-native"), THROWN_DISC.few, ("on_full_disc",))
    assert found.not_simulated == "exudyn-native has no model of a full disc"
