"""Programs in any language as engines: every fault gives a message, and no process is left behind."""

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


def process_of(engine):
    """Return the process id that the engine reports at its second motion."""
    with pytest.raises(conversation.ProgramError) as error:
        asked_twice(engine)
    return int(str(error.value).rpartition(": ")[2])


@pytest.mark.parametrize(
    ("system", "state", "kind", "step"),
    [
        (FIG5, START, "pin", {}),
        (replace(FIG11, contact_points=6), (*START, 0.0, 0.0), "points", {"step": 1e-3}),
    ],
)
def test_the_request_contains_parameters_start_times_and_accuracy(system, state, kind, step):
    engine = faulty("tells the question", kinds=["pin", "points"], **step)
    engine.simulate(system, state, TIMES)
    with pytest.raises(conversation.ProgramError) as error:
        engine.simulate(system, np.array(state), np.array(TIMES), tolerance=1e-7)
    question = json.loads(str(error.value).partition("says: ")[2])
    asked = {"system": {"kind": kind} | asdict(system), "state": list(state), "times": list(TIMES)}
    assert question == asked | ({"step": engine.step_at(1e-7)} if step else {"tolerance": 1e-7})


def test_the_greeting_declares_the_abilities():
    declared = {"kinds": ("pin", "ring"), "sticks": False, "nonlinear": False, "phases": True}
    usual = {"kinds": ("pin",), "sticks": True, "nonlinear": True, "phases": False}
    silent, named = faulty("none", **declared), faulty("none", name="Drehwurm", version="1.2")
    for engine, abilities in ((silent, declared), (named, usual)):
        assert {ability: getattr(engine, ability) for ability in abilities} == abilities
    assert silent.about == ""
    assert named.about.endswith("runs the program Drehwurm 1.2.")


@pytest.mark.parametrize(
    ("greeting", "reason"),
    [
        ("hello", "wrote a line that is not JSON: 'hello'"),
        ("[1]", "wrote a line that is not a JSON object: '[1]'"),
        ('{"kind": ["pin"]}', "unknown field in its greeting 'kind': did you mean 'kinds'?"),
        ('{"kinds": "pin"}', 'greets with "kinds": "pin": it must be a list'),
        ('{"limit": -1}', 'greets with "limit": -1: it must be > 0 s'),
        ('{"protocol": 2}', "uses protocol 2: it must be 1"),
    ],
)
def test_an_invalid_greeting_is_rejected(greeting, reason):
    with pytest.raises(ValueError, match=f"^{re.escape(reason)}$"):
        json_lines.greeting(greeting.encode())


@pytest.mark.parametrize(
    ("greeting", "reason"),
    [
        ('{"protocol": 2}', "program_of_many_faults uses protocol 2: it must be 1"),
        ('{"kinds": ["sphere"]}', "has an invalid greeting, {'kinds': ['sphere']}: unknown kind of system"),
        ("{}\n{}", "wrote more than one line as its greeting"),
    ],
)
def test_a_program_with_an_invalid_greeting_is_not_an_engine(greeting, reason):
    with pytest.raises(ValueError, match=re.escape(reason)) as error:
        engines(["exec:" + shlex.join([sys.executable, "-S", str(FAULTY), "none", greeting])])
    assert "\n" not in str(error.value)


@pytest.mark.parametrize(
    ("command", "reason"),
    [
        ("./missing", "./missing: command not found"),
        ("here", "command not found in PATH; use ./here for the program in this folder"),
        ("./here", "./here: not executable"),
        ("./folder", "./folder: this is a folder, not a program"),
        ("", "give a command, for example exec:./my_engine"),
        ("'open", "no closing quotation"),
    ],
)
def test_a_command_that_cannot_be_started_is_rejected(command, reason, tmp_path, monkeypatch):
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
    """Return an answer with phases, each given by its kind and start time."""
    told = [{"kind": kind, "start": start, "state": list(state)} for kind, start in begun]
    return states(*START, phases=told)


