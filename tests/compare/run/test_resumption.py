"""Findings are resumed only where it can be shown that nothing has changed that they depend on."""

import ast
import functools
import importlib
import inspect
import json
import re
import subprocess
import sys
import textwrap
import types
from importlib.machinery import EXTENSION_SUFFIXES

import fake_studies
import numpy as np
import pytest
from processes import environment

from compare.cli import app as cli
from compare.engines import ByName, Engine, reference
from compare.run import code_files
from compare.run.code_files import CodeFiles
from compare.run.fingerprint import fingerprint
from compare.run.runner import run
from compare.run.stamp import PACKAGES
from compare.studies import STUDIES

pytestmark = pytest.mark.usefixtures("in_this_process")

HEAD = """
from dataclasses import replace
from reference_model import simulate as right

def off(factor, system, start, times, tolerance=1e-9):
    found = right(system, start, times, tolerance=tolerance)
    return replace(found, states=factor * found.states)
"""

ENGINE = """
def simulate(system, start, times, *, tolerance=1e-9):
    return off({factor}, system, start, times, tolerance)
"""


@pytest.fixture
def found(tmp_path):
    """Return where the pin of an engine is after 1 s, over that of the reference, by a run that resumes.

    Return also whether it was measured and not taken from an earlier run, and why it had to be.
    """
    exact = fake_studies.measure_motion(reference).data["end"]

    def of(engine):
        fake_studies.MEASURED.clear()
        result = run((fake_studies.MOTION,), (engine,), folder=tmp_path / "data", resume=True)
        ratio = result.outcomes["motion", engine.name].data["end"] / exact
        return (
            round(float(ratio[0]), 6),
            bool(fake_studies.MEASURED),
            result.unknown.get(engine.name, ""),
        )

    return of


@pytest.fixture
def module(tmp_path, monkeypatch):
    """Write modules in place of older ones, and return the one that is named first as it is then imported."""
    folder = tmp_path / "code"
    folder.mkdir()
    monkeypatch.syspath_prepend(folder)
    monkeypatch.setattr(sys, "dont_write_bytecode", True)

    def forget():
        for name in list(sys.modules):
            where = (getattr(sys.modules[name], kind, "") for kind in ("__file__", "__path__"))
            if any(str(folder) in str(one) for one in where):
                del sys.modules[name]
        importlib.invalidate_caches()

    def of(**sources):
        written = {name if "/" in name else name.replace("__", "/"): text for name, text in sources.items()}
        for name, text in written.items():
            path = folder / f"{name}.py"
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text, encoding="utf-8")
        forget()
        return importlib.import_module(next(iter(sources)).replace("__", "."))

    yield of
    forget()


@pytest.fixture
def look_anew():
    """Let what is installed be looked for anew, which takes longer than all else here."""

    def forget():
        for known in (code_files._installed, code_files._installed_packages, code_files._distributions):
            known.cache_clear()

    yield forget
    forget()


SAME_AND_CHANGED = ((1.0, True), (1.0, False), (2.0, True))
"""Factors of the engine, one run after the other, and whether it must be measured."""

CHANGED = {
    "the module itself": lambda factor: {"mine": HEAD + ENGINE.format(factor=factor)},
    "an imported module": lambda factor: {
        "mine": f"{HEAD}from settings import FACTOR{ENGINE.format(factor='FACTOR')}",
        "settings": f"FACTOR = {factor}",
    },
    "a module that an imported module imports": lambda factor: {
        "mine": f"{HEAD}import settings{ENGINE.format(factor='settings.factor()')}",
        "settings": "def factor():\n    import numbers_of_mine\n    return numbers_of_mine.FACTOR",
        "numbers_of_mine": f"FACTOR = {factor}",
    },
    "another module of its package": lambda factor: {
        "package__solver": f"{HEAD}from . import settings{ENGINE.format(factor='settings.FACTOR')}",
        "package__settings": "from .deep.inside import FACTOR",
        "package__deep__inside": f"FACTOR = {factor}",
    },
}


@pytest.mark.parametrize("sources", CHANGED.values(), ids=CHANGED)
def test_an_engine_is_measured_anew_when_code_changes(sources, module, found):
    for factor, anew in SAME_AND_CHANGED:
        assert found(Engine("mine", module(**sources(factor)).simulate)) == (factor, anew, "")


