from dataclasses import replace

import numpy as np
import pytest
from broken_engines import broken_engines, broken_on_discs
from studies_under_test import altered, findings_of, for_every_sound_engine, verdicts

from compare.claims.claim import Verdict
from compare.engines import EVERY_KIND, Engine, engines
from compare.judge.faults import FAULTS
from compare.studies.engines.trajectories.claims import (
    KINEMATICS,
    MOMENTUM,
    MOVES,
    STUDY,
    claims_by_kinds,
    forces,
    gauss,
    measure,
    pooled,
)
from compare.studies.engines.trajectories.motions import (
    MOTIONS,
    NODES,
    PANEL,
    SPEEDS,
    by_reference,
    drawn_motions,
    times_of,
)
from compare.studies.engines.trajectories.stick import samples_in_stick, stick_times
from reference_model import simulate
from reference_model.systems import DiscOnDisc

PIN, RING, SIX = "a pin", "a disc on the continuous ring", "a disc on six points"

FEW = {name: MOTIONS[name] for name in (PIN, RING, SIX)}


@for_every_sound_engine
def test_sound_engines_move_as_the_reference_and_their_forces_add_up(engine):
    findings = measure(engine)
    assert len(findings.claims) == 3 * len(MOTIONS)
    assert set(verdicts(findings).values()) == {Verdict.AGREES}


@pytest.mark.parametrize("engine", engines(["reference", "exudyn-native"]), ids=lambda engine: engine.name)
def test_sound_engines_do_so_over_the_whole_range_of_parameters(engine):
    found = claims_by_kinds(engine, drawn_motions())
    kinds = [kind for kind in drawn_motions() if kind != "rings" or "ring" in engine.kinds]
    assert len(found) == 3 * len(kinds)
    assert {claim.verdict for claim in found} == {Verdict.AGREES}, [claim.sentence for claim in found]


def test_the_whole_range_has_slow_and_fast_discs_in_both_senses_and_all_that_a_mistake_may_be_confined_to():
    drawn = drawn_motions()
    for motions in drawn.values():
        speeds = [motion.system.disc_speed for motion in motions]
        for sense in (1.0, -1.0):
            for low, high in SPEEDS:
                assert sum(low <= sense * speed <= high for speed in speeds) == 1
    everything = [motion for motions in drawn.values() for motion in motions]
    assert {np.sign(motion.system.offset) for motion in everything} == {-1.0, 1.0}
    for motion in drawn["pins on stops"]:
        way = by_reference(motion).states[:, :2] - (motion.system.offset, 0.0)
        assert np.min(np.hypot(*way.T)) > motion.system.stop_gap  # on all sides
    centre_is_faster = set()
    for motion in drawn["rings"]:
        run = by_reference(motion)
        rim = motion.system.contact_radius * np.abs(motion.system.disc_speed - run.states[:, 5])
        centre_is_faster |= set(run.slip_speed > rim)
    assert centre_is_faster == {True, False}
    for motion in drawn["pins that stick"]:
        assert samples_in_stick(by_reference(motion))


def test_a_moment_of_stick_is_no_phase_but_one_of_a_millisecond_is():
    (motion, *_) = drawn_motions()["pins that stick"]
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


CONFINED = {
    "friction-stronger-at-extremes": "pins",
    "friction-weaker-backwards": "pins",
    "friction-stronger-beside": "pins",
    "stiffer-in-y": "pins",
    "damping-on-slip": "pins",
    "output-late": "pins",
    "stop-on-one-side": "pins on stops",
    "moment-larger-in-slip": "rings",
    "points-lag": "points",
    "no-centripetal-term-in-stick": "pins that stick",
    "release-late-by-1e-3": "pins that stick",
    "phases-late": "pins that stick",
}


@pytest.mark.parametrize("name", CONFINED)
def test_a_mistake_that_is_small_or_confined_is_seen_by_two_kinds_of_claims(name):
    engine = next(fault.engine for fault in FAULTS if fault.name == name)
    found = claims_by_kinds(engine, {CONFINED[name]: drawn_motions()[CONFINED[name]]})
    kinds = {claim.kind for claim in found if claim.verdict is Verdict.DIFFERS}
    assert "trajectory" in kinds
    assert len(kinds) >= 2


def test_a_mistake_at_extreme_speeds_passes_all_motions_at_usual_ones():
    """Why the range has to be whole."""
    engine = next(fault.engine for fault in FAULTS if fault.name == "friction-stronger-at-extremes")
    assert {claim.verdict for claim in measure(engine, FEW).claims} == {Verdict.AGREES}


