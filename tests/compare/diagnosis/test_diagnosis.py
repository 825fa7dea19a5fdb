"""The matrix names the friction law of an engine and reports no other deviations."""

import functools
import json
import math
import re
from dataclasses import replace

import numpy as np
import pytest
from faults.catalogue import SOUND, made, mistaken
from scipy.optimize import brentq
from stepping import box, chattering, cone, engine, pyramid, stepped, weaker_along_y

from compare.diagnosis import findings, probes, run
from compare.diagnosis.findings import MOTIONS, PROBES, Motion, motion
from compare.diagnosis.ladder import RUNGS, Ladder, tolerances
from compare.diagnosis.laws import CONE, SMOOTHINGS, Friction, fitted, smoothing_of
from compare.diagnosis.probes import PULLS
from compare.diagnosis.row import RIGHT as RIGHT_VERDICT
from compare.diagnosis.row import UNDECIDED, WRONG, Row, write_pictures, write_rows
from compare.diagnosis.run import recorded_rows
from compare.diagnosis.scaling import Scales, deviation
from compare.engines import COARSENING, USUAL_TOLERANCE, BadTrajectoryError, Engine, exudyn, plain, reference
from compare.run.workers import Failure
from reference_model import Trajectory

RIGHT = engine("right")


def noisy(size):
    """Return the reference with noise that differs from call to call, and that it declares."""
    random = np.random.default_rng(1)

    def simulate(system, start, times, *, tolerance):
        found = reference.function(system, start, times, tolerance=tolerance)
        noise = size * random.uniform(-1.0, 1.0, found.states.shape) * np.max(np.abs(found.states), axis=0)
        return replace(found, states=np.vstack((start, (found.states + noise)[1:])), phases=())

    return Engine("noisy", simulate, reference.kinds, phases=False, precision=size)


def deaf(system, start, times, *, tolerance, step):
    """Simulate with Euler's explicit method."""
    z, v, states = complex(*start[:2]), complex(*start[2:]), [start]
    for interval in np.diff(times).tolist():
        for _ in range(number := math.ceil(interval / step)):
            h, slip = interval / number, v - 1j * system.disc_speed * z
            force = -system.friction_force * slip / abs(slip) if slip else 0.0
            force -= system.stiffness * (z - system.offset) + system.damping * v
            z, v = z + h * v, v + h * force / system.mass
        states.append([z.real, z.imag, v.real, v.imag])
    return Trajectory(system, np.asarray(times, dtype=float), np.array(states, dtype=float))


LAW, MOTION = "Not Coulomb friction: ", "Wrong motion: "
BOX = f"{LAW}friction is a box with a separate limit for each axis"

FORCES = ("law", "scales", "support", "repeat", "nonlinear")

