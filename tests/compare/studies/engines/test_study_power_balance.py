"""The study of power agrees for every sound engine, and each of its claims fails for broken ones."""

import functools
from dataclasses import replace

import numpy as np
import pytest
from broken_engines import broken_engines, broken_on_discs
from studies_under_test import altered, verdicts

from compare.claims.claim import Verdict
from compare.engines import EVERY_KIND, Engine, engines
from compare.studies.engines.power_balance import claims as study
from reference_model import simulate

ALL = study.all_motions()
OF_PIN, OF_DISC = study.motions_of_the_pin(), study.motions_of_the_disc()
TO_EQUILIBRIUM, TO_WHIRL, SETTLES, STICKS, RESTING, BACKWARDS = OF_PIN
TO_CYCLE, SIX, WITH_OFFSET, STICKS_TOO, RING_TO_REST, SIX_TO_REST = OF_DISC

MOTIONS = {name: replace(motion, until=min(motion.until, 30.0)) for name, motion in OF_PIN.items()} | {
    # The quadrature's error at the stick phases must be small beside the energy that is turned over.
    TO_WHIRL: replace(ALL[TO_WHIRL], until=200.0),
    # The engines that are broken can't be tighter in stick, and what they have to show is large.
    STICKS: replace(ALL[STICKS], until=2.0, tolerance=1e-10),
}
SHORT_OF_DISC = {name: replace(motion, until=min(motion.until, 20.0)) for name, motion in OF_DISC.items()}
# The engines that are broken do not tell when a disc comes to rest, or one of its points.
SLIDING = {
    name: motion
    for name, motion in (MOTIONS | SHORT_OF_DISC).items()
    if name not in (STICKS, RING_TO_REST, SIX_TO_REST)
}


def gaining(system, initial_state, times, *, tolerance=1e-9):
    """Kinetic energy grows by 1e-6 of itself in each second."""
    trajectory = simulate(system, initial_state, times, tolerance=tolerance)
    growth = np.exp(0.5e-6 * (trajectory.times - trajectory.times[0]))[:, np.newaxis]
    places, velocities = np.split(trajectory.states, 2, axis=1)
    return replace(trajectory, states=np.hstack((places, growth * velocities)))


def late(system, initial_state, times, *, tolerance=1e-9):
    """Every state is that of the sample before."""
    trajectory = simulate(system, initial_state, times, tolerance=tolerance)
    return replace(trajectory, states=np.vstack((trajectory.states[:1], trajectory.states[:-1])))


FAULTS = broken_engines() | {
    "friction 1 % off": altered(friction_force=1.01),
    "damping 1 % off": altered(damping=1.01),
    "mass 1 % off": altered(mass=1.01),
    "offset on the wrong side": altered(offset=-1.0),
    "energy grows by 1e-6 in a second": Engine("gaining", gaining, EVERY_KIND),
    "one sample late": Engine("late", late, EVERY_KIND),
}
FAULTS_OF_DISC = broken_on_discs() | {
    "inertia 1 % off": altered(polar_inertia=1.01),
    "shaft's damping 1 % off": altered(shaft_damping=1.01),
    "shaft's speed 1 % off": altered(shaft_speed=1.01),
    "radius 1 % off": altered(contact_radius=1.01),
}

SEES, BLIND, UNSURE = Verdict.DIFFERS, Verdict.AGREES, Verdict.INCONCLUSIVE

TABLE = {
    # On the way to:      equilibrium whirl SETTLES STICKS RESTING BACKWARDS
    "wrong sign": (SEES, SEES, SEES, SEES, SEES, SEES),
    "square": (SEES, SEES, SEES, SEES, SEES, SEES),
    # A pin that sticks moves with the disc whatever the parameters are, as long as friction can hold it.
    "half the damping": (SEES, SEES, SEES, BLIND, SEES, SEES),
    "friction 1 % off": (SEES, SEES, SEES, BLIND, SEES, SEES),
    "damping 1 % off": (SEES, SEES, SEES, BLIND, SEES, SEES),
    "mass 1 % off": (SEES, SEES, SEES, BLIND, SEES, SEES),
    "offset on the wrong side": (SEES, SEES, BLIND, BLIND, SEES, SEES),  # SETTLES has none
    "energy grows by 1e-6 in a second": (SEES, SEES, SEES, SEES, SEES, SEES),
    # A motion that never sticks is balanced a sample later too, but for the first one, which is there twice.
    "one sample late": (SEES, SEES, UNSURE, SEES, SEES, SEES),
}


