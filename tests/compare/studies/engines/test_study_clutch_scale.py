from tested_studies import CLUTCH_SCALE


def test_the_ensemble_has_starts_for_both_ends():
    (shares,) = CLUTCH_SCALE.found("theory").claims
    assert 0.0 < shares.measured[0] < 1.0
