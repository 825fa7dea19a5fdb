from dataclasses import replace

import numpy as np
import pytest
from faults.reference import simulate

from compare.claims.parameters import CENTRED
from compare.studies.pin import nonlinear_support as study


def test_the_motions_pass_the_gap_of_the_stops():
    for pin in study.PINS.values():
        slides = replace(pin, offset=0.1)
        states = simulate(slides, study.SLIDING_START, study.SLIDING_TIMES).states
        deflection = np.hypot(states[:, 0] - slides.offset, states[:, 1])
        beyond = deflection > study.STOP.stop_gap
        assert beyond.any()
        assert not beyond.all()


def test_the_linear_circle_grows_with_the_angular_momentum_from_friction():
    (_, first), (time, last) = study.curves()["linear growth"]
    load = study.GROWING_LOADS[-1]
    pin = replace(CENTRED, damping=0.0, friction_force=load)
    end = simulate(pin, study.first_circle(pin), [0.0, time]).at_end
    # The initial circle lacks a radial velocity, which leaves a ripple of 0.5 %.
    assert np.hypot(*end[:2]) == pytest.approx(last, rel=1e-2)
    assert first == study.GROWING_FROM
