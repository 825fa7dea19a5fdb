from dataclasses import replace

import numpy as np
import pytest
from faults.reference import simulate
from studies_under_test import engine_named

from compare.claims.claim import Verdict
from compare.studies.engines.trajectories.drawn import DRAWN
from compare.studies.engines.trajectories.study import STUDY, moves, pooled
from compare.studies.engines.trajectories.theory import (
    MOTIONS,
    NODES,
    PANEL,
    SPEEDS,
    by_reference,
    gauss,
    samples_in_stick,
    stick_times,
    times_of,
)
from reference_model.systems import DiscOnDisc

PIN, RING = "a pin", "a disc on the continuous ring"


def test_no_two_parameters_are_equal():
    for name in (PIN, RING):
        values = [value for value in vars(MOTIONS[name].system).values() if value]
        assert len(set(values)) == len(values)
        assert 1.0 not in values


def test_exudyns_built_in_contact_agrees_over_its_whole_range():
    found = STUDY.measure(engine_named("exudyn-native"))
    of_rings = 3 * (sum("ring" in name for name in MOTIONS) + 1)
    assert len(found.claims) == 3 * (len(MOTIONS) + len(DRAWN)) - of_rings
    assert {claim.verdict for claim in found.claims} == {Verdict.AGREES}


def test_the_random_motions_cover_all_speeds_senses_and_contact_states():
    for motions in DRAWN.values():
        speeds = [motion.system.disc_speed for motion in motions]
        for sense in (1.0, -1.0):
            for low, high in SPEEDS:
                assert sum(low <= sense * speed <= high for speed in speeds) == 1
    everything = [motion for motions in DRAWN.values() for motion in motions]
    assert {np.sign(motion.system.offset) for motion in everything} == {-1.0, 1.0}
    for motion in DRAWN["pins on stops"]:
        way = by_reference(motion).states[:, :2] - (motion.system.offset, 0.0)
        assert np.min(np.hypot(*way.T)) > motion.system.stop_gap  # on all sides
    centre_is_faster = set()
    for motion in DRAWN["rings"]:
        run = by_reference(motion)
        rim = motion.system.contact_radius * np.abs(motion.system.disc_speed - run.states[:, 5])
        centre_is_faster |= set(run.slip_speed > rim)
    assert centre_is_faster == {True, False}
    for motion in DRAWN["pins that stick"]:
        assert samples_in_stick(by_reference(motion))


def test_a_stick_phase_below_a_microsecond_does_not_count():
    (motion, *_) = DRAWN["pins that stick"]
    run = by_reference(motion)
    stick, slip = run.phases[:2]
    for moment, phases in ((1e-7, 1), (1e-3, 2)):
        again = slip.start + 0.1
        split = (
            stick,
            replace(slip, end=again),
            replace(stick, start=again, end=again + moment),
            replace(slip, start=again + moment),
        )
        assert stick_times(replace(run, phases=split)).shape == (2 * phases,)


def test_pooled_claims_keep_every_number_and_its_error():
    few = list(DRAWN["pins"])[:2]
    single = [moves(engine_named("reference"), (motion,)) for motion in few]
    both = pooled(single)
    assert both.predicted.size == sum(part.predicted.size for part in single)
    first = single[0].predicted.size
    assert np.all(both.error[:first] == single[0].error)
    assert np.all(both.error[first:] == single[1].error)
    assert both.parameters["mass"] == " … ".join(
        f"{mass:.3g}" for mass in sorted(motion.system.mass for motion in few)
    )
    ((*_, last),) = both.axes
    assert last == f"ω = {few[1].system.disc_speed:g} rad/s, t = 3 s, vy in m/s"


@pytest.mark.parametrize("name", MOTIONS)
def test_no_contact_point_rests_while_forces_are_integrated(name):
    motion = MOTIONS[name]
    run = simulate(motion.system, motion.start, np.linspace(0.0, motion.until, 801), tolerance=1e-10)
    assert any(phase.kind != "slip" for phase in run.phases) is motion.sticks
    if isinstance(motion.system, DiscOnDisc):
        rim = motion.system.contact_radius * np.abs(motion.system.disc_speed - run.states[:, 5])
        assert np.min(np.abs(run.slip_speed - rim)) > 0.01  # no point of the ring rests either


@pytest.mark.parametrize("pole", [0.01, 0.1, 1.0])
def test_the_error_of_the_quadrature_is_covered(pole):
    places = times_of(MOTIONS[PIN])[1 : len(NODES) + 1]
    found, error = gauss((1.0 / (pole + places))[np.newaxis, :, np.newaxis])
    missed = abs(found.item() - np.log((pole + PANEL) / pole))
    assert missed <= error.item() + 4.0 * np.finfo(float).eps
