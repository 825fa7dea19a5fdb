"""Cache of compiled functions on disk, keyed by their sources; one process compiles and the others load."""

import errno
import os
import subprocess
import sys
import threading
import time
from pathlib import Path

import numba
import numpy as np
import pytest

from reference_model.numerics import cache_folders, compiled_once

NAME = "a_package_of_a_test"
FACTOR = "FACTOR = {}\n"
KERNEL = f"""
from pathlib import Path
from reference_model.numerics.compiled_once import CompiledOnce
from {NAME}.factor import FACTOR

def scale(x):
    x[0] *= FACTOR

SCALE = CompiledOnce(scale, Path(__file__).parent)
"""
# Processes start faster without the __init__ of the reference.
BARE = f"""
import sys, types
reference = sys.modules["reference_model"] = types.ModuleType("reference_model")
reference.__path__ = [{str(Path(compiled_once.__file__).parents[1])!r}]
"""
RUN = f"""{BARE}
import numpy as np
from {NAME}.kernel import SCALE
SCALE(np.ones(1))
(dispatcher,) = SCALE.kinds.values()
print(sum(dispatcher.stats.cache_misses.values()))
"""
HOLDS_A_LOCK = f"""{BARE}
import time
from pathlib import Path
from reference_model.numerics.compiled_once import _locked
with _locked(Path(sys.argv[1])):
    print("held", flush=True)
    time.sleep(600.0)
"""


@pytest.fixture
def package(tmp_path, monkeypatch):
    """Return a package with a kernel that uses a factor from another file."""
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.setattr(sys, "dont_write_bytecode", True)
    monkeypatch.delenv("NUMBA_CACHE_DIR", raising=False)
    folder = tmp_path / NAME
    folder.mkdir()
    (folder / "__init__.py").touch()
    (folder / "factor.py").write_text(FACTOR.format(2.0))
    (folder / "kernel.py").write_text(KERNEL)
    return folder


def run():
    """Return the factor, and the numbers of kernels loaded and compiled, as in a new process."""
    for known in (cache_folders.digest_of, cache_folders.folder_of):
        known.cache_clear()
    for name in [name for name in sys.modules if name.startswith(NAME)]:
        del sys.modules[name]
    scale = __import__(f"{NAME}.kernel", fromlist=["SCALE"]).SCALE
    x = np.ones(1)
    scale(x)
    (dispatcher,) = scale.kinds.values()
    return x[0], sum(dispatcher.stats.cache_hits.values()), sum(dispatcher.stats.cache_misses.values())


def test_a_kernel_is_compiled_again_if_another_file_of_its_package_changes(package):
    assert run() == (2.0, 0, 1)
    (package / "factor.py").write_text(FACTOR.format(3.0))
    assert run() == (3.0, 0, 1)
    (package / "factor.py").write_text(FACTOR.format(2.0))
    assert run() == (2.0, 1, 0)


def test_one_of_several_simultaneous_processes_compiles_and_the_others_load(package):
    around = {**os.environ, "PYTHONDONTWRITEBYTECODE": "1", "PYTHONPATH": str(package.parent)}
    around.pop("NUMBA_CACHE_DIR", None)
    command, pipe = [sys.executable, "-c", RUN], subprocess.PIPE
    processes = [subprocess.Popen(command, env=around, stdout=pipe, text=True) for _ in range(2)]
    assert sorted(process.communicate()[0] for process in processes) == ["0\n", "1\n"]


def test_kernels_of_a_read_only_package_are_kept_in_the_cache_of_the_user(package, tmp_path, monkeypatch):
    (package / "__pycache__").touch()  # no folder can be made in it, whoever runs the test
    for variable in ("HOME", "USERPROFILE"):
        monkeypatch.setenv(variable, str(tmp_path / "home"))
    assert [run(), run()] == [(2.0, 0, 1), (2.0, 1, 0)]
    assert list((tmp_path / "home" / ".cache" / "friction-discs").rglob("*.nbi"))


def test_kernel_runs_if_no_cache_can_be_written(package, tmp_path, monkeypatch):
    (tmp_path / "file").touch()
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path / "file"))
    assert run() == (2.0, 0, 1)


