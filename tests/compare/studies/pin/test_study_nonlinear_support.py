"""The study of nonlinear supports: its motions pass the bends."""

from dataclasses import replace

import numpy as np
import pytest
from faults.reference import simulate
from scipy.optimize import brentq

from compare.claims.parameters import CENTRED
from compare.studies.pin.nonlinear_support import theory


def test_the_motions_pass_the_bends_of_the_supports():
    for pin in theory.PINS.values():
        slides = replace(pin, offset=theory.OFFSET)
        states = simulate(slides, theory.SLIDING_START, theory.SLIDING_TIMES).states
        deflection = np.hypot(states[:, 0] - slides.offset, states[:, 1])
        beyond = deflection > theory.STOP.stop_gap
        assert beyond.any()
        assert not beyond.all()


def test_growth_ends_where_a_circle_turns_with_the_disc():
    for pin in theory.PINS.values():

        def excess(radius, pin=pin):
            stop = pin.stop_stiffness * max(0.0, radius - pin.stop_gap)
            pull = pin.stiffness * radius + pin.hardening * radius**3 + stop
            return pull - pin.mass * pin.disc_speed**2 * radius

        assert theory.end_of_growth(pin) == pytest.approx(brentq(excess, 0.1, 10.0, xtol=1e-14), rel=1e-12)


def test_the_linear_circle_grows_with_the_momentum_that_friction_adds():
    (_, first), (time, last) = theory.curves()["linear growth"]
    load = theory.GROWING_LOADS[-1]
    pin = replace(CENTRED, damping=0.0, friction_force=load)
    end = simulate(pin, theory.first_circle(pin), [0.0, time]).at_end
    # The circle at the start has no radial speed yet: 0.5 % of ripple is left.
    assert np.hypot(*end[:2]) == pytest.approx(last, rel=1e-2)
    assert first == theory.GROWING_FROM