OBJECTS = f"""{HEAD}
import ast
import functools

class Solver:
    scale = 1.0

    def __init__(self, factor):
        self.settings = {{"factors": [factor]}}

    def __call__(self, *arguments, tolerance=1e-9):
        return off(self.settings["factors"][0] * self.scale, *arguments, tolerance)

    def simulate(self, *arguments, tolerance=1e-9):
        return self(*arguments, tolerance=tolerance)

def closure(factor):
    def simulate(*arguments, tolerance=1e-9):
        return off(factor, *arguments, tolerance)

    return simulate

def with_default(factor):
    def simulate(*arguments, tolerance=1e-9, factor=factor):
        return off(factor, *arguments, tolerance)

    return simulate

def decorated(factor):
    @functools.wraps(closure)
    def simulate(*arguments, **more):
        return closure(factor)(*arguments, **more)

    return simulate

GLOBAL = 1.0

def by_global(factor):
    global GLOBAL
    GLOBAL = factor
    return of_global

def of_global(*arguments, tolerance=1e-9):
    return off(GLOBAL, *arguments, tolerance)

def by_class(factor):
    Solver.scale = factor
    return Solver(1.0)
"""

MADE = {
    "a partial's arguments": lambda module, factor: functools.partial(module.off, factor),
    "a partial of a partial": lambda module, factor: functools.partial(functools.partial(module.off), factor),
    "an instance's attributes": lambda module, factor: module.Solver(factor),
    "attributes of a method's instance": lambda module, factor: module.Solver(factor).simulate,
    "what a closure holds": lambda module, factor: module.closure(factor),
    "a default": lambda module, factor: module.with_default(factor),
    "what is decorated": lambda module, factor: module.decorated(factor),
    "a global number": lambda module, factor: module.by_global(factor),
    "a number of a class": lambda module, factor: module.by_class(factor),
}


@pytest.mark.parametrize("make", MADE.values(), ids=MADE)
def test_an_engine_is_measured_anew_when_what_it_holds_changes(make, module, found):
    mine = module(mine=OBJECTS)
    for factor, anew in SAME_AND_CHANGED:
        mine.made = make(mine, factor)
        assert found(Engine("mine", ByName("mine", "made"))) == (factor, anew, "")


def test_an_engine_is_measured_anew_when_it_promises_something_else(module, found):
    mine = module(mine=HEAD + ENGINE.format(factor=1.0)).simulate
    assert [found(Engine("mine", mine, kinds, sticks))[1] for kinds, sticks in PROMISES] == [
        True,
        False,
        True,
        True,
    ]


PROMISES = ((("pin",), True), (("pin",), True), (("pin", "ring"), True), (("pin", "ring"), False))

KERNEL = f"kernel{EXTENSION_SUFFIXES[0]}"


def test_an_engine_is_measured_anew_when_a_compiled_extension_changes(module, found, tmp_path):
    never = "\n\ndef never():\n    import kernel\n"  # imported where it is needed, which is not here
    for content, anew in ((b"one", True), (b"one", False), (b"two", True)):
        (tmp_path / "code" / KERNEL).write_bytes(content)
        mine = module(mine=HEAD + ENGINE.format(factor=1.0) + never)
        assert found(Engine("mine", mine.simulate)) == (1.0, anew, "")


@pytest.mark.parametrize("editable", [False, True])
def test_an_engine_is_measured_anew_when_what_is_installed_changes(
    editable, module, found, look_anew, tmp_path, monkeypatch
):
    """Though its version stays the same; a distribution that is installed requires what changes."""
    site = tmp_path / "site-packages"
    outside = tmp_path / "source"
    for folder in (site / "first-1.0.dist-info", site / "second-1.0.dist-info", outside):
        folder.mkdir(parents=True)
    (site / "first.py").write_text("")
    for name, requires in (("first", "Requires-Dist: second>=1\n"), ("second", "")):
        metadata = f"Metadata-Version: 2.1\nName: {name}\nVersion: 1.0\n{requires}"
        (site / f"{name}-1.0.dist-info" / "METADATA").write_text(metadata)
        (site / f"{name}-1.0.dist-info" / "top_level.txt").write_text(name)
    if editable:
        direct = {"url": outside.as_uri(), "dir_info": {"editable": True}}
        (site / "second-1.0.dist-info" / "direct_url.json").write_text(json.dumps(direct))
    monkeypatch.syspath_prepend(site)
    monkeypatch.syspath_prepend(outside)
    for content, anew in (("one", True), ("one", False), ("two", True)):
        files = {
            site / "second-1.0.dist-info" / "RECORD": "second.py,,"
            if editable
            else f"second.py,sha256={content},3",
            (outside if editable else site) / "second.py": f"# {content}",
        }
        for path, text in files.items():
            path.write_text(text)
        look_anew()
        mine = module(mine=f"{HEAD}import first\n{ENGINE.format(factor=1.0)}")
        assert found(Engine("mine", mine.simulate)) == (1.0, anew, "")


