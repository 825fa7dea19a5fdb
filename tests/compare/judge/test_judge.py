"""The judge judged: what it makes of engines whose faults are known."""

import json
import math
from dataclasses import replace

import numpy as np
import pytest
from fake_studies import claim, straight

from compare.claims.claim import KINDS
from compare.claims.paper_parameters import FIG5
from compare.claims.study import Findings, Study
from compare.cli import app as cli
from compare.engines import Engine
from compare.judge import detection, judge
from compare.judge import faults as catalogue
from compare.judge.faults import FAULTS, RIGHT, Fault
from compare.judge.outcome import Outcome
from compare.studies.engines.trajectories.claims import STUDY as TRAJECTORIES
from compare.studies.engines.trajectories.claims import measure as measure_motions
from compare.studies.engines.trajectories.parameters import PINS, POINTS
from reference_model import PinOnDisc

START = (0.5, 0.25, 0.0, 0.0)


pytestmark = pytest.mark.usefixtures("in_this_process")


def moved(x=0.0, y=0.0):
    """Return an engine that is wrong by ``x``, which only trajectories see, and by ``y``, which only others see."""

    def simulate(system, initial_state, times, *, tolerance=1e-9):
        return straight(system, np.add(initial_state, (x, y, 0.0, 0.0)), times, tolerance=tolerance)

    return Engine("moved", simulate)


def failing(system, initial_state, times, *, tolerance=1e-9):
    raise RuntimeError("no step is small enough")


def measure(engine):
    x, y = engine.simulate(FIG5, START, [0.0, 1.0]).at_end[:2]
    return Findings(
        (
            claim("x is that of the reference", engine.name, 0.5, x, 1e-9, kind="trajectory"),
            claim("y is that of the formula", engine.name, 0.25, y, 1e-9),
        )
    )


STUDY = Study("places", "Two places", "Nothing moves.", measure)


RIGHT_ONE = replace(moved(), name="right")


def judged(faults, tmp_path, right=RIGHT_ONE, **more):
    return judge.judge(faults, (right,), (STUDY,), folder=tmp_path / "data", whole=False, **more)


@pytest.mark.parametrize(
    ("engine", "changes_physics", "outcome"),
    [
        (moved(1e-6, 1e-6), True, Outcome.CAUGHT),
        (moved(1e-6), True, Outcome.ONLY_TRAJECTORY),
        (moved(0.0, 1e-6), True, Outcome.ONLY_OTHERS),
        (moved(1e-12, 1e-12), True, Outcome.MISSED),
        (Engine("failing", failing), True, Outcome.CAUGHT),  # by all kinds of claims that it has none of
        (moved(), False, Outcome.INVISIBLE),
        (moved(1e-6), False, Outcome.WRONGED),
    ],
)
def test_what_becomes_of_a_fault(engine, changes_physics, outcome, tmp_path):
    result = judged((Fault("it", "It is so.", replace(engine, name="it"), changes_physics, "why"),), tmp_path)
    assert [one.outcome for one in result.faults] == [outcome]
    assert [one.outcome for one in result.right] == [Outcome.PASSES]
    assert result.good is (outcome in (Outcome.CAUGHT, Outcome.INVISIBLE))


def test_a_right_engine_that_fails_is_the_judges_fault(tmp_path):
    fault = Fault("it", "It is so.", replace(moved(1e-6, 1e-6), name="it"))
    result = judged((fault,), tmp_path, right=replace(moved(0.0, 1e-6), name="right"))
    assert [one.outcome for one in result.right] == [Outcome.WRONGED]
    assert not result.good


def test_what_is_not_finished_is_no_success(tmp_path):
    def interrupt(done, total, name):
        if done == 1:
            raise KeyboardInterrupt

    fault = Fault("it", "It is so.", replace(moved(1e-6, 1e-6), name="it"))
    result = judged((fault,), tmp_path, progress=interrupt)
    assert result.interrupted
    assert not result.good
    assert Outcome.UNFINISHED in {one.outcome for one in result.faults}
    judge.write_judged(result, tmp_path)
    assert "--resume" in (tmp_path / "judge.html").read_text(encoding="utf-8")


