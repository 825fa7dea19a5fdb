"""Programs of any language as engines: whatever they do ends in a sentence, and none is left behind."""

import json
import os
import pickle
import re
import shlex
import signal
import sys
import threading
from dataclasses import asdict, replace
from pathlib import Path

import numpy as np
import pytest
from processes import wait_until

from compare.claims.parameters import FIG5, FIG11
from compare.engines import BadTrajectoryError, UnsupportedSystemError, engines, known_name
from compare.engines.outside import conversation, json_lines
from compare.engines.outside.program import name_of
from compare.run.workers import Failure, Workers
from reference_model import simulate

FAULTY = Path(__file__).with_name("program_of_many_faults.py")
START = (0.1, 1.0 / 3.0, -0.03, 1e-300)
TIMES = (0.0, 0.1, 1.0)

posix = pytest.mark.skipif(os.name != "posix", reason="no process groups")


@pytest.fixture(autouse=True)
def _ended():
    yield
    conversation.end_all()


def named(fault, **greeting):
    words = [sys.executable, "-S", str(FAULTY), fault, json.dumps({"limit": 20.0} | greeting)]
    return "exec:" + shlex.join(words)


def faulty(fault, **greeting):
    (engine,) = engines([named(fault, **greeting)])
    return engine


def asked(engine, times=TIMES):
    return engine.simulate(FIG5, START, times)


def asked_twice(engine):
    asked(engine)
    return asked(engine)


def alive(process):
    try:
        os.kill(process, 0)
        return Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()[0] != "Z"
    except OSError:
        return False


def process_of(engine):
    """Return the number of the engine's process, which fails at the first motion but one."""
    with pytest.raises(conversation.ProgramError) as error:
        asked_twice(engine)
    return int(str(error.value).rpartition(": ")[2])


def test_numbers_come_back_to_the_last_bit():
    np.testing.assert_array_equal(asked(faulty("none")).states, [START] * 3)


@pytest.mark.parametrize(
    ("system", "state", "kind"),
    [
        (FIG5, START, "pin"),
        (FIG11, (*START, 0.0, 0.0), "ring"),
        (replace(FIG11, contact_points=6), (*START, 0.0, 0.0), "points"),
    ],
)
def test_the_question_has_the_parameters_by_their_names_the_start_the_times_and_the_tolerance(
    system, state, kind
):
    engine = faulty("tells the question", kinds=["pin", "ring", "points"])
    engine.simulate(system, state, TIMES)
    with pytest.raises(conversation.ProgramError) as error:
        engine.simulate(system, np.array(state), np.array(TIMES), tolerance=1e-7)
    question = json.loads(str(error.value).partition("says: ")[2])
    assert question == {
        "system": {"kind": kind} | asdict(system),
        "state": list(state),
        "times": list(TIMES),
        "tolerance": 1e-7,
    }


def test_a_program_with_a_fixed_step_is_told_the_step():
    engine = faulty("tells the question", step=1e-3)
    with pytest.raises(conversation.ProgramError) as error:
        asked_twice(engine)
    question = json.loads(str(error.value).partition("says: ")[2])
    assert question["step"] == 1e-3
    assert "tolerance" not in question


def test_the_greeting_promises_what_attributes_of_a_function_would():
    engine = faulty("none", kinds=["pin", "ring"], sticks=False, nonlinear=False, phases=True)
    assert (engine.kinds, engine.sticks, engine.nonlinear, engine.phases) == (
        ("pin", "ring"),
        False,
        False,
        True,
    )
    assert engine.about == ""
    usual = faulty("none", name="Drehwurm", version="1.2")
    assert (usual.kinds, usual.sticks, usual.nonlinear, usual.phases) == (("pin",), True, True, False)
    assert usual.about.endswith("is a program that calls itself Drehwurm 1.2.")


