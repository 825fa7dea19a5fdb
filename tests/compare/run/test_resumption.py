"""Findings are resumed while sources, libraries and the engine's own files are the same."""

import importlib
import sys
import types
from importlib.machinery import EXTENSION_SUFFIXES
from pathlib import Path
from shutil import copytree, ignore_patterns

import fake_studies
import pytest

from compare.engines import ByName, Engine, reference
from compare.engines.outside.fmu import Fmu
from compare.engines.outside.motion_files import MotionFiles
from compare.engines.outside.program import Program, code_below
from compare.run import provenance as stamp
from compare.run.provenance import PACKAGES, engine_stamp
from compare.run.runner import run
from compare.studies import STUDIES

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
def found(tmp_path, in_this_process):
    """Return where the pin of an engine is after 1 s, over that of the reference, by a run that resumes.

    Return also whether it was measured and not taken from an earlier run.
    """
    exact = fake_studies.measure_motion(reference).data["end"]

    def of(engine):
        fake_studies.MEASURED.clear()
        result = run((fake_studies.MOTION,), (engine,), folder=tmp_path / "data", resume=True)
        ratio = result.outcomes["motion", engine.name].data["end"] / exact
        return round(float(ratio[0]), 6), bool(fake_studies.MEASURED)

    return of


@pytest.fixture
def code(tmp_path, monkeypatch):
    """Write modules in place of older ones, which are forgotten, into a folder where imports find them."""
    folder = tmp_path / "code"
    folder.mkdir()
    monkeypatch.syspath_prepend(folder)
    monkeypatch.setattr(sys, "dont_write_bytecode", True)

    def forget():
        for name, module in list(sys.modules.items()):
            where = (getattr(module, kind, "") for kind in ("__file__", "__path__"))
            if any(str(folder) in str(one) for one in where):
                del sys.modules[name]
        importlib.invalidate_caches()

    def of(sources):
        for name, text in sources.items():
            path = folder / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(text.encode())
        forget()
        return folder

    yield of
    forget()


SAME_AND_CHANGED = ((1.0, True), (1.0, False), (2.0, True))
"""Factors of the engine, one run after the other, and whether it must be measured."""

CHANGED = {
    "the module itself": ("mine", lambda factor: {"mine.py": HEAD + ENGINE.format(factor=factor)}),
    "a module beside it": (
        "mine",
        lambda factor: {
            "mine.py": f"{HEAD}from settings import FACTOR{ENGINE.format(factor='FACTOR')}",
            "settings.py": f"FACTOR = {factor}",
        },
    ),
    "a module of a package beside it, imported by name when it runs": (
        "mine",
        lambda factor: {
            "mine.py": f"{HEAD}import importlib{ENGINE.format(factor=BY_NAME)}",
            "helpers/deep/numbers_of_mine.py": f"FACTOR = {factor}",
        },
    ),
    "another module of its package": (
        "package.inner.solver",
        lambda factor: {
            "package/inner/solver.py": f"{HEAD}from ..deep.settings import FACTOR{ENGINE.format(factor='FACTOR')}",
            "package/deep/settings.py": f"FACTOR = {factor}",
        },
    ),
}
BY_NAME = "importlib.import_module('helpers.deep.numbers_of_mine').FACTOR"


@pytest.mark.parametrize(("module", "sources"), CHANGED.values(), ids=CHANGED)
def test_an_engine_is_measured_again_when_its_module_or_one_beside_it_changes(module, sources, code, found):
    for factor, again in SAME_AND_CHANGED:
        code(sources(factor))
        assert found(Engine("mine", ByName(module, "simulate"))) == (factor, again)


def test_an_engine_is_measured_again_when_a_compiled_extension_beside_it_changes(code, found):
    folder = code({"mine.py": HEAD + ENGINE.format(factor=1.0)})
    for content, again in ((b"one", True), (b"one", False), (b"two", True)):
        (folder / f"kernel{EXTENSION_SUFFIXES[0]}").write_bytes(content)
        assert found(Engine("mine", ByName("mine", "simulate"))) == (1.0, again)


def test_an_engine_is_measured_again_when_it_promises_something_else(code, found):
    code({"mine.py": HEAD + ENGINE.format(factor=1.0)})
    engine = ByName("mine", "simulate")
    assert [found(Engine("mine", engine, *promises))[1] for promises in PROMISES] == [True, False, True, True]


PROMISES = ((("pin",), True), (("pin",), True), (("pin", "ring"), True), (("pin", "ring"), False))


def test_an_engine_without_files_is_always_measured_again(found):
    session = types.ModuleType("session")
    exec(compile(HEAD + ENGINE.format(factor=1.0), "<stdin>", "exec"), vars(session))
    sys.modules["session"] = session
    try:
        assert [found(Engine("mine", session.simulate)) for _ in range(2)] == [(1.0, True)] * 2
    finally:
        del sys.modules["session"]