ROWS = "not rows of numbers of equal length"
BY_ANSWER = {
    "step 1 done": "wrote a line that is not JSON: 'step 1 done'",
    "[" * 50_000: "wrote a line that is not JSON: '[[[",
    "[1, 2]": "wrote a line that is not a JSON object: '[1, 2]'",
    '{"state": [1.0]}': 'answered without "states": \'{"state": [1.0]}\'',
    '{"states": [[1.0], [1.0, 2.0]]}': f"{ROWS}: [[1.0], [1.0, 2.0]]",
    states("0.1", "1", "1", "1"): ROWS,
    states(1.0, True, 1.0, 1.0): ROWS,
    states(10**400, 1, 1, 1): ROWS,
    phases(("slip", True)): f'answered with "start" that are {ROWS}',
    phases(("glide", 0.0)): "a phase {'kind': 'glide', … its \"kind\" must be one of",
    phases(("slip", 0.0), state=(1.0,)): 'and "state" 4 numbers',
}


@pytest.mark.parametrize("answer", BY_ANSWER, ids=lambda answer: answer[:50])
def test_an_invalid_answer_is_rejected(answer):
    reason = ".*".join(map(re.escape, BY_ANSWER[answer].split("…")))
    with pytest.raises(json_lines.BadLineError, match=reason):
        json_lines.answered(answer.encode(), FIG5, TIMES)


TOLD = [
    (
        "exit",
        conversation.ProgramError,
        "ended without answer (exit status 3); its standard error ends with: a first line / it went wrong here",
    ),
    ("closed", conversation.ProgramError, "ended without answer (it closed its output)"),
    ("no end", conversation.ProgramError, "bytes as its answer without a newline"),
    pytest.param("crash", conversation.ProgramError, "ended without answer (SIGKILL)", marks=posix),
    ("step 1 done", conversation.ProgramError, "wrote a line that is not JSON: 'step 1 done'"),
    ("{}\n{}", conversation.ProgramError, "wrote more than one line as its answer"),
    (r'{"error": "\ud800 \u001b[31m"}', conversation.ProgramError, r"says: \ud800 \x1b[31m"),
    (r'{"unsupported": "\ud800 \u001b[31m"}', UnsupportedSystemError, r"\ud800 \x1b[31m"),
    (states(1.0, None, 1.0, 1.0), BadTrajectoryError, "the state at t = 1 s is not finite"),
]


@pytest.mark.parametrize(("fault", "kind", "reason"), TOLD)
def test_any_fault_of_a_program_is_reported_and_the_next_request_is_answered(fault, kind, reason):
    engine = faulty(fault)
    asked(engine)
    with pytest.raises(kind, match=re.escape(reason)) as error:
        asked(engine)
    assert "\n" not in str(error.value)
    if kind is conversation.ProgramError and "error" not in fault:  # a new process gives its first answer
        np.testing.assert_array_equal(asked(engine).states, [START] * 3)


@pytest.mark.parametrize("fault", ["hang", pytest.param("hang with a child", marks=posix)])
def test_a_silent_program_and_its_children_are_ended_at_the_limit(fault):
    engine = faulty(fault, limit=0.4)
    asked(engine)
    group = conversation.conversation_with(engine.function.command, engine.function.folder)._process.pid
    with pytest.raises(conversation.ProgramError, match=r"gave no answer within 0\.4 s"):
        asked(engine)
    if os.name == "posix":
        wait_until(lambda: not _members(group))


def _members(group):
    """Return the living processes of a group, empty on systems without /proc."""
    found = []
    for stat in Path("/proc").glob("[0-9]*/stat"):
        try:
            state, _, of = stat.read_text().rpartition(")")[2].split()[:3]
        except OSError:
            continue
        found += [stat] if int(of) == group and state != "Z" else []
    return found


