import numpy as np
from studies_under_test import engine_named
from tested_studies import FROZEN

from compare.claims.claim import Verdict
from compare.studies.drivetrain.frozen import STUDY
from compare.studies.drivetrain.frozen.theory import (
    whirl_growth,
    whirl_under_surplus,
)
from compare.studies.toolkit.drivetrain_bench import RPM, centred_car

CAR = centred_car()


def test_the_border_is_nan_if_stability_does_not_change():
    few = {"border": {"between": (4300.0, 4500.0)}}
    (claim,) = STUDY.measure(engine_named("exudyn"), few, only=("border",)).claims
    assert np.all(np.isnan(claim.measured))
    assert claim.verdict is Verdict.DIFFERS


def test_whirls_on_the_stop_are_stable_and_fast_whirls_in_the_play_are_not():
    theory = FROZEN.found("theory").data
    growth, radius = np.moveaxis(theory["over speed"], -1, 0)
    there = np.isfinite(growth)
    on_stop = there & (radius > CAR.stop_gap)
    assert np.any(on_stop)
    assert np.all(growth[on_stop] < 0.0)
    in_play = there & (radius < CAR.stop_gap)
    speeds = np.broadcast_to(theory["speeds"], growth.shape)
    assert np.all(growth[in_play & (speeds > 4200.0)] > 0.0)
    assert np.all(growth[in_play & (speeds < 4000.0)] < 0.0)


def test_a_clutch_without_a_whirl_slower_than_the_engine_locks_up():
    assert whirl_under_surplus(CAR, 4500.0 * RPM, 80.0, 0.1) is None
    assert np.all(np.isnan(whirl_growth(CAR, 4500.0, 80.0, 0.1)))