NAMED_BY_FORCES = {
    engine("box", law=box): f"{BOX}.",
    # √2 times as much in the corners of the box
    engine("rough box", law=lambda impulse: box(impulse) * (1.0 + 1.4e-6 * np.sign(impulse.real))): (
        f"{BOX}, with a further difference of 2.0×10⁻⁶ times"
    ),
    engine("box 100 times too large", law=box, limit=lambda *_: 100.0): (
        f"{BOX}, but the coefficient μ is 100 times the right"
    ),
    engine("nearest axis", law=functools.partial(pyramid, sides=4)): (
        f"{LAW}friction is a pyramid with 4 sides that acts along the nearest axis."
    ),
    engine("eight sides", law=functools.partial(pyramid, sides=8, tilt=math.pi / 8)): (
        f"{LAW}friction is a pyramid with 8 sides inside the cone, with a side across the x axis."
    ),
    engine("ellipse", law=weaker_along_y): (
        f"{LAW}friction is an ellipse: the coefficient μ is 1 times its value along 0.0° and 0.98 times across."
    ),
    engine("more", law=functools.partial(cone, factor=1.001)): f"{LAW}the coefficient μ is 0.10 % too large",
    engine(
        "turned", law=functools.partial(cone, turn=math.pi / 180.0)
    ): f"{LAW}the friction force is rotated by 1.0° (±",
    engine("backwards", law=functools.partial(cone, factor=-1.0)): f"{LAW}friction accelerates the slip",
    engine(
        "none", limit=lambda *_: 0.0
    ): f"{LAW}no friction was measured at 1 kg, 0.20 N and 1 m/s, or in 72 other slides.",
    engine("none when fast", limit=lambda system, speed, step: 1.0 if speed < 0.9 else 0.0): (
        f"{LAW}no friction was measured at 1 kg, 0.20 N and 1 m/s, but 1.0 to 1.0 times the limit μN in "
    ),
    engine("impulse without 1/m", limit=lambda system, *_: system.mass): (
        f"{LAW}the friction force over μN is proportional to mass^1.00"
    ),
    engine("rising with speed", limit=lambda system, speed, step: 1.0 + 0.5 * speed): (
        f"{LAW}the coefficient μ depends on the slip speed v, as 1 + 0.5·v/(m/s) times its value."
    ),
    engine("Stribeck", limit=lambda system, speed, step: 1.0 + 0.01 * math.exp(-((speed / 0.05) ** 2))): (
        f"{LAW}the coefficient μ falls with the slip speed (Stribeck), from 1.01 to 1 times its value, "
        "as exp(−(v/V)²) with V = 0.050 m/s."
    ),
    made("absolute velocity", relative=0.0): f"{LAW}friction ignores the rotation of the master disc.",
    made(
        "opposite rotation", relative=-1.0
    ): f"{LAW}friction assumes that the master disc rotates the other way.",
    engine("impulse per step and axis", step=2e-3, law=box, limit=lambda system, speed, step: 1.0 / step): (
        f"{LAW}friction is limited by an impulse per step, 1.0 s times the limit μN at any step. Its shape is a box"
    ),
    engine("blind", blind=True): f"{LAW}friction ignores slip towards and away from the axis.",
    engine(
        "stronger beyond thresholds",
        limit=lambda system, *_: 1.1 if system.mass > 3.0 or abs(system.disc_speed) > 6.0 else 1.0,
    ): f"{LAW}the coefficient μ is 10 % too large for a mass above 2.9 kg or disc speed above 3.2 rad/s.",
    engine("right at 1 kg", limit=lambda system, *_: 1.0 if system.mass == 1.0 else 1.05): (
        f"{LAW}the coefficient μ is 5.0 % too large except for 1 kg, 0.2 N and 1 m/s."
    ),
    engine(
        "clip of the impulse", limit=lambda system, _, step: min(1.0, 0.04 / (system.friction_force * step))
    ): (f"{LAW}the friction force is limited to 10 N."),
    replace(mistaken("no hardening", lambda system: {"hardening": 0.0}), kinds=("pin",)): (
        f"{MOTION}the hardening force is missing; declare nonlinear = False if the engine lacks it."
    ),
    replace(mistaken("no stop", lambda system: {"stop_stiffness": 0.0}), kinds=("pin",)): (
        f"{MOTION}the stop force is missing; declare nonlinear = False if the engine lacks it."
    ),
    engine("clipped", fastest=2.0): (
        f"{MOTION}a body that starts at 90 m/s moves at 2.0 m/s at once: speeds are limited to 2.0 m/s."
    ),
    engine("sleeps", slowest=0.01): f"{MOTION}a body that starts at 0.0081 m/s or less stops at once.",
    engine("spring pushes", spring=-1.0): f"{MOTION}the spring force is -1 times the right one at 1 N.",
    engine("no spring", spring=0.0): f"{MOTION}the spring force is missing.",
    replace(mistaken("mass", lambda system: {"mass": (1.0 + 1e-5) * system.mass}), kinds=("pin",)): (
        "Wrong mass: the mass is 0.0010 % too large, because all forces act alike."
    ),
}

NAMED_BY_MORE = {
    engine("static", static=1.05): f"{LAW}static friction is 5.0 % above sliding friction.",
    engine("stuck", static=1e9): f"{LAW}a block at rest is not released by 32 times the limit μN.",
    engine("late", late=2e-2): f"{LAW}a block is released 20 ms late.",
    engine("fixed", smooth=1e-2): f"{LAW}friction is regularised as min(v/ε, 1) with ε = 0.010 m/s",
    replace(
        made("lever", moment=0.99), kinds=("ring", "points")
    ): "Wrong friction of discs: a disc that slides and spins has 0.99 times the right friction moment; it deviates",
    mistaken("drag", lambda system: {"damping": system.damping + 0.05 * system.mass}): (
        "Hidden damping: every body loses 5.0 % of its speed per second. Examined, "
    ),
}