def test_much_output_on_standard_error_does_not_block():
    np.testing.assert_array_equal(asked_twice(faulty("chatty")).states, [START] * 3)


def test_phases_of_an_answer_are_used():
    found = json_lines.answered(phases(("slip", 0.0), ("stick", 0.5)).encode(), FIG5, TIMES)
    assert [(phase.kind, phase.start, phase.end) for phase in found.phases] == [
        ("slip", 0.0, 0.5),
        ("stick", 0.5, 1.0),
    ]


@posix
def test_a_program_runs_until_the_last_request():
    engine = faulty("tells its process")
    process = process_of(engine)
    with pytest.raises(conversation.ProgramError, match=f"says: {process}$"):
        asked(engine)
    conversation.end_all()
    with pytest.raises(ProcessLookupError):  # a zombie would accept the signal
        os.kill(process, 0)


def _killed_while_it_waits(engine, file):
    asked(engine)
    process = conversation.conversation_with(engine.function.command, engine.function.folder)._process
    Path(file).write_text(str(process.pid))
    threading.Timer(0.3, os.kill, (os.getpid(), signal.SIGKILL)).start()
    asked(engine)


@posix
def test_a_worker_starts_its_own_program_which_ends_with_a_killed_worker(tmp_path):
    telling, hanging = faulty("tells its process"), faulty("hang with a child", limit=1000.0)
    assert pickle.loads(pickle.dumps(telling)) == telling
    with Workers(1) as workers:
        workers.submit("own", asked_twice, telling)
        (own,) = workers.finished()
        workers.submit("killed", _killed_while_it_waits, hanging, tmp_path / "process")
        (killed,) = workers.finished()
    assert isinstance(own.value, Failure)
    assert "says: " in own.value.reason
    assert int(own.value.reason.rpartition(": ")[2]) != process_of(telling)
    assert "SIGKILL" in killed.value.reason
    group = int((tmp_path / "process").read_text())
    wait_until(lambda: not _members(group))


@pytest.fixture
def in_the_foreground():
    """Handle SIGINT as in the foreground of a terminal, because background processes ignore it."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


@posix
def test_ctrl_c_ends_the_running_program(in_the_foreground):
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
    ],
)
def test_an_engine_has_the_short_name_of_its_command(command, name):
    assert name_of(tuple(shlex.split(command))) == name


def test_engines_with_the_same_short_name_keep_their_commands(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for path in ("one/mine.py", "two/mine.py", "reference"):
        (tmp_path / path).parent.mkdir(exist_ok=True)
        (tmp_path / path).write_text(f"#!{sys.executable}\nprint('{{}}', flush=True)\ninput()\n")
        (tmp_path / path).chmod(0o755)
    one, two = (f"exec:{sys.executable} {folder}/mine.py" for folder in ("one", "two"))
    assert [engine.name for engine in engines([one])] == ["mine"]
    assert [engine.name for engine in engines([one, two, "exudyn"])] == [one, two, "exudyn"]
    if os.name == "posix":  # the name of a registered engine is taken
        assert [engine.name for engine in engines(["exec:./reference"])] == ["exec:./reference"]


def test_the_documented_messages_are_the_exchanged_ones():
    document = (Path(__file__).parents[4] / "docs" / "judge-your-engine.md").read_text("utf-8")
    section = document.partition("## Any language")[2].partition("\n## ")[0]
    greeting, question, answer, *_ = re.findall(r"```\n( *\{.*?)```", section, re.DOTALL)
    assert json_lines.greeting(greeting.encode()).who == "exec_pin 1"
    state, times = (0.1, 0.0, 0.03, 0.0), (0.0, 0.5, 1.0)
    line = json_lines.question(FIG5, state, times, {"tolerance": 1e-9})
    assert json.loads(question) == json.loads(line)
    found = json_lines.answered(answer.encode(), FIG5, times)
    np.testing.assert_allclose(found.states, simulate(FIG5, state, times).states, atol=5.1e-4)
