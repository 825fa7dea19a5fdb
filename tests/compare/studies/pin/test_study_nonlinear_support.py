"""The study of nonlinear supports agrees for every sound engine, and each of its claims fails for broken ones."""

import functools
from dataclasses import replace

import numpy as np
import pytest
from broken_engines import broken_engines
from scipy.optimize import brentq
from studies_under_test import altered, verdicts

from compare.claims.claim import Verdict
from compare.claims.paper_parameters import CENTRED
from compare.engines import engines
from compare.studies.pin.nonlinear_support import claims as study
from reference_model import simulate

FEW = (0.08,)

CLAIMS = {
    study.CIRCLE: functools.partial(study.circle_claim, loads=FEW),
    study.ORBIT: study.orbit_claim,
    study.BALANCE: study.balance_claim,
    study.SLIDES: study.sliding_claim,
    study.STICKS: study.sticking_claim,
    study.REST: study.rest_claim,
    study.LIMIT: study.limit_claim,
    study.DISC_WHIRL: study.disc_claim,
}


FAULTS = {
    "a linear support": altered(hardening=0.0, stop_stiffness=0.0),
    "hardening 0.1 % off": altered(hardening=1.001),
    "stop 0.1 % off": altered(stop_stiffness=1.001),
    "gap 0.1 % off": altered(stop_gap=1.001),
    "friction 0.1 % off": altered(friction_force=1.001),
    "damping 0.1 % off": altered(damping=1.001),
}

SEES, BLIND = Verdict.DIFFERS, Verdict.AGREES
NO_ORBIT = "no whirl near the guess"
"""What the search says that finds none; the runner shows the engine as one that failed, with this sentence."""

TABLE = {
    #                       CIRCLE    ORBIT     BALANCE SLIDES STICKS REST  LIMIT  DISC_WHIRL
    "a linear support": (NO_ORBIT, NO_ORBIT, NO_ORBIT, SEES, SEES, SEES, SEES, SEES),
    "hardening 0.1 % off": (SEES, SEES, SEES, SEES, SEES, SEES, SEES, SEES),
    "stop 0.1 % off": (SEES, SEES, BLIND, SEES, SEES, SEES, SEES, BLIND),
    "gap 0.1 % off": (SEES, SEES, BLIND, SEES, SEES, SEES, SEES, BLIND),
    # Where growth ends for small loads does not depend on them, nor on a damping that is not there.
    "friction 0.1 % off": (SEES, SEES, SEES, SEES, SEES, SEES, BLIND, SEES),
    # Nothing moves in an equilibrium.
    "damping 0.1 % off": (SEES, SEES, SEES, SEES, SEES, BLIND, BLIND, SEES),
}


@functools.cache
def measured(name):
    engine = broken_engines()[name] if name == "intact" else engines([name])[0]
    return study.measure(engine, loads=FEW)


@pytest.mark.parametrize("name", ["reference", "exudyn", "exudyn-native", "intact"])
def test_every_statement_holds_in_a_sound_engine(name):
    findings = measured(name)
    without = {study.DISC_WHIRL} if name == "exudyn-native" else set()
    assert verdicts(findings) == dict.fromkeys(set(CLAIMS) - without, Verdict.AGREES)
    assert bool(findings.not_simulated) == bool(without)


@pytest.mark.parametrize(
    ("fault", "sentence", "expected"),
    [
        (fault, sentence, expected)
        for fault, row in TABLE.items()
        for sentence, expected in zip(CLAIMS, row, strict=True)
    ],
)
def test_each_claim_sees_the_faults_that_concern_it(fault, sentence, expected):
    if expected is NO_ORBIT:
        with pytest.raises(RuntimeError, match=NO_ORBIT):
            CLAIMS[sentence](FAULTS[fault])
    else:
        claim = CLAIMS[sentence](FAULTS[fault])
        assert claim.sentence == sentence
        assert claim.verdict is expected


def test_the_motions_pass_the_bends_of_the_supports():
    for pin in study.PINS.values():
        slides = replace(pin, offset=study.OFFSET)
        states = simulate(slides, study.SLIDING_START, study.SLIDING_TIMES).states
        deflection = np.hypot(states[:, 0] - slides.offset, states[:, 1])
        beyond = deflection > study.STOP.stop_gap
        assert beyond.any()
        assert not beyond.all()


def test_growth_ends_where_a_circle_turns_with_the_disc():
    for pin in study.PINS.values():

        def excess(radius, pin=pin):
            stop = pin.stop_stiffness * max(0.0, radius - pin.stop_gap)
            pull = pin.stiffness * radius + pin.hardening * radius**3 + stop
            return pull - pin.mass * pin.disc_speed**2 * radius

        assert study.end_of_growth(pin) == pytest.approx(brentq(excess, 0.1, 10.0, xtol=1e-14), rel=1e-12)


def test_the_linear_circle_grows_with_the_momentum_that_friction_adds():
    (_, first), (time, last) = study.theory().data["linear growth"]
    load = study.GROWING_LOADS[-1]
    pin = replace(CENTRED, damping=0.0, friction_force=load)
    end = simulate(pin, study._first_circle(pin), [0.0, time]).at_end
    # The circle at the start has no radial speed yet: 0.5 % of ripple is left.
    assert np.hypot(*end[:2]) == pytest.approx(last, rel=1e-2)
    assert first == study.GROWING_FROM


def data():
    found = measured("reference").data
    return {"theory": study.theory().data, "reference": found, "exudyn": found}


NAMES = [("theory", "reference", "exudyn"), ("theory", "exudyn"), ("reference", "exudyn"), ("theory",)]


@pytest.mark.parametrize("names", NAMES, ids="+".join)
def test_figures_are_drawn_whatever_is_there(names):
    figures = study.draw({name: data()[name] for name in names})
    assert set(figures) == set(study.STUDY.figures)
    for figure in figures.values():
        figure.canvas.draw()