NAMED = [(*one, FORCES) for one in NAMED_BY_FORCES.items()] + [
    (*one, PROBES) for one in NAMED_BY_MORE.items()
]
"""Engine, beginning of its diagnosis, and the probes: the others only add sentences to a wrong force."""


def sentences(engine, chosen=PROBES):
    parts = {name: part(engine) for name, part in findings.parts_of(engine).items() if name in chosen}
    row = Row(engine.name, step=engine.step or math.nan, **parts)
    return row, " ".join(row.sentences)


@pytest.mark.parametrize(("made", "said", "chosen"), NAMED, ids=[made.name for made, *_ in NAMED])
def test_a_wrong_law_is_named(made, said, chosen):
    row, found = sentences(made, chosen)
    assert found.startswith(said)
    assert row.verdict == WRONG


@pytest.mark.parametrize("turning", [False, True])
def test_no_probe_leaves_a_plate_of_20_m(turning):
    for push in [*probes.draws(turning), *probes.headings()]:
        times = push.times(probes.PANELS)
        assert np.max(np.abs(push.place + push.velocity * times)) <= 1.0001 * probes.REACH
    speeds = [abs(push.velocity - 1j * push.system.disc_speed * push.place) for push in probes.draws(False)]
    assert min(speeds) < 2e-4
    assert max(speeds) > 90.0


RIGHT_ENGINES = (RIGHT, reference, exudyn, *SOUND[1:], noisy(1e-7))


@pytest.mark.parametrize("made", RIGHT_ENGINES, ids=lambda made: made.name)
def test_no_right_engine_is_accused(made):
    row, found = sentences(made)
    assert found.startswith("Coulomb friction, accurate to ")
    assert row.verdict == RIGHT_VERDICT
    assert "mass 0.001 to " in found


@pytest.mark.parametrize("made", [RIGHT, reference], ids=lambda made: made.name)
def test_a_turning_plane_does_not_pass_for_friction_that_removes_the_slip(made):
    pushes = probes.draws(turning=True)
    left = probes.slides(made, pushes, float(tolerances(made)[0]))[:, probes.LEFT]
    assert np.min(left) >= 1.0 - probes.SPENT


def test_a_load_is_not_reduced_if_that_does_not_preserve_the_slip():
    pushes = probes.headings()[:1]
    assert probes.unsaturated(engine("stopping", slowest=9.0), pushes, float(tolerances(RIGHT)[0])) == pushes


@pytest.mark.parametrize("order", [[0, 2, 1, 3], [0, 1, 3, 2]])
def test_a_wrong_order_of_states_is_seen_first(order):
    def simulate(*arguments, **accuracy):
        found = stepped(*arguments, **accuracy)
        return replace(found, states=found.states[:, order])

    with pytest.raises(BadTrajectoryError, match="returned the initial state "):
        probes.first_check(replace(RIGHT, function=simulate))


def test_forces_with_large_errors_do_not_widen_the_examined_ranges():
    conditions = np.array([[1.0, 1.0, 1.0, 0.0, 1.0], [1e3, 1.0, 1.0, 0.0, 1.0]])
    pairs = np.ones((2, 2))
    found = Scales(conditions, pairs, pairs, pairs, pairs, np.array([1e-3, 1.0]), pairs)
    assert found.looked_at.startswith("mass 1 to 1 kg")


def test_answers_that_differ_from_call_to_call_are_noticed():
    row, found = sentences(replace(noisy(1e-7), precision=0.0), ("repeat",))
    assert found.startswith("Undecided: equal calls return states that differ by ")
    assert row.verdict == UNDECIDED


def test_an_engine_that_starts_every_motion_at_zero_is_noticed():
    def simulate(system, start, times, **accuracy):
        found = RIGHT.function(system, start, [0.0, *(time for time in times if time > 0.0)], **accuracy)
        return Trajectory(system, np.asarray(times), found.states[-len(times) :])

    row, found = sentences(replace(RIGHT, function=simulate), ("repeat",))
    assert found.startswith(f"{MOTION}a motion that starts at t = 4 s differs by ")
    assert row.verdict == WRONG


def test_an_unknown_law_is_described_by_its_largest_deviation():
    row, found = sentences(
        engine("odd", limit=lambda system, *_: 1.0 + 0.2 * math.sin(3.0 * math.log(system.mass))),
        ("law", "scales"),
    )
    assert row.verdict == WRONG
    assert " times μN at " in found