def test_json_and_page_tell_what_caught_what(tmp_path):
    faults = (
        Fault("both", "Both places are off.", replace(moved(1e-6, 1e-6), name="both")),
        Fault("none", "Nothing is off.", replace(moved(), name="none"), False, "It is the same engine."),
    )
    judge.write_judged(judged(faults, tmp_path), tmp_path)
    content = json.loads((tmp_path / "judge.json").read_text(encoding="utf-8"))
    assert [one["outcome"] for one in content["faults"]] == ["caught", "changes nothing"]
    assert [one["kinds"] for one in content["faults"][0]["caught_by"]] == [["trajectory"], ["formula"]]
    page = (tmp_path / "judge.html").read_text(encoding="utf-8")
    for text in (
        "Both places are off.",
        "y is that of the formula",
        "It is the same engine.",
        "slips through",
    ):
        assert (text in page) is (text != "slips through")
    assert "1 of 1 faults caught" in page


A_PIN = {"a pin": PINS["a pin"]}


def test_a_fault_of_the_catalogue_is_caught_from_the_command_line(tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(catalogue, "RIGHT", RIGHT[:1])
    one = replace(TRAJECTORIES, by_hand=lambda engine: measure_motions(engine, A_PIN))
    arguments = ["--study", "trajectories", "--jobs", "1", "--output", str(tmp_path)]
    status = cli.status(["judge", "mass-off-by-1e-6", *arguments], (one,))
    out = capsys.readouterr().out
    assert "1 of 1 faults caught by trajectories and by claims of another kind" in out
    assert f"1 of 1 right engines pass ({tmp_path / 'judge.html'})" in out
    assert status == 0


SIX_POINTS = {"a disc on six points": POINTS["a disc on six points"]}


def test_a_moment_of_the_wrong_sign_is_caught_and_right_engines_pass(tmp_path):
    study = replace(STUDY, by_hand=lambda engine: measure_motions(engine, SIX_POINTS))
    fault = next(fault for fault in FAULTS if fault.name == "moment-of-wrong-sign")
    result = judge.judge((fault,), RIGHT, (study,), folder=tmp_path, whole=False)
    assert [one.outcome for one in result.faults] == [Outcome.CAUGHT]
    assert [one.outcome for one in result.right] == [Outcome.PASSES] * len(RIGHT)


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        (["moment-of-wrong-sing"], "did you mean 'moment-of-wrong-sign'?"),
        (["--study", "trajectory"], "did you mean 'trajectories'?"),
        (["--jobs", "0"], "jobs = 0"),
    ],
)
def test_bad_input_ends_in_a_sentence(arguments, sentence, tmp_path, capsys):
    assert cli.status(["judge", *arguments, "--output", str(tmp_path / "new")]) == 2
    assert sentence in capsys.readouterr().err


def test_the_catalogue_is_large_and_its_names_are_distinct():
    assert sum(fault.changes_physics for fault in FAULTS) >= 40
    names = [fault.name for fault in FAULTS] + [engine.name for engine in RIGHT]
    assert len(set(names)) == len(names)


def test_limits_are_the_last_error_that_is_noticed(monkeypatch):
    """Of a fake study that sees 1e-6 of the mass by trajectories and 1e-4 by formulas, and no other parameter."""

    def noticing(engine, motions):
        error = abs(engine.simulate(FIG5, START, [0.0, 1.0]).at_end[0] - START[0])
        return Findings(
            tuple(
                claim(kind, engine.name, 0.0, error, limit, kind=kind)
                for kind, limit in (("trajectory", 0.9e-6), ("formula", 0.9e-4))
            )
        )

    def simulate(system, initial_state, times, *, tolerance=1e-9):
        shift = (system.mass - FIG5.mass, 0.0, 0.0, 0.0)
        return straight(system, np.add(initial_state, shift), times, tolerance=tolerance)

    monkeypatch.setattr(detection, "measure", noticing)
    engine = Engine("of mass", simulate)
    assert detection.limits_of(engine, PinOnDisc, "mass") == pytest.approx((1e-6, 1e-4))
    assert detection.limits_of(engine, PinOnDisc, "stiffness") == (math.inf, math.inf)


def test_kinds_are_those_of_the_studies():
    assert KINDS == ("formula", "conservation", "order", "trajectory")
    with pytest.raises(ValueError, match="kind = 'guess': it must be one of formula"):
        claim("c", "good", 0.0, 0.0, 0.0, kind="guess")
