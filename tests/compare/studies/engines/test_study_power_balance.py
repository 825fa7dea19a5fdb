"""The study of power agrees for every sound engine, and each of its claims fails for broken ones."""

from dataclasses import replace

import numpy as np
import pytest
from faults.reference import simulate
from studies_under_test import GROSS, altered, fault, made, verdicts, with_changed
from study_harness import BLIND, LEFT_OUT, SEES, StudyTests, engine_named

from compare.claims.claim import Verdict
from compare.engines import EVERY_KIND, Engine
from compare.studies.engines import power_balance as study
from compare.studies.engines.power_balance import (
    all_motions,
    motions_of_the_disc,
    motions_of_the_pin,
)

PINS, DISCS = tuple(motions_of_the_pin()), tuple(motions_of_the_disc())
TO_EQUILIBRIUM, TO_WHIRL, SETTLES, STICKS, RESTING, BACKWARDS = PINS
TO_CYCLE, SIX, WITH_OFFSET, STICKS_TOO, RING_TO_REST, SIX_TO_REST = DISCS


def short_of_pin():
    motions = motions_of_the_pin()
    return {name: replace(motion, until=min(motion.until, 30.0)) for name, motion in motions.items()} | {
        # The quadrature's error at the stick phases must be small beside the energy that is turned over.
        TO_WHIRL: replace(motions[TO_WHIRL], until=200.0),
        # The engines that are broken can't be tighter in stick, and what they have to show is large.
        STICKS: replace(motions[STICKS], until=2.0, tolerance=1e-10),
    }


def short_of_disc():
    return {
        name: replace(motion, until=min(motion.until, 20.0)) for name, motion in motions_of_the_disc().items()
    }


SHORT = {"pin": {"motions": short_of_pin}, "disc": {"motions": short_of_disc}}

# The engines that are broken do not tell when a disc comes to rest, or one of its points.
SLIDING = set(PINS + DISCS) - {STICKS, RING_TO_REST, SIX_TO_REST}


def gaining(system, initial_state, times, *, tolerance=1e-9):
    """Kinetic energy grows by 1e-6 of itself in each second."""
    trajectory = simulate(system, initial_state, times, tolerance=tolerance)
    growth = np.exp(0.5e-6 * (trajectory.times - trajectory.times[0]))[:, np.newaxis]
    places, velocities = np.split(trajectory.states, 2, axis=1)
    return replace(trajectory, states=np.hstack((places, growth * velocities)))


FAULTS = GROSS | {
    "intact": engine_named("intact"),
    "viscous below 1e-3 m/s": made(slip_width=1e-3),
    "friction 1 % off": altered(friction_force=1.01),
    "damping 1 % off": altered(damping=1.01),
    "mass 1 % off": altered(mass=1.01),
    "offset on the wrong side": altered(offset=-1.0),
    "energy grows by 1e-6 in a second": Engine("gaining", gaining, EVERY_KIND),
    "one sample late": fault("one-sample-late"),
}
FAULTS_OF_DISC = {
    "slip and spin uncoupled": fault("uncoupled-slip-and-spin"),
    "moment of the wrong sign": fault("moment-of-wrong-sign"),
    "moment 1 % off": made(moment=1.01),
    "five points": with_changed(lambda system: {"contact_points": 5}),
    "inertia 1 % off": altered(polar_inertia=1.01),
    "shaft's damping 1 % off": altered(shaft_damping=1.01),
    "shaft's speed 1 % off": altered(shaft_speed=1.01),
    "radius 1 % off": altered(contact_radius=1.01),
}

OF_PIN = {
    # On the way to:      equilibrium whirl SETTLES STICKS RESTING BACKWARDS
    "wrong sign": (SEES, SEES, SEES, SEES, SEES, SEES),
    "square": (SEES, SEES, SEES, BLIND, SEES, SEES),
    "viscous below 1e-3 m/s": (LEFT_OUT, LEFT_OUT, LEFT_OUT, SEES, LEFT_OUT, LEFT_OUT),
    # A pin that sticks moves with the disc whatever the parameters are, as long as friction can hold it.
    "half the damping": (SEES, SEES, SEES, BLIND, SEES, SEES),
    "friction 1 % off": (SEES, SEES, SEES, BLIND, SEES, SEES),
    "damping 1 % off": (SEES, SEES, SEES, BLIND, SEES, SEES),
    "mass 1 % off": (SEES, SEES, SEES, BLIND, SEES, SEES),
    "offset on the wrong side": (SEES, SEES, BLIND, BLIND, SEES, SEES),  # SETTLES has none
    "energy grows by 1e-6 in a second": (SEES, SEES, SEES, SEES, SEES, SEES),
    # A motion that never sticks is balanced a sample later too, but for the first one, which is there twice.
    "one sample late": (SEES, SEES, BLIND, SEES, SEES, SEES),
}