@pytest.mark.parametrize(("share", "found"), [(0.0, UNDECIDED), (0.5, WRONG)])
def test_friction_that_changes_far_from_the_axis_is_not_passed(share, found):
    def on_a_plate(system, start, times, *, step):
        inside = abs(complex(*start[:2])) < 50.0
        friction = system.friction_force * (1.0 if inside else share)
        return stepped(replace(system, friction_force=friction), start, times, step=step)

    row, said = sentences(replace(RIGHT, function=on_a_plate), ("law", "far"))
    size = "50 % too small" if share else "missing; refuse motions that leave the plate"
    assert f"riction 100 m from the axis is {size}." in said
    assert row.verdict == found


@pytest.mark.parametrize(("motions", "verdict"), [(1, UNDECIDED), (2, RIGHT_VERDICT)])
def test_less_than_half_of_the_parts_show_nothing(motions, verdict):
    shown = Motion((1e-2, 5e-3, 2e-3, 1e-3), 3e-3, 1.0, 0.025, 0.1)
    row = Row("any", motions=dict(list(dict.fromkeys(MOTIONS, shown).items())[:motions]))
    row = run._with(run._with(row, "law", "no offset"), "lag", Failure("not finished", unfinished=True))
    assert row.verdict == verdict
    assert "Not measured: law: no offset." in row.sentences
    assert ("Undecided: measured 1 of 3 parts (33 %)." in row.sentences) == (verdict == UNDECIDED)


def test_chatter_that_falls_with_the_step_is_named_but_not_wrong():
    row, found = sentences(engine("explicit", law=chattering))
    assert "Friction chatters: a block that should rest swings at " in found
    assert "m/s, decreasing with the step." in found
    assert row.verdict == RIGHT_VERDICT


def test_a_missing_tolerance_is_reported_before_friction_is_blamed():
    made = Engine("deaf", functools.partial(deaf, step=1e-2), nonlinear=False, phases=False)
    assert sentences(made)[1].startswith("Wrong motion: results do not change with the tolerance")


def test_a_small_error_of_friction_may_be_an_error_of_the_mass():
    heavy = engine("heavy", limit=lambda *_: 1.0 - 1e-5, spring=1.0 - 1e-5)
    said = sentences(heavy, ("law", "support"))[1]
    assert said.startswith(f"{LAW}the coefficient μ is 0.0010 % too small (±")
    assert ", or the mass 0.0010 % too large." in said
    assert "mass" not in sentences(engine("smooth", limit=lambda *_: 1.0 - 1e-2), ("law", "support"))[1]


def test_an_initial_impulse_is_not_attributed_to_friction():
    """MuJoCo's ellipse with Runge-Kutta steps has an impulse of 5e-7 m/s per m/s; μ seemed 0.0025 % too large."""

    def simulate(pin, start, times, *, tolerance):
        found = reference.simulate(
            pin, (*start[:2], *np.multiply(start[2:], 1.0 - 5e-7)), times, tolerance=tolerance
        )
        return replace(found, states=np.vstack((start, found.states[1:])))

    _, said = sentences(replace(reference, function=simulate), ("law", "scales"))
    assert said.startswith("Coulomb friction, accurate to ")


@pytest.mark.parametrize(
    ("error", "misfit", "sure"), [(11.0, 0.0, False), (1e-7, 0.5, False), (1e-7, 0.0, True)]
)
def test_forces_are_relative_to_the_limit_of_friction(error, misfit, sure):
    (said,) = Row("any", law=Friction(CONE, 1.0, 0.0, error, misfit, sure)).sentences
    assert " times the limit μN" in said


def test_a_law_is_uncertain_if_another_fits_equally_well():
    """A pyramid with corners on the axes is the cone for slip along the axes."""
    slips = np.array([[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0]])
    assert not fitted(np.hstack((-slips, slips)), 1e-9).sure
    slips = np.vstack((slips, [0.6, 0.8]))
    found = fitted(np.hstack((-slips, slips)), 1e-9)
    assert (found.shape, found.sure) == (CONE, True)


