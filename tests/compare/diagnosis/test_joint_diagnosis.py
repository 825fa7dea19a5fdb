"""The matrix names the mistakes of joints and accuses no right engine."""

import json
import math
from dataclasses import replace

import numpy as np
import pytest
from joint_engines import (
    changed,
    engine,
    euler,
    karnopp,
    kicked,
    smooth,
    stepped,
    three_points,
    without_offset,
)

from compare.diagnosis import joint_probes, row, run
from compare.diagnosis.findings import PROBES, parts_of
from compare.diagnosis.row import RIGHT, UNDECIDED, WRONG
from compare.engines import BadTrajectoryError, Engine, UnsupportedSystemError, reference
from compare.run.workers import Workers
from reference_model import simulate

ROOT = {"shape": lambda slip: slip / np.hypot(slip, 1.0)}

SOUND = {
    "events": Engine("events", simulate, ("joint",), phases=False),
    "time stepping": engine("time stepping"),
    "coarse time stepping": engine("coarse time stepping", step=5e-3),
    "moment read at the start of a step": engine("early moment", moment_at=0.0),
    "implicit Euler": engine("implicit Euler", implicit=True, theta=1.0, moment_at=1.0),
    "θ method": engine("θ", implicit=True),
    "Radau": engine("Radau", smooth, step=None),
    "Radau with another shape": engine("Radau", smooth, step=None, **ROOT),
    "LSODA": engine("LSODA", smooth, step=None, method="LSODA"),
    "single precision": engine("single", changed(lambda states: states.astype(np.float32))),
}


def in_eight_bits(joint, *_):
    """Return the friction/F of an engine that stores the inertia with eight significant bits, as Havok seems to."""
    fraction, _ = math.frexp(joint.inertia)
    return fraction / (round(fraction * 2**8) / 2**8)


WHOLE = "Not Coulomb friction in a joint: friction of a joint that turns is "
LATE = "Not Coulomb friction in a joint: a joint breaks away "

MISTAKEN = {
    "creeps": (
        engine("creeps", smooth, step=None, epsilon=1e-2, method="LSODA"),
        "rad/s under half of the limit F, independent of the tolerance: friction is regularised as tanh(v/ε) with "
        "ε = 0.010 rad/s.",
    ),
    "no static ratio": (engine("static", static=1.0), "the static ratio has no effect: a joint with a static ratio"),
    "static ratio of 2": (engine("static", static=2.0), "a joint at rest breaks away at 2 F, in place of 1 F."),
    "1.4 for 1.5": (
        engine("static", static=lambda joint: 1.0 + 0.8 * (joint.static_ratio - 1.0)),
        "a joint at rest with a static ratio of 1.5 breaks away at 1.4 F, in place of 1.5 F.",
    ),
    "never breaks away": (engine("never", static=1e9), "a joint at rest does not break away under 30 times its"),
    "reverses": (engine("bounces", bounce=0.1), "a joint that should stop turns back at 5.0 % of its initial speed."),
    "late breakaway": (engine("late", late=0.02), f"{LATE}19 ms late."),
    "friction per step": (
        engine("per step", friction=lambda joint, spin, angle, step: 1e-3 / step),
        "friction depends on the step and does not converge: 0.13, 0.25, 0.50, 1.0 times F, the finest last.",
    ),
    "inertia": (engine("inertia", inertia=1.05), "Wrong inertia: the inertia is 5.0 % too large, because"),
    "damping ignored": (engine("damping", damping=False), "Wrong motion: the damping moment of a joint is missing."),
    "spring ignored": (engine("spring", spring=0.0), "Wrong motion: the spring moment of a joint is missing."),
    "1 % more": (engine("more", friction=lambda *at: 1.01), "the friction moment of a joint that turns is 1.0 %"),
    "none": (engine("none", friction=lambda *at: 0.0), "no friction was measured in a joint that turns."),
    "accelerates": (engine("accelerates", euler, gain=-1.0), "friction accelerates the joint."),
    "Stribeck": (
        engine("Stribeck", friction=lambda joint, spin, *at: 1.0 + 0.3 * math.exp(-abs(spin) / 0.5)),
        f"{WHOLE}1.0 to 1.3 times F: it depends on the speed (",
    ),
    "direction": (
        engine("direction", friction=lambda joint, spin, *at: 1.1 if spin > 0.0 else 1.0),
        f"{WHOLE}1.0 to 1.1 times F: it depends on the direction.",
    ),
    "direction and speed": (
        engine("skew", friction=lambda joint, spin, *at: 1.0 + 0.2 * math.tanh(spin)),
        f"{WHOLE}0.80 to 1.2 times F: it depends on the direction and the speed (",
    ),
    "inertia and speed": (
        engine("both", friction=lambda joint, spin, *at: joint.inertia**0.1 * (1.0 + 0.1 * abs(spin))),
        "it depends on the inertia, the friction moment, the speed, the angle or the direction.",
    ),
    "eight bits of the inertia": (
        replace(engine("bits", friction=in_eight_bits), precision=1e-6),
        f"{WHOLE}0.9969 to 1.003 times F: it depends on the inertia",
    ),
    "static while sliding": (
        engine("rough", friction=lambda joint, *at: joint.static_ratio, static=1.0),
        "a joint with a static ratio of 1.5 slides with 1.5 F, in place of F.",
    ),
    "offset ignored": (
        engine("relaxed", without_offset), "Wrong motion: the moment of the offset of a joint is missing.",
    ),
    "angle": (
        engine("angle", friction=lambda joint, spin, angle, step: 1.0 + 0.1 * abs(angle)),
        f"{WHOLE}1.0 to 1.9 times F: it depends on the angle (",
    ),
    "by inertia": (
        engine("heavy", friction=lambda joint, *at: joint.inertia**0.1),
        f"{WHOLE}0.52 to 2.0 times F: it depends on the inertia (",
    ),
    "clipped": (
        engine("clipped", friction=lambda joint, *at: min(1.0, 5.0 / max(joint.friction_moment, 1e-9))),
        f"{WHOLE}0.059 to 1.0 times F: it depends on the friction moment (",
    ),
    "hidden damping": (engine("drag", drag=0.05), "Hidden damping: every joint loses 4.9 % of its speed per second."),
    "sign of the speed": (engine("Euler", euler), "the static ratio has no effect"),
    "turns on after a stop": (
        engine("drift", drift=1e-3), "a joint that has stopped creeps at 0.0010 rad/s.",
    ),
    "holds more after a slide": (
        engine("heals", heals=3.0), "on a spring, a joint rests at -2.5 F/C, in place of 0.5 F/C.",
    ),
    "overshoots": (engine("kicked", kicked), "friction overshoots when the speed changes its sign within a step"),
    "only three points": (engine("points", three_points), "Wrong motion: motions with stick and reversals converge"),
    "rests below 0.02 rad/s": (
        engine("slow", stops_below=0.02), f"{WHOLE}0 to 1.0 times F: it depends on the speed ("
    ),
}  # fmt: skip