HIDDEN = {
    "import ctypes": "mine.py:2 uses ctypes, which may run any code",
    "from ctypes import CDLL": "mine.py:2 uses ctypes, which may run any code",
    "import subprocess as run": "mine.py:2 uses subprocess, which may run any code",
    "import os\nfrom os import system": "mine.py:3 uses system, which may run any code",
    "import os; found = os.popen": "mine.py:2 uses os.popen, which may run any code",
    "import importlib; importlib.import_module('math')": "mine.py:2 uses import_module, which may run any code",
    "exec('scale = 1.0')": "mine.py:2 uses exec, which may run any code",
    "import threading; LOCK = threading.Lock()": "an object of the class lock can't be written down: ",
}


@pytest.mark.parametrize("line", HIDDEN)
def test_an_engine_that_may_depend_on_anything_is_always_measured_anew_and_that_is_told(line, module, found):
    text = HEAD + ENGINE.format(factor=1.0) + "    LOCK\n" * ("LOCK" in line)
    mine = Engine("mine", module(mine=f"\n{line}\n{text}").simulate)
    for _ in range(2):
        factor, anew, reason = found(mine)
        assert (factor, anew) == (1.0, True)
        assert reason.startswith(HIDDEN[line])


def test_an_engine_of_an_interactive_session_is_always_measured_anew_and_that_is_told(found):
    session = types.ModuleType("session")
    exec(compile(HEAD + ENGINE.format(factor=1.0), "<stdin>", "exec"), vars(session))
    sys.modules["session"] = session
    try:
        for _ in range(2):
            assert found(Engine("mine", session.simulate)) == (1.0, True, "session was not read from a file")
    finally:
        del sys.modules["session"]


def test_an_engine_of_a_class_that_is_made_in_a_function_is_always_measured_anew(module, found):
    class Local:
        def __call__(self, *arguments, tolerance=1e-9):
            return reference.simulate(*arguments, tolerance=tolerance)

    module(mine="").made = Local()
    for _ in range(2):
        assert found(Engine("mine", ByName("mine", "made"))) == (
            1.0,
            True,
            "the class Local is made when the program runs",
        )


COMPILED = """
import numba, numpy as np, logging
from numpy import hypot
from functools import cache, partial
from pathlib import Path
from reference_model.numerics.compiled_parts import Part

LOG, HERE, NAMES = logging.getLogger("mine"), Path("here"), {{"a", "b", "c", "d"}}

@numba.njit(cache=True)
def force(x):
    return {factor} * x

@Part
def shifted(x):
    return x + {shift}

@cache
def table(n):
    return np.zeros(n)

def simulate(x):
    LOG.info(HERE, NAMES)
    return force(x) + shifted(x) + hypot(table(3)[0], x) + np.sin(x)

INSTANCE = partial(simulate, np.arange(3.0), kinds=NAMES)
"""

PRINT = """
from compare.run.fingerprint import fingerprint
from compare.run.stamp import PACKAGES
import mine
print(fingerprint(mine.simulate, PACKAGES), fingerprint(mine.INSTANCE, PACKAGES))
"""


def test_a_compiled_function_is_known_by_its_code_in_every_process(module, tmp_path):
    mine = module(mine=COMPILED.format(factor=2.0, shift=1.0))
    here = [printed(mine.simulate), printed(mine.INSTANCE)]
    process = subprocess.run(
        [sys.executable, "-c", PRINT],
        cwd=tmp_path / "code",
        env=environment(PYTHONHASHSEED="1", PYTHONDONTWRITEBYTECODE="1"),
        capture_output=True,
        text=True,
    )
    assert (process.stdout.split(), process.stderr) == (here, "")
    for factor, shift in ((3.0, 1.0), (2.0, 2.0)):
        other = module(mine=COMPILED.format(factor=factor, shift=shift))
        assert {printed(other.simulate), printed(other.INSTANCE)}.isdisjoint(here)


@pytest.mark.skipif(not hasattr(np.hypot, "__dict__"), reason="no attributes of ufuncs before numpy 2")
def test_what_another_package_attaches_to_an_installed_function_makes_no_difference(module, monkeypatch):
    mine = module(mine=COMPILED.format(factor=2.0, shift=1.0))
    before = printed(mine.simulate)
    attached = inspect.Signature()  # as libraries of arrays do
    monkeypatch.setattr(np.hypot, "__signature__", attached, raising=False)
    assert printed(mine.simulate) == before