@pytest.mark.parametrize(
    ("greeting", "reason"),
    [
        ("hello", "wrote a line that is no JSON: 'hello'"),
        ("[1]", "wrote a line that is no JSON object: '[1]'"),
        ('{"kind": ["pin"]}', "unknown word in its greeting 'kind': did you mean 'kinds'?"),
        ('{"kinds": "pin"}', 'greets with "kinds": "pin": it must be a list'),
        ('{"kinds": ["sphere"]}', "unknown kind of system 'sphere'"),
        ('{"sticks": 1}', "sticks = 1: it must be True or False"),
        ('{"limit": -1}', 'greets with "limit": -1: it must be > 0 s'),
        ('{"protocol": 2}', "speaks protocol 2: known is 1"),
        ("{}\n{}", "wrote more than one line as its greeting"),
    ],
)
def test_a_program_that_does_not_greet_is_refused_in_one_sentence(greeting, reason):
    with pytest.raises(ValueError, match=re.escape(reason)) as error:
        engines(["exec:" + shlex.join([sys.executable, "-S", str(FAULTY), "none", greeting])])
    assert "\n" not in str(error.value)


@pytest.mark.parametrize(
    ("command", "reason"),
    [
        ("./missing", "./missing: command not found"),
        ("missing-program", "missing-program: command not found in PATH"),
        ("here", "command not found in PATH; use ./here for the file in this folder"),
        ("./here", "./here: it is not executable"),
        ("./folder", "./folder: it is a folder"),
        ("", "a command has to follow, as in exec:./my_engine"),
        ("'open", "no closing quotation"),
    ],
)
def test_a_command_that_can_not_be_started_is_refused(command, reason, tmp_path, monkeypatch):
    (tmp_path / "here").write_text("")
    (tmp_path / "folder").mkdir()
    monkeypatch.chdir(tmp_path)
    for look in (lambda name: engines([name]), known_name):
        with pytest.raises(ValueError, match=re.escape(reason)) as error:
            look(f"exec:{command}")
        assert "\n" not in str(error.value)


def states(*last, **more):
    """Return an answer whose last state is ``last``."""
    return json.dumps({"states": [[0.0] * 4, [0.0] * 4, list(last)]} | more)


def phases(*begun, state=(0.0,) * 4):
    """Return an answer with phases of a kind from a time on."""
    told = [{"kind": kind, "start": start, "state": list(state)} for kind, start in begun]
    return states(*START, phases=told)


ROWS = "no rows of numbers, all as long"
BY_FAULT = {
    "exit": "ended without answer (exit status 3); its standard error ends with: a first line / it went wrong here",
    "closed": "ended without answer (it closed its output)",
    "no end": "and no end of it",
    **({"crash": "ended without answer (SIGKILL)"} if os.name == "posix" else {}),
}
BY_ANSWER = {
    "step 1 done": "wrote a line that is no JSON: 'step 1 done'",
    "": "wrote a line that is no JSON: ''",
    "[" * 50_000: "wrote a line that is no JSON: '[[[",
    "[1, 2]": "wrote a line that is no JSON object: '[1, 2]'",
    '{"states": []}\n{"states": []}': "wrote more than one line as its answer",
    '{"state": [1.0]}': 'answered without "states": \'{"state": [1.0]}\'',
    '{"states": [[1.0], [1.0, 2.0]]}': f"{ROWS}: [[1.0], [1.0, 2.0]]",
    states("a", "b", "c", "d"): ROWS,
    states("0.1", "1", "1", "1"): ROWS,
    states(1.0, True, 1.0, 1.0): ROWS,
    states(10**400, 1, 1, 1): ROWS,
    phases(("slip", True)): f'answered with "start" that are {ROWS.partition(",")[0]}',
    phases(("glide", 0.0)): "a phase {'kind': 'glide', … its \"kind\" must be one of",
    phases(("slip", 0.0), state=(1.0,)): 'and "state" 4 numbers',
}
REFUSED = {
    '{"error": "the step fell to nothing"}': "says: the step fell to nothing",
    r'{"error": "\ud800 \u001b[31m"}': r"says: \ud800 \x1b[31m",
}
UNSUPPORTED = {
    '{"unsupported": "no springs here"}': "no springs here",
    r'{"unsupported": "\ud800 \u001b[31m"}': r"\ud800 \x1b[31m",
}
BAD = {
    phases(("slip", 0.5), ("stick", 0.2)): "phases[0] lasts from 0.5 to 0.2 s: phases must follow each other",
    phases(("slip", -1.0)): "phases[0] lasts from -1 to 1 s: phases must follow each other",
    '{"states": [[1, 1, 1, 1], [1, 1, 1, 1]]}': "states have shape (2, 4): they must have (3, 4)",
    json.dumps({"states": [[1, 1, 1]] * 3}): "states have shape (3, 3): they must have (3, 4)",
    states(1.0, float("nan"), 1.0, 1.0): "the state at t = 1 s is not finite",
    states(1.0, None, 1.0, 1.0): "the state at t = 1 s is not finite",
}
TOLD = [
    (fault, kind, reason, kind is conversation.ProgramError and rows is not REFUSED)
    for kind, rows in (
        (conversation.ProgramError, BY_FAULT),
        (conversation.ProgramError, BY_ANSWER),
        (conversation.ProgramError, REFUSED),
        (UnsupportedSystemError, UNSUPPORTED),
        (BadTrajectoryError, BAD),
    )
    for fault, reason in rows.items()
]