def diagnosed(engine, *others):
    """Return the row of an engine of joints, without an hour at rest unless it is one of the ``others``."""
    parts = {name: part for name, part in parts_of(engine).items() if name in ("repeat", "joint", *others)}
    found = {name: part(engine) for name, part in parts.items()}
    return row.Row(engine.name, step=engine.step or math.nan, **found)


@pytest.mark.parametrize("name", SOUND)
def test_right_engine_of_joints_is_not_accused(name):
    found = diagnosed(SOUND[name])
    assert found.verdict == RIGHT, found.sentences
    assert found.sentences[0].startswith("Coulomb friction in a joint, accurate to ")
    smoothed = SOUND[name].step is None and name != "events"
    ends = "creeps ever more slowly as the tolerance decreases." if smoothed else "stays at rest."
    assert found.sentences[0].endswith(ends)
    assert found.sentences[-1] == (
        "Joints examined: inertia 0.0014 to 816 kg m², friction moment 1.5×10⁻⁶ to 85 N m, speed 0.014 to 74 rad/s; "
        "both directions."
    )


@pytest.mark.parametrize("name", MISTAKEN)
def test_first_sentence_names_what_is_wrong_with_a_joint(name):
    mistaken, expected = MISTAKEN[name]
    found = diagnosed(mistaken)
    assert found.verdict == WRONG
    assert expected in found.sentences[0]


def test_joint_that_lets_go_within_an_hour_is_named():
    held, leaks = (engine(name, step=5e-3, leaks=leaks) for name, leaks in (("held", 0.0), ("leaks", 60.0)))
    assert diagnosed(held, "hour").verdict == RIGHT
    found = diagnosed(leaks, "hour")
    assert found.verdict == WRONG
    assert "a joint under half of its limit F moves by" in found.sentences[0]
    assert diagnosed(leaks).verdict == RIGHT  # seconds do not show it


def test_joint_in_degrees_or_with_swapped_columns_is_no_result():
    for wrong in (changed(np.degrees), changed(lambda states: states[:, ::-1])):
        with pytest.raises(
            BadTrajectoryError, match=r"for \[0.0, 1.0\]: expected angle in rad and spin in rad/s"
        ):
            joint_probes.joint(engine("other", wrong))


def test_engine_without_a_static_ratio_says_so():
    def refusing(joint, start, times, *, step):
        if joint.static_ratio > 1.0:
            raise UnsupportedSystemError("no static ratio")
        return stepped(joint, start, times, step=step)

    found = diagnosed(engine("without", refusing))
    assert found.verdict == RIGHT
    assert "it breaks away at F (±1 %), stops" in found.sentences[0]


@pytest.mark.parametrize(("function", "how"), [(karnopp, {}), (karnopp, {"step": 5e-3})])
def test_zero_band_that_shrinks_with_the_step_is_right(function, how):
    assert diagnosed(engine("Karnopp", function, **how)).verdict == RIGHT


def test_first_look_at_an_engine_of_joints_shows_two_joints():
    with Workers(1, 60.0) as workers:
        ((_, text),) = run.checked([replace(reference, kinds=("joint",))], workers)
    assert text == (
        "a joint turns 2 rad in 1 s (exact: 2 rad), and a joint under half of the limit F moves 0 rad (exact: 0 rad)"
    )


def test_random_answers_are_not_taken_for_a_law():
    found = diagnosed(engine("random", noise=1e-4))
    assert found.verdict == UNDECIDED
    assert found.sentences[0].startswith("Undecided: equal calls return states that differ by")
    assert not any("Coulomb friction" in sentence for sentence in found.sentences)


def test_engine_of_blocks_and_joints_has_both_sentences(tmp_path):
    assert {"joint", "hour", "law"} <= set(parts_of(reference))
    assert not {"joint", "hour"} & set(parts_of(replace(reference, kinds=("pin",))))
    assert set(parts_of(SOUND["events"])) == {"repeat", "joint", "hour"} <= set(PROBES)
    found = replace(diagnosed(reference), law=parts_of(reference)["law"](reference))
    first, *others = found.sentences
    assert first.startswith("Coulomb friction, accurate to")
    assert any(one.startswith("Coulomb friction in a joint") for one in others)
    row.write_rows([found], tmp_path)
    (content,) = json.loads((tmp_path / "matrix.json").read_text())
    assert np.shape(content["joint"]["slides"]) == (4, 25)