@pytest.mark.parametrize(
    ("name", "law"),
    [
        ("min(v/ε, 1)", lambda slip: min(slip, 1.0)),
        ("tanh(v/ε)", math.tanh),
        ("v/√(v² + ε²)", lambda slip: slip / math.hypot(slip, 1.0)),
        ("2/π·arctan(v/ε)", lambda slip: math.atan(slip) * 2.0 / math.pi),
    ],
)
def test_creep_names_its_regularisation_and_epsilon(name, law):
    epsilon = 3e-4
    creep = np.array([epsilon * brentq(lambda slip, pull=pull: law(slip) - pull, 0.0, 1e3) for pull in PULLS])
    assert smoothing_of(creep) == (name, pytest.approx(epsilon, rel=1e-3))
    (share,) = (one.share for one in SMOOTHINGS if one.name == name)
    assert share(creep / epsilon) == pytest.approx(PULLS, rel=1e-9)


def test_creep_that_does_not_depend_on_the_pull_is_no_known_regularisation():
    assert smoothing_of(np.full(len(PULLS), 1e-3))[0] == ""


def test_a_regularisation_that_falls_with_the_step_is_not_wrong():
    def simulate(system, start, times, *, step):
        return stepped(system, start, times, step=step, smooth=step)

    row, said = sentences(replace(RIGHT, function=simulate))
    # Smoothing acts on the slip before the step, which is larger by the change during the step.
    assert (
        "m/s under half of the limit μN, decreasing with the step: friction is regularised by its step or as"
        in said
    )
    assert row.verdict == RIGHT_VERDICT


@pytest.mark.parametrize(
    ("share", "coarser", "falls"), [(0.9, 0.7, True), (0.9, 0.9, False), (1.1, 0.7, False)]
)
def test_only_friction_that_is_too_small_and_grows_from_step_to_step_is_a_regularisation(
    share, coarser, falls
):
    slips = np.array([[math.cos(angle), math.sin(angle)] for angle in np.linspace(0.1, 3.0, 8)])
    conditions = np.tile([1.0, 1.0, 1.0, 0.0, 1.0], (len(slips), 1))
    conditions[:, 1] = np.linspace(1.0, 2.0, len(slips))  # equal forces would be a limit in N
    scales = Scales(
        conditions,
        -share * slips,
        -coarser * slips,
        slips,
        slips,
        np.full(len(slips), 1e-9),
        np.ones(slips.shape),
    )
    found = deviation(scales, Friction(CONE, 1.0, 0.0, 1e-9, 0.0, True))
    assert found is not None
    assert found.falls == falls


def test_a_lag_of_one_step_is_reported_but_is_not_wrong():
    row, said = sentences(engine("previous", lagging=True))
    assert re.search(r"Friction lags the slip by (1\.0|0\.9\d*) steps\.", said)
    assert not row.wrong


def test_every_engine_runs_at_the_same_number_of_tolerances():
    stepped, adaptive = tolerances(RIGHT), tolerances(reference)
    assert len(stepped) == len(adaptive) == RUNGS
    assert stepped[-1] == adaptive[-1] == USUAL_TOLERANCE
    assert RIGHT.step_at(stepped[0]) / RIGHT.step_at(stepped[-1]) == pytest.approx(2.0 ** (RUNGS - 1))
    assert adaptive[0] / adaptive[1] == pytest.approx(COARSENING)
    fourth = replace(RIGHT, order=4.0)
    assert fourth.step_at(tolerances(fourth)[0]) == pytest.approx(8.0 * fourth.step)


def test_a_converging_motion_has_its_order_and_a_valid_error_estimate():
    found = motion(RIGHT, "release")
    assert found.converges
    assert found.order == pytest.approx(1.0, abs=0.4)
    assert found.error <= found.estimate
    assert not motion(engine("box", law=box), "release").converges


@pytest.mark.parametrize("order", [0.5, 1.0, 2.0])
def test_the_estimate_covers_errors_of_order_one_half_and_higher(order):
    """A smoothed law may converge that slowly without being another law."""
    ladder = Ladder.of(RIGHT, lambda tolerance: 1.0 + RIGHT.step_at(tolerance) ** order)
    off = abs(ladder.finest - 1.0)
    assert off <= ladder.error <= 50.0 * off

    def shifted(system, start, times, *, step):
        run = reference.simulate(system, start, times, tolerance=1e-12)
        return Trajectory(system, run.times, run.states + np.array([[step**order, 0.0, 0.0, 0.0]]))

    found = motion(replace(RIGHT, function=shifted), "slip")
    assert found.order == pytest.approx(order, abs=0.01)
    assert found.converges