@pytest.mark.parametrize(("fault", "kind", "reason", "ends"), TOLD, ids=[fault[:50] for fault, *_ in TOLD])
def test_whatever_a_program_does_is_told_in_one_sentence_and_the_next_question_is_answered(
    fault, kind, reason, ends
):
    engine = faulty(fault)
    asked(engine)
    with pytest.raises(kind, match=".*".join(map(re.escape, reason.split("…")))) as error:
        asked(engine)
    assert "\n" not in str(error.value)
    if ends:  # a new process is asked for the first time
        np.testing.assert_array_equal(asked(engine).states, [START] * 3)


@pytest.mark.parametrize("fault", ["hang", pytest.param("hang with a child", marks=posix)])
def test_a_program_that_does_not_answer_is_ended_after_its_limit_with_all_that_it_started(fault):
    engine = faulty(fault, limit=0.4)
    asked(engine)
    group = conversation.conversation_with(engine.function.command, engine.function.folder)._process.pid
    with pytest.raises(conversation.ProgramError, match=r"gave no answer within 0\.4 s"):
        asked(engine)
    if os.name == "posix":
        wait_until(lambda: not _members(group))


def _members(group):
    """Return the living processes of a group, where the system tells."""
    found = []
    for stat in Path("/proc").glob("[0-9]*/stat"):
        try:
            state, _, of = stat.read_text().rpartition(")")[2].split()[:3]
        except OSError:
            continue
        found += [stat] if int(of) == group and state != "Z" else []
    return found


def test_much_on_the_standard_error_holds_nothing_up():
    np.testing.assert_array_equal(asked_twice(faulty("chatty")).states, [START] * 3)


def test_phases_are_taken_over():
    found = asked_twice(faulty(phases(("slip", 0.0), ("stick", 0.5))))
    assert [(phase.kind, phase.start, phase.end) for phase in found.phases] == [
        ("slip", 0.0, 0.5),
        ("stick", 0.5, 1.0),
    ]


def test_a_process_is_kept_alive_and_ended_with_the_last_question():
    engine = faulty("tells its process")
    process = process_of(engine)
    with pytest.raises(conversation.ProgramError, match=f"says: {process}$"):
        asked(engine)
    assert alive(process)
    conversation.end_all()
    assert not alive(process)
    with pytest.raises(ChildProcessError):  # no zombie: it has been waited for
        os.waitpid(process, os.WNOHANG)