def printed(thing):
    return fingerprint(thing, PACKAGES)


OURS = {
    "ours__first": "import ours.common.helper",
    "ours/__init__": "import ours.second",
    "ours__common__helper": "",
    "ours__second": "from ours.common import helper",
    "ours__third": "import subprocess, ours",
}
"""Modules of a trusted package: the package itself imports one of them, as ours does to list its studies."""


@pytest.mark.parametrize(
    ("changed", "others"),
    [
        ("ours__first", {"ours.first"}),
        ("ours__second", {"ours.second", "ours.third"}),
        ("ours__common__helper", {"ours.first", "ours.second", "ours.third"}),
        ("ours/__init__", {"ours.first", "ours.second", "ours.third"}),
    ],
)
def test_what_depends_on_a_changed_file_of_ours_is_measured_anew_and_nothing_else(changed, others, module):
    def facts():
        found = {}
        for name in ("ours.first", "ours.second", "ours.third"):
            code = CodeFiles(["ours"])
            assert code.add(name)
            found[name] = code.facts
        return found

    module(**OURS)
    before = facts()
    module(**OURS | {changed: OURS[changed] + "\n# changed"})
    after = facts()
    assert {name for name in before if before[name] != after[name]} == others


def test_an_import_is_found_wherever_a_statement_may_stand():
    source = """
    class A:
        async def f(self):
            import a
    if a: import b
    elif b: import c
    else:
        try: import d
        except OSError: import e
        else: import f
        finally: import g
    for x in y:
        while x: import h
        else: import i
    else:
        with x, y: import j
        match x:
            case 1 if y: import k
    """
    tree = ast.parse(textwrap.dedent(source))
    found = {node.names[0].name for node in code_files._statements(tree) if isinstance(node, ast.Import)}
    assert found == set("abcdefghijk")


def test_a_study_depends_on_its_own_files_and_on_those_of_no_other_study():
    """But for what they share: the toolkit, claims, reference, and Exudyn models where they are its subject."""
    for study in STUDIES:
        code = CodeFiles(PACKAGES)
        for declared in study.declared:
            code.add(declared.function.__module__)
        package = sys.modules[(study.by_hand or study.declared[0].function).__module__].__package__
        modules = {fact.split()[0] for fact in code.facts}
        studies = {name for name in modules if re.match(r"compare\.studies\.(?!toolkit)\w+\.\w+", name)}
        assert studies
        assert all(name.startswith(package.removesuffix(".claims")) for name in studies), study.name
        assert "reference_model.systems" in modules


def test_recorded_engines_depend_on_the_files_of_records():
    code = CodeFiles(PACKAGES)
    code.add("compare.foreign.records")
    assert any(fact.startswith("compare.foreign.records mujoco.json") for fact in code.facts)


def test_an_engine_of_ours_depends_on_the_package_that_it_imports_when_it_is_called(monkeypatch):
    added = []
    monkeypatch.setattr(CodeFiles, "add", lambda _, module: added.append(module) or True)
    fingerprint(ByName("exudyn_models", "simulate"), PACKAGES)
    assert "exudyn_models" in added


def test_what_is_measured_anew_is_told_on_the_command_line(module, tmp_path, monkeypatch, capsys):
    module(mine=f"import ctypes\n{HEAD}{ENGINE.format(factor=1.0)}")
    monkeypatch.chdir(tmp_path / "code")
    arguments = [
        "report",
        "agreement",
        "--engine",
        "mine:simulate",
        "--jobs",
        "1",
        "--output",
        str(tmp_path / "r"),
    ]
    assert cli.status(arguments, fake_studies.ALL) == 0
    assert capsys.readouterr().err == ""
    assert cli.status([*arguments, "--resume"], fake_studies.ALL) == 0
    assert capsys.readouterr().err == (
        "mine:simulate is measured anew, since what it depends on can't be seen: "
        "mine.py:1 uses ctypes, which may run any code\n"
    )


def test_a_built_in_function_as_engine_ends_in_sentences(tmp_path, capsys):
    arguments = ["report", "partly", "--engine", "math:sin", "--jobs", "1", "--output", str(tmp_path)]
    for more in ([], ["--resume"]):
        assert cli.status([*arguments, *more], fake_studies.ALL) == 1
        out, err = capsys.readouterr()
        assert "partly math:sin failed" in out
        assert "TypeError: math.sin() takes no keyword arguments" in out
        assert err == ""