TABLE_OF_DISC = {
    # Motion:                   cycle six offset sticks ring-to-rest six-to-rest
    "wrong sign": (SEES, SEES, SEES, SEES, SEES, SEES),
    "square": (SEES, SEES, SEES, SEES, SEES, SEES),
    # Nothing but friction acts on what is thrown on a table.
    "half the damping": (SEES, SEES, SEES, BLIND, None, None),  # None: see SLIDING
    "moment of the wrong sign": (SEES, SEES, SEES, SEES, SEES, SEES),
    "moment 1 % off": (SEES, SEES, SEES, BLIND, SEES, SEES),
    "five points": (SEES, SEES, SEES, BLIND, SEES, SEES),
    # Where the points are does not matter for energy, as long as friction and heat take them at the same place.
    "angle of half the spin": (BLIND, BLIND, BLIND, BLIND, None, None),
    "friction 1 % off": (SEES, SEES, SEES, BLIND, SEES, SEES),
    "damping 1 % off": (SEES, SEES, SEES, BLIND, BLIND, BLIND),
    "mass 1 % off": (SEES, SEES, SEES, BLIND, SEES, SEES),
    "offset on the wrong side": (BLIND, BLIND, SEES, BLIND, BLIND, BLIND),
    "energy grows by 1e-6 in a second": (SEES, SEES, SEES, SEES, SEES, SEES),
    "inertia 1 % off": (SEES, SEES, SEES, BLIND, SEES, SEES),
    "shaft's damping 1 % off": (SEES, SEES, SEES, BLIND, BLIND, BLIND),
    "shaft's speed 1 % off": (SEES, SEES, SEES, BLIND, BLIND, BLIND),
    "radius 1 % off": (SEES, SEES, SEES, BLIND, SEES, SEES),
}


@functools.cache
def claims(fault):
    findings = study.measure(FAULTS[fault], MOTIONS)
    return {claim.sentence: claim for claim in findings.claims}


@functools.cache
def claims_of_disc(fault):
    findings = study.measure((FAULTS | FAULTS_OF_DISC)[fault], SHORT_OF_DISC)
    return {claim.sentence: claim for claim in findings.claims}


@pytest.fixture(scope="module")
def sound():
    lengths = {"reference": ALL, "exudyn": MOTIONS | SHORT_OF_DISC}
    return {name: study.measure(engines([name])[0], motions) for name, motions in lengths.items()}


@pytest.mark.parametrize("name", ["reference", "exudyn"])
def test_every_motion_is_balanced_in_both_engines(sound, name):
    assert verdicts(sound[name]) == {study.SENTENCE.format(motion): Verdict.AGREES for motion in ALL}


def test_every_sliding_motion_is_balanced_in_the_engine_that_faults_are_put_into():
    findings = study.measure(FAULTS["intact"], SLIDING)
    assert verdicts(findings) == {study.SENTENCE.format(motion): Verdict.AGREES for motion in SLIDING}


@pytest.mark.parametrize(
    ("fault", "motion", "expected"),
    [
        (fault, motion, expected)
        for fault, row in TABLE.items()
        for motion, expected in zip(OF_PIN, row, strict=True)
    ],
)
def test_each_motion_sees_the_faults_that_concern_it(fault, motion, expected):
    claim = claims(fault)[study.SENTENCE.format(motion)]
    assert claim.verdict is expected, claim.measured


@pytest.mark.parametrize(
    ("fault", "motion", "expected"),
    [
        (fault, motion, expected)
        for fault, row in TABLE_OF_DISC.items()
        for motion, expected in zip(OF_DISC, row, strict=True)
        if expected is not None
    ],
)
def test_each_motion_of_a_disc_sees_the_faults_that_concern_it(fault, motion, expected):
    claim = claims_of_disc(fault)[study.SENTENCE.format(motion)]
    assert claim.verdict is expected, claim.measured


@pytest.mark.parametrize(
    ("kinds", "missing", "lacking"),
    [
        (("pin",), set(OF_DISC), "a disc on a continuous ring or a disc on single points"),
        (("pin", "points"), set(OF_DISC) - {SIX, SIX_TO_REST}, "a disc on a continuous ring"),
        (("ring", "points"), set(OF_PIN), "a pin"),
    ],
)
def test_an_engine_is_measured_on_the_systems_that_it_promises(kinds, missing, lacking):
    short = {name: replace(motion, until=10.0 * motion.step) for name, motion in ALL.items()}
    findings = study.measure(Engine("mine", simulate, kinds), short)
    assert set(verdicts(findings)) == {study.SENTENCE.format(name) for name in set(ALL) - missing}
    assert findings.not_simulated == f"mine does not simulate {lacking}"
    assert bool(findings.data) == ("pin" in kinds)


def test_the_budget_takes_every_second_sample_over_the_same_time():
    """An odd number of intervals would leave out the last sample, and the error would be that of another motion."""
    for until in (2.5, 2.0, 0.04, 0.1):
        motion = replace(ALL[STICKS], until=until)
        trajectory = study._run(engines(["reference"])[0], motion, 1e-10)
        assert study._every_second(trajectory).times[-1] == trajectory.times[-1]


def test_figures_are_drawn_whatever_is_there(sound):
    data = {name: findings.data for name, findings in sound.items()}
    for names in (("reference", "exudyn"), ("reference",), ("exudyn",)):
        figures = study.draw({name: data[name] for name in names})
        assert set(figures) == set(study.STUDY.figures)
        for figure in figures.values():
            figure.canvas.draw()