OF_DISC = {
    # Motion:                   cycle six offset sticks ring-to-rest six-to-rest
    "wrong sign": (SEES, SEES, SEES, SEES, SEES, SEES),
    "square": (LEFT_OUT, SEES, LEFT_OUT, BLIND, LEFT_OUT, SEES),
    "viscous below 1e-3 m/s": (LEFT_OUT, LEFT_OUT, LEFT_OUT, SEES, LEFT_OUT, LEFT_OUT),
    "slip and spin uncoupled": (SEES, LEFT_OUT, SEES, LEFT_OUT, SEES, LEFT_OUT),
    # Nothing but friction acts on what is thrown on a table.
    "half the damping": (SEES, SEES, SEES, BLIND, LEFT_OUT, LEFT_OUT),  # see SLIDING
    "moment of the wrong sign": (SEES, SEES, SEES, SEES, SEES, SEES),
    "moment 1 % off": (SEES, SEES, SEES, BLIND, SEES, SEES),
    "five points": (SEES, SEES, SEES, BLIND, SEES, SEES),
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


class TestPowerBalance(StudyTests):
    study = study.STUDY
    sound = ("reference",)
    few = SHORT
    faults = FAULTS | FAULTS_OF_DISC
    columns = (*(f"pin/{name}" for name in PINS), *(f"disc/{name}" for name in DISCS))
    table = {
        fault: OF_PIN.get(fault, (LEFT_OUT,) * len(PINS)) + OF_DISC.get(fault, (LEFT_OUT,) * len(DISCS))
        for fault in OF_PIN | OF_DISC
    }

    def test_every_motion_is_balanced_in_exudyn(self):
        found = study.STUDY.measure(engine_named("exudyn"), SHORT)
        assert verdicts(found) == {study.SENTENCE.format(motion): Verdict.AGREES for motion in PINS + DISCS}
        assert set(study.STUDY.draw({"exudyn": found.data})) == set(study.STUDY.figures)

    @pytest.mark.parametrize("motion", sorted(SLIDING))
    def test_every_sliding_motion_is_balanced_in_the_engine_that_faults_are_put_into(self, motion):
        (claim,) = self.claims_of_fault("intact", f"{'pin' if motion in PINS else 'disc'}/{motion}")
        assert claim.verdict is Verdict.AGREES

    @pytest.mark.parametrize(
        ("kinds", "missing", "lacking"),
        [
            (("pin",), set(DISCS), "a disc on a continuous ring or a disc on single points"),
            (("pin", "points"), set(DISCS) - {SIX, SIX_TO_REST}, "a disc on a continuous ring"),
            (("ring", "points"), set(PINS), "a pin or a block on a plane at rest"),
        ],
    )
    def test_an_engine_is_measured_on_the_systems_that_it_promises(self, kinds, missing, lacking):
        def shortest():
            return {name: replace(motion, until=10.0 * motion.step) for name, motion in all_motions().items()}

        few = {"pin": {"motions": shortest}, "disc": {"motions": shortest}}
        findings = study.STUDY.measure(Engine("mine", simulate, kinds), few)
        assert set(verdicts(findings)) == {
            study.SENTENCE.format(name) for name in set(PINS + DISCS) - missing
        }
        assert findings.not_simulated == f"mine does not simulate {lacking}"
        assert bool(findings.data) == ("pin" in kinds)

    def test_an_engine_of_which_only_the_contact_is_its_own_is_measured_where_that_alone_acts(self):
        engine = Engine("mine", simulate, EVERY_KIND, contact_only=True)
        found = study.STUDY.measure(engine, SHORT)
        assert set(verdicts(found)) == {study.SENTENCE.format(SIX_TO_REST)}
        assert not found.not_simulated

    def test_the_budget_takes_every_second_sample_over_the_same_time(self):
        """An odd number of intervals would leave out the last sample, and the error would be of another motion."""
        for until in (2.5, 2.0, 0.04, 0.1):
            motion = replace(motions_of_the_pin()[STICKS], until=until)
            trajectory = study._run(engine_named("reference"), motion, 1e-10)
            assert study._every_second(trajectory).times[-1] == trajectory.times[-1]
