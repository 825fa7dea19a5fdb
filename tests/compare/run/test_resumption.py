"""Stamps of findings change with sources, libraries and the engine's own files."""

import importlib
import sys
from importlib.machinery import EXTENSION_SUFFIXES
from shutil import copytree, ignore_patterns

import pytest

from compare.engines import ByName, Engine, reference
from compare.engines.outside.fmu import Fmu
from compare.engines.outside.motion_files import MotionFiles
from compare.engines.outside.program import Program, code_below
from compare.run import provenance as stamp
from compare.run.provenance import PACKAGES, engine_stamp


@pytest.fixture
def code(tmp_path, monkeypatch):
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


def stamp_of(module, *promises, folder=""):
    return engine_stamp(Engine("mine", ByName(module, "simulate", str(folder)), *promises))


CHANGED = {
    "the module itself": ("mine", "mine.py"),
    "a module beside it": ("mine", "settings.py"),
    "a module of a package beside it": ("mine", "helpers/deep/numbers_of_mine.py"),
    "another module of its package": ("package.inner.solver", "package/deep/settings.py"),
    "a compiled extension beside it": ("mine", f"kernel{EXTENSION_SUFFIXES[0]}"),
}


@pytest.mark.parametrize(("module", "changed"), CHANGED.values(), ids=CHANGED)
def test_the_stamp_changes_with_the_engines_module_and_its_neighbours(module, changed, code):
    own = f"{module.replace('.', '/')}.py"
    stamps = []
    for text in ("FACTOR = 1", "FACTOR = 1", "FACTOR = 2"):
        code({own: "from settings import FACTOR\ndef simulate(): pass\n"} | {changed: text})
        stamps.append(stamp_of(module))
    assert None not in stamps
    assert stamps[0] == stamps[1] != stamps[2]


def test_the_stamp_changes_with_the_engines_promises(code):
    code({"mine.py": "def simulate(): pass"})
    promises = ((("pin",), True), (("pin",), True), (("pin", "ring"), True), (("pin", "ring"), False))
    one, same, *others = (stamp_of("mine", *each) for each in promises)
    assert one == same
    assert len({one, *others}) == 3


@pytest.mark.parametrize("module", ["bad", "bad.inner", "bad_package.inner"])
def test_the_modules_of_an_engine_are_not_imported_for_its_stamp(module, code):
    folder = code({"bad.py": "raise SystemExit", "bad_package/__init__.py": "raise SystemExit"})
    before = list(sys.path)
    assert stamp_of(module, folder=folder) is not None
    assert sys.path == before
    assert "bad" not in sys.modules


def test_the_stamp_of_an_installed_module_contains_its_file_and_all_versions(tmp_path, monkeypatch):
    site = tmp_path / "site-packages"
    (metadata := site / "helper-1.0.dist-info").mkdir(parents=True)
    monkeypatch.syspath_prepend(site)
    monkeypatch.setattr(stamp, "_installed", stamp._installed.__wrapped__)  # one process for each version

    def now(own="", other="", version="1.0"):
        (site / "installed.py").write_text(own)
        (site / "another.py").write_text(other)
        (metadata / "METADATA").write_text(f"Metadata-Version: 2.1\nName: helper\nVersion: {version}\n")
        return stamp_of("installed")

    assert now() == now(other="# of another package")
    assert len({now(), now(own="# changed"), now(version="1.1")}) == 3


OUTSIDE = {
    "a program": (lambda folder: Program(("./engine", "1"), folder), "engine"),
    "a script": (lambda folder: Program((sys.executable, "engine.py"), folder), "engine.py"),
    "a package beside a script": (lambda folder: Program(("./engine.py",), folder), "helpers/helper.py"),
    "a file of its language beside a script": (
        lambda folder: Program((sys.executable, "-x", "engine.js"), folder),
        "helper.js",
    ),
    "an FMU": (lambda folder: Fmu(f"{folder}/model.fmu"), "model.fmu"),
    "a motion in a file": (MotionFiles, "0f3a.csv"),
}
"""Foreign engines by kind, with the file to change."""


@pytest.mark.parametrize(("function", "changed"), OUTSIDE.values(), ids=OUTSIDE)
def test_the_stamp_of_a_program_or_model_changes_with_its_files(function, changed, tmp_path):
    (tmp_path / "helpers").mkdir()
    for name in ("engine.js", "engine.py", "engine", "plan.json", *(file for _, file in OUTSIDE.values())):
        (tmp_path / name).write_text("before")
    engine = Engine("it", function(str(tmp_path)))
    before = engine_stamp(engine)
    assert before is not None
    assert engine_stamp(engine) == before
    (tmp_path / changed).write_text("after")
    assert engine_stamp(engine) != before


def test_an_engine_with_unknown_files_has_no_stamp_so_it_is_always_measured_again(tmp_path):
    for command in (("python3", "-m", "mine"), ("no-such-program",)):
        assert engine_stamp(Engine("it", Program(command, str(tmp_path)))) is None
    typed = {}
    exec("def simulate(): pass", typed | {"__name__": "session"}, typed)
    assert engine_stamp(Engine("mine", typed["simulate"])) is None


def test_environments_and_cyclic_links_are_left_out(tmp_path):
    (tmp_path / "back").symlink_to(tmp_path, target_is_directory=True)
    for folder in ("helpers", ".venv", "site-packages", "__pycache__"):
        (tmp_path / folder).mkdir()
        (tmp_path / folder / "module.py").touch()
    assert code_below([tmp_path]) == {tmp_path / "helpers" / "module.py"}


def test_any_source_and_any_library_changes_the_stamp(tmp_path, monkeypatch):
    for package in PACKAGES:
        copytree(stamp.ROOT / package, tmp_path / package, ignore=ignore_patterns("__pycache__", "built"))
    before = stamp.stamp()
    monkeypatch.setattr(stamp, "ROOT", tmp_path)
    assert stamp.stamp() == before
    stamps = {before}
    for changed in (
        "reference_model/systems/__init__.py",
        "fmu_models/sources/contact.c",
        "compare/foreign/mujoco.json",
    ):
        with open(tmp_path / changed, "a", encoding="utf-8") as stream:
            stream.write("\n")
        assert stamp.stamp() in stamps  # a process keeps the code it started with
        stamp._sources.cache_clear()
        stamps.add(stamp.stamp())
    right = stamp.version_of
    monkeypatch.setattr(stamp, "version_of", lambda name: "0" if name == "numpy" else right(name))
    assert len({*stamps, stamp.stamp()}) == 5


def test_the_stamp_of_our_engines_is_not_that_of_a_study():
    assert engine_stamp(reference) != engine_stamp(None) is not None
