"""The study of nonlinear supports: what its claims see, and that its motions pass the bends."""

from dataclasses import replace

import numpy as np
import pytest
from faults.reference import simulate
from scipy.optimize import brentq
from studies_under_test import altered
from study_harness import BLIND, SEES, StudyTests

from compare.claims.parameters import CENTRED
from compare.studies.pin.nonlinear_support import theory
from compare.studies.pin.nonlinear_support.study import STUDY

NO_ORBIT = "no whirl near the guess"
"""What the search says that finds none; the runner shows the engine as one that failed, with this sentence."""


class TestNonlinearSupport(StudyTests):
    study = STUDY
    sound = ("reference", "exudyn", "exudyn-native", "intact")
    not_claimed = {"exudyn-native": ("disc_whirl",)}
    few = {"circle": {"loads": (0.08,)}}
    faults = {
        "a linear support": altered(hardening=0.0, stop_stiffness=0.0),
        "hardening 0.1 % off": altered(hardening=1.001),
        "stop 0.1 % off": altered(stop_stiffness=1.001),
        "gap 0.1 % off": altered(stop_gap=1.001),
        "friction 0.1 % off": altered(friction_force=1.001),
        "damping 0.1 % off": altered(damping=1.001),
    }
    columns = (
        "circle",
        "orbit",
        "harmonic_balance",
        "slides",
        "sticks",
        "rests",
        "growth_ends",
        "disc_whirl",
    )
    table = {
        "a linear support": (NO_ORBIT, NO_ORBIT, NO_ORBIT, SEES, SEES, SEES, SEES, SEES),
        "hardening 0.1 % off": (SEES, SEES, SEES, SEES, SEES, SEES, SEES, SEES),
        "stop 0.1 % off": (SEES, SEES, BLIND, SEES, SEES, SEES, SEES, BLIND),
        "gap 0.1 % off": (SEES, SEES, BLIND, SEES, SEES, SEES, SEES, BLIND),
        # Where growth ends for small loads does not depend on them, nor on a damping that is not there.
        "friction 0.1 % off": (SEES, SEES, SEES, SEES, SEES, SEES, BLIND, SEES),
        # Nothing moves in an equilibrium.
        "damping 0.1 % off": (SEES, SEES, SEES, SEES, SEES, BLIND, BLIND, SEES),
    }

    def test_what_an_engine_does_not_simulate_is_said(self, sound_engine):
        assert bool(self.found(sound_engine).not_simulated) == (sound_engine in self.not_claimed)


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