def test_pooled_claims_keep_every_number_and_its_own_error_bar():
    few = drawn_motions()["pins"][:2]
    single = [claims_by_kinds(engines(["reference"])[0], {"pins": (motion,)})[0] for motion in few]
    both = pooled(single)
    assert both.predicted.size == sum(claim.predicted.size for claim in single)
    first = single[0].predicted.size
    assert np.all(both.budget.total[:first] == single[0].budget.total)
    assert np.all(both.budget.total[first:] == single[1].budget.total)
    assert both.parameters["mass"] == " … ".join(
        f"{mass:.3g}" for mass in sorted(motion.system.mass for motion in few)
    )


@pytest.mark.parametrize("name", MOTIONS)
def test_nothing_comes_to_rest_where_forces_are_integrated(name):
    motion = MOTIONS[name]
    run = simulate(motion.system, motion.start, np.linspace(0.0, motion.until, 801), tolerance=1e-10)
    assert any(phase.kind != "slip" for phase in run.phases) is motion.sticks
    if isinstance(motion.system, DiscOnDisc):
        rim = motion.system.contact_radius * np.abs(motion.system.disc_speed - run.states[:, 5])
        assert np.min(np.abs(run.slip_speed - rim)) > 0.01  # no point of the ring rests either


def test_no_two_parameters_are_equal():
    for name in (PIN, RING):
        values = [value for value in vars(MOTIONS[name].system).values() if value]
        assert len(set(values)) == len(values)
        assert 1.0 not in values


@pytest.mark.parametrize("pole", [0.01, 0.1, 1.0])
def test_gauss_integrates_to_the_error_that_it_tells(pole):
    places = times_of(MOTIONS[PIN])[1 : len(NODES) + 1]
    found, error = gauss((1.0 / (pole + places))[np.newaxis, :, np.newaxis])
    missed = abs(found.item() - np.log((pole + PANEL) / pole))
    assert missed <= error.item() + 4.0 * np.finfo(float).eps


@pytest.mark.parametrize("name", [PIN, "a pin on a support that hardens, beyond its stop", RING, SIX])
def test_forces_are_those_that_the_reference_moves_by(name):
    """The change of velocity over a short time, by a simulation."""
    motion = MOTIONS[name]
    half, h = motion.system.state_size // 2, 1e-4
    states = simulate(motion.system, motion.start, [0.0, h, 2.0 * h], tolerance=1e-13).states
    inertia = [motion.system.mass] * 2 + ([motion.system.polar_inertia] if half == 3 else [])
    change = np.array(inertia) * (states[2] - states[0])[half:] / (2.0 * h)
    assert forces(motion.system, states[1]) == pytest.approx(change, abs=1e-6)


@pytest.mark.parametrize(
    "parameter",
    [name for name, value in vars(MOTIONS[RING].system).items() if value],
)
def test_an_error_of_a_millionth_in_any_parameter_is_found_by_trajectory_and_by_momentum(parameter):
    pin_too = hasattr(MOTIONS[PIN].system, parameter)
    motions = FEW if pin_too else {name: motion for name, motion in FEW.items() if name != PIN}
    found = verdicts(measure(altered(**{parameter: 1.0 + 1e-6}), motions))
    for name in motions:
        assert found[MOVES.format(name)] is Verdict.DIFFERS
        assert found[MOMENTUM.format(name)] is Verdict.DIFFERS


@pytest.mark.parametrize("name", ["wrong sign", "half the damping"])
def test_a_wrong_force_is_found(name):
    found = verdicts(measure(broken_engines()[name], {PIN: MOTIONS[PIN]}))
    assert found[MOVES.format(PIN)] is found[MOMENTUM.format(PIN)] is Verdict.DIFFERS


@pytest.mark.parametrize("name", ["moment 1 % off", "five points"])
def test_a_wrong_moment_is_found(name):
    found = verdicts(measure(broken_on_discs()[name], {SIX: MOTIONS[SIX]}))
    assert found[MOVES.format(SIX)] is found[MOMENTUM.format(SIX)] is Verdict.DIFFERS


def test_an_angle_that_is_not_the_integral_of_spin_is_found():
    def wrapped(system, initial_state, times, *, tolerance=1e-9):
        run = simulate(system, initial_state, times, tolerance=tolerance)
        states = run.states.copy()
        states[:, 2] = (states[:, 2] + np.pi) % (2.0 * np.pi) - np.pi
        return replace(run, states=states)

    found = verdicts(measure(Engine("wrapped", wrapped, EVERY_KIND), {RING: MOTIONS[RING]}))
    assert found[KINEMATICS.format(RING)] is found[MOVES.format(RING)] is Verdict.DIFFERS
    assert found[MOMENTUM.format(RING)] is Verdict.AGREES


def test_an_engine_is_measured_on_what_it_promises():
    findings = measure(Engine("pins that slip", simulate, ("pin",), sticks=False))
    assert len(findings.claims) == 9
    assert "disc" in findings.not_simulated


def test_the_figure_copes_with_what_is_missing():
    findings = findings_of(STUDY, "reference", {})
    assert list(STUDY.draw({"reference": findings.data})) == ["trajectories"]
    STUDY.draw({})