def test_long_compilation_is_reported_in_one_line(package, monkeypatch, capsys):
    monkeypatch.setattr(compiled_once, "LONG", 0.0)
    monkeypatch.setattr(compiled_once, "_announced", threading.Lock())
    for factor in (2.0, 3.0):
        (package / "factor.py").write_text(FACTOR.format(factor))
        run()
    errors = capsys.readouterr().err
    assert errors.count("Compiling for this machine") == len(errors.splitlines()) == 1


def test_cache_directory_of_numba_does_not_change(package, tmp_path, monkeypatch):
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path))
    before = numba.config.CACHE_DIR
    run()
    assert before == numba.config.CACHE_DIR
    assert list(tmp_path.glob(f"{NAME}-*/**/*.nbi"))


@pytest.mark.parametrize(
    ("days", "kept"),
    [((0.1, 0.3, 0.6, 0.9, 1.2, 1.5), 4), ((10.0, 11.0, 12.0, 13.0, 14.0), cache_folders.VERSIONS - 1)],
    ids=["used during the last day", "the newest"],
)
def test_versions_of_the_sources_that_were_not_used_recently_are_deleted(days, kept, tmp_path, monkeypatch):
    package = tmp_path / "package"
    package.mkdir()
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path))
    for age in days:
        old = tmp_path / f"package-{age}"
        old.mkdir()
        last = time.time() - 86_400.0 * age
        os.utime(old, (last, last))
    now = Path(cache_folders.folder_of(package, cache_folders.digest_of(package)))
    expected = {now.name, *(f"package-{age}" for age in days[:kept])}
    assert {path.name for path in tmp_path.glob("package-*")} == expected


def test_lock_is_released_by_an_exception_and_by_a_killed_process(tmp_path):
    lock = tmp_path / "lock"
    with pytest.raises(KeyError), compiled_once._locked(lock):
        raise KeyError
    arguments = [sys.executable, "-c", HOLDS_A_LOCK, str(lock)]
    with subprocess.Popen(arguments, stdout=subprocess.PIPE) as owner:
        assert owner.stdout.readline() == b"held\n"
        owner.kill()
    began = time.monotonic()
    with compiled_once._locked(lock):
        assert time.monotonic() - began < 1.0


@pytest.mark.parametrize(
    "damaged", [lambda old: b"", lambda old: old[:-9], lambda old: old[:40] + b"?" + old[41:]]
)
@pytest.mark.parametrize("ending", ["nbi", "nbc"])
def test_a_damaged_file_is_named_and_compiled_again(damaged, ending, package, capsys):
    assert run() == (2.0, 0, 1)
    (file,) = package.rglob(f"*.{ending}")
    file.write_bytes(damaged(file.read_bytes()))
    assert run()[::2] == (2.0, 1)
    assert f"{str(file)!r} is damaged" in capsys.readouterr().err
    assert run() == (2.0, 1, 0)
    assert capsys.readouterr().err == ""


def test_a_kernel_runs_without_a_cache_on_a_full_disk(package, monkeypatch, capsys):
    def full(self, name, data):
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr("numba.core.caching.IndexDataCacheFile._save_data", full)
    assert run()[0] == 2.0
    said = capsys.readouterr().err
    assert said.startswith(f"Cannot use the compiled functions in '{package}")
    assert "No space left on device" in said


SOURCE = '''
BOUND = {bound}

def double(x):
    """{sentence}"""
    return 2.0 * min(x, BOUND)
'''


def test_digest_of_functions_changes_with_their_text_and_constants_only():
    def digest(bound=1.0, sentence="Return twice x.", change=("", "")):
        namespace = {}
        exec(SOURCE.format(bound=bound, sentence=sentence).replace(*change), namespace)
        return cache_folders.digest_of_text([namespace["double"]])

    assert digest() == digest(sentence="Return 2x.") == digest(change=("def", "# a comment\n\ndef"))
    assert (
        len({digest(), digest(bound=2.0), digest(change=("2.0", "3.0")), digest(change=("min", "max"))}) == 4
    )


def test_a_kernel_with_a_digest_of_its_own_is_loaded_after_an_edit_elsewhere(package):
    kernel = package / "kernel.py"
    kernel.write_text(KERNEL.replace("Path(__file__).parent)", "Path(__file__).parent, 'digest')"))
    assert run() == (2.0, 0, 1)
    kernel.write_text("# edited\n" + kernel.read_text())
    assert run() == (2.0, 1, 0)