@pytest.mark.parametrize(("error", "converges"), [(2e-8, True), (3e-8, False)])
def test_an_error_below_a_millionth_of_the_resolution_is_not_one_of_the_law(error, converges):
    """The changes of an engine with events may be small by luck."""
    assert Motion((error,) * RUNGS, 1e-12, 0.0, 0.025, 0.1).converges == converges


def test_an_engine_that_ignores_the_tolerance_is_reported():
    deaf = Motion((1e-3,) * RUNGS, 1e-12, 0.0, 0.025, 0.1)
    row = Row("deaf", motions={"slip": deaf})
    (told,) = row.sentences
    assert told.startswith("Wrong motion: results do not change with the tolerance, so an error cannot be ")
    assert row.wrong


def test_an_engine_without_stick_is_not_probed_for_creep():
    assert run.measured(plain, "creep") is None


def raises(system, start, times, *, tolerance):
    raise RuntimeError("out of order")


def test_an_error_far_below_another_law_may_be_one_of_precision():
    """As in an engine that keeps its times in single precision."""

    def simulate(pin, start, times, *, tolerance):
        found = reference.simulate(pin, start, np.float32(times), tolerance=1e-3 * tolerance)
        return Trajectory(pin, times, found.states)

    (said,) = Row(
        "single", motions={"release": motion(replace(reference, function=simulate), "release")}
    ).sentences
    assert said.startswith("Undecided: errors remain at any tolerance: pin is released ")
    assert said.endswith(" m; declare the engine's precision.")


def test_an_engine_of_discs_has_a_verdict_about_discs():
    row, said = sentences(replace(reference, kinds=("points",)))
    assert said.startswith("The force and the moment of friction on a disc are right to ")
    assert row.verdict == RIGHT_VERDICT


def test_a_failed_probe_is_named_and_the_others_remain(in_this_process):
    broken = Engine("broken", raises, ("block",))
    (row,) = run.diagnosed((broken,), limit=60.0)
    assert set(row.gaps) == set(PROBES) - {"lag", "moments", "patch", "joint", "hour"}
    assert row.sentences[0].startswith(
        "Engine failed: no result for law, scales, creep, history, support, far, repeat, course, nonlinear, output: "
    )
    assert row.verdict == WRONG
    assert set(run._probed(broken, run.Workers(1)).gaps) == {"law"}


def test_an_engine_with_failed_claims_is_not_praised(in_this_process):
    assert list(run.in_short((RIGHT,))) == ["right: single blocks show no error."]


def test_recorded_engines_have_rows_like_the_others(tmp_path):
    rows = recorded_rows()
    by_name = {row.engine: row for row in rows}
    assert by_name["Bullet, box"].wrong
    assert by_name["Bullet, box"].sentences[0].startswith(f"{LAW}friction is a box with a separate limit")
    nearest = f"{LAW}friction is a pyramid with 4 sides that acts along the nearest axis"
    assert by_name["MuJoCo, pyramidal cone"].sentences[0].startswith(nearest)
    assert by_name["MuJoCo, elliptic cone"].sentences[0].startswith("Coulomb friction, accurate to ")
    assert not by_name["Drake, TAMSI"].wrong
    assert "Errors are of order 0.9 to 1.0 in the step." in by_name["Drake, TAMSI"].sentences
    assert "Errors are of order 0.3 to 0.5 in the tolerance." in by_name["Drake, cenic"].sentences
    assert set(by_name["Drake, TAMSI"].motions) <= set(MOTIONS)
    mine = Row("mine", motions={"slip": Motion((1e-2, 5e-3, 2e-3, 1e-3), 3e-3, 1.0, 0.025, 0.1)})
    write_rows([*rows, mine], tmp_path)
    content = json.loads((tmp_path / "matrix.json").read_text(encoding="utf-8"))
    assert content[-1]["motions"]["slip"]["errors"] == [1e-2, 5e-3, 2e-3, 1e-3]
    assert content[-1]["sentences"] == ["Errors are of order 1.0 in the tolerance."]
    write_pictures([mine], tmp_path)
    assert (tmp_path / "matrix.png").stat().st_size > 10_000