def test_another_process_has_a_program_of_its_own():
    engine = faulty("tells its process")
    assert pickle.loads(pickle.dumps(engine)) == engine
    with Workers(2) as workers:
        workers.submit("key", asked_twice, engine)
        (done,) = workers.finished()
    assert isinstance(done.value, Failure)
    assert "says: " in done.value.reason
    assert int(done.value.reason.rpartition(": ")[2]) != process_of(engine)


def _killed_while_it_waits(engine, file):
    asked(engine)
    process = conversation.conversation_with(engine.function.command, engine.function.folder)._process
    Path(file).write_text(str(process.pid))
    threading.Timer(0.3, os.kill, (os.getpid(), signal.SIGKILL)).start()
    asked(engine)


@posix
def test_a_worker_that_is_killed_as_by_a_study_limit_takes_its_program_along(tmp_path):
    with Workers(2) as workers:
        engine = faulty("hang with a child", limit=1000.0)
        workers.submit("key", _killed_while_it_waits, engine, tmp_path / "process")
        (done,) = workers.finished()
    assert "SIGKILL" in done.value.reason
    group = int((tmp_path / "process").read_text())
    wait_until(lambda: not _members(group))


@pytest.fixture
def in_the_foreground():
    """Take SIGINT as a terminal's foreground does: what is started in the background ignores it."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


@posix
def test_ctrl_c_ends_the_program_that_was_asked(in_the_foreground):
    engine = faulty("hang")
    asked(engine)
    threading.Timer(0.3, os.kill, (os.getpid(), signal.SIGINT)).start()
    with pytest.raises(KeyboardInterrupt):
        asked(engine)
    np.testing.assert_array_equal(asked(engine).states, [START] * 3)


@pytest.mark.parametrize(
    ("command", "name"),
    [
        ("./exec_pin", "exec_pin"),
        ("/opt/mine/exec_pin.exe --rk 4", "exec_pin --rk 4"),
        ("node examples/exec_pin.js", "exec_pin"),
        ("python3.11 -u my.engine.py 2", "my.engine 2"),
        ("./solver-2.10", "solver-2.10"),
        ("node", "node"),
    ],
)
def test_an_engine_is_called_by_its_command_in_short(command, name):
    assert name_of(tuple(shlex.split(command))) == name


def test_two_engines_of_one_short_name_are_told_apart(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    text = FAULTY.read_text()
    for folder in ("one", "two"):
        (tmp_path / folder).mkdir()
        (tmp_path / folder / "mine.py").write_text(text)
        (tmp_path / folder / "reference.py").write_text(text)
    one, two, taken = (
        f"exec:{sys.executable} {file} none" for file in ("one/mine.py", "two/mine.py", "two/reference.py")
    )
    assert [engine.name for engine in engines([one])] == ["mine none"]
    assert [engine.name for engine in engines([one, two, "exudyn"])] == [one, two, "exudyn"]
    assert [engine.name for engine in engines([taken])] == ["reference none"]


def test_an_engine_may_not_be_called_as_one_that_is_registered(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "reference").write_text(f"#!{sys.executable}\nprint('{{}}', flush=True)\ninput()\n")
    (tmp_path / "reference").chmod(0o755)
    if os.name == "posix":
        assert [engine.name for engine in engines(["exec:./reference"])] == ["exec:./reference"]


def test_the_lines_in_the_document_are_those_that_are_exchanged():
    document = (Path(__file__).parents[4] / "docs" / "judge-your-engine.md").read_text("utf-8")
    section = document.partition("## Any language")[2].partition("\n## ")[0]
    greeting, question, answer, *_ = re.findall(r"```\n( *\{.*?)```", section, re.DOTALL)
    assert json_lines.greeting(greeting.encode()).who == "exec_pin 1"
    state, times = (0.1, 0.0, 0.03, 0.0), (0.0, 0.5, 1.0)
    line = json_lines.question(FIG5, state, times, {"tolerance": 1e-9})
    assert json.loads(question) == json.loads(line)
    found = json_lines.answered(answer.encode(), FIG5, times)
    np.testing.assert_allclose(found.states, simulate(FIG5, state, times).states, atol=5.1e-4)