@pytest.mark.parametrize("module", ["bad", "bad.inner", "bad_package.inner"])
def test_the_modules_of_an_engine_are_not_imported_for_its_stamp(module, code):
    folder = code({"bad.py": "raise SystemExit", "bad_package/__init__.py": "raise SystemExit"})
    before = list(sys.path)
    assert engine_stamp(Engine("bad", ByName(module, "simulate", str(folder)))) is not None
    assert sys.path == before
    assert "bad" not in sys.modules


def test_of_an_installed_module_its_own_file_counts_and_the_versions_of_all_packages(tmp_path, monkeypatch):
    site = tmp_path / "site-packages"
    (metadata := site / "helper-1.0.dist-info").mkdir(parents=True)
    monkeypatch.syspath_prepend(site)

    def now(own="", other="", version="1.0"):
        (site / "installed.py").write_text(own)
        (site / "another.py").write_text(other)
        (metadata / "METADATA").write_text(f"Metadata-Version: 2.1\nName: helper\nVersion: {version}\n")
        return engine_stamp(Engine("installed", ByName("installed", "simulate")))

    assert now() == now(other="# of another package")
    assert len({now(), now(own="# changed"), now(version="1.1")}) == 3


@pytest.fixture
def outside(tmp_path):
    """Engines from elsewhere by their kind, with the file that is changed, in the folder of the test."""
    for name in ("engine.js", "helper.js", "engine.py", "engine", "model.fmu", "plan.json", "0f3a.csv"):
        (tmp_path / name).write_text("before")
    (tmp_path / "helpers").mkdir()
    (tmp_path / "helpers" / "helper.py").write_text("before")
    folder = str(tmp_path)
    return {
        "a program": (Program(("./engine", "1"), folder), "engine"),
        "a script": (Program((sys.executable, "engine.py"), folder), "engine.py"),
        "a package beside a script": (Program(("./engine.py",), folder), "helpers/helper.py"),
        "a file of its language beside a script": (
            Program((sys.executable, "-x", "engine.js"), folder),
            "helper.js",
        ),
        "an FMU": (Fmu(f"{folder}/model.fmu"), "model.fmu"),
        "a motion in a file": (MotionFiles(folder), "0f3a.csv"),
    }


@pytest.mark.parametrize(
    "kind",
    [
        "a program",
        "a script",
        "a package beside a script",
        "a file of its language beside a script",
        "an FMU",
        "a motion in a file",
    ],
)
def test_a_program_or_model_has_another_stamp_when_a_file_changes(kind, outside, tmp_path):
    function, name = outside[kind]
    before = engine_stamp(Engine("it", function))
    assert before is not None
    assert engine_stamp(Engine("it", function)) == before
    (tmp_path / name).write_text("after")
    assert engine_stamp(Engine("it", function)) != before


@pytest.mark.parametrize("command", [("python3", "-m", "mine"), ("no-such-program",)])
def test_a_program_whose_files_are_not_known_is_always_measured_again(command, tmp_path):
    assert engine_stamp(Engine("it", Program(command, str(tmp_path)))) is None


def test_environments_and_links_that_lead_back_are_left_out(tmp_path):
    (tmp_path / "back").symlink_to(tmp_path, target_is_directory=True)
    for folder in ("helpers", ".venv", "site-packages", "__pycache__"):
        (tmp_path / folder).mkdir()
        (tmp_path / folder / "module.py").touch()
    assert code_below([tmp_path]) == {tmp_path / "helpers" / "module.py"}


@pytest.mark.parametrize(
    "changed",
    ["reference_model/systems.py", "fmu_models/sources/contact.c", "compare/foreign/mujoco.json", "numpy"],
)
def test_any_source_and_any_library_changes_the_stamp(changed, tmp_path, monkeypatch):
    for package in PACKAGES:
        copytree(stamp.ROOT / package, tmp_path / package, ignore=ignore_patterns("__pycache__", "built"))
    before = stamp.stamp()
    monkeypatch.setattr(stamp, "ROOT", tmp_path)
    assert stamp.stamp() == before
    if changed == "numpy":
        right = stamp.version_of
        monkeypatch.setattr(stamp, "version_of", lambda name: "0" if name == changed else right(name))
    else:
        with open(tmp_path / changed, "a", encoding="utf-8") as stream:
            stream.write("\n")
        stamp._sources.cache_clear()  # a process has the code that it was started with
    assert stamp.stamp() != before


def test_the_stamp_knows_the_code_of_every_study_and_of_our_engines():
    own = {Path(sys.modules[one.function.__module__].__file__) for study in STUDIES for one in study.declared}
    assert all(path.is_relative_to(stamp.ROOT / "compare") for path in own)
    assert engine_stamp(reference) != engine_stamp(None) is not None
