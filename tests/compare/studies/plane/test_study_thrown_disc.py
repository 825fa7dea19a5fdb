from tested_studies import THROWN_DISC


def test_an_engine_without_a_full_disc_is_reported():
    assert THROWN_DISC.found("exudyn-native").not_simulated == (
        "exudyn-native does not simulate a disc on a continuous ring; "
        "exudyn-native has no model of a full disc"
    )
