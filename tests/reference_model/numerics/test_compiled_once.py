"""Cache of compiled functions on disk, keyed by their sources; one process compiles and the others load."""

import os
import subprocess
import sys
import time
from pathlib import Path

import numba
import pytest

from reference_model.numerics import compiled_once

FACTOR = "FACTOR = {}\n"
KERNEL = """
from pathlib import Path
from reference_model.numerics.compiled_once import CompiledOnce
from a_package_of_a_test.factor import FACTOR

def scale(x):
    x[0] *= FACTOR

SCALE = CompiledOnce(scale, Path(__file__).parent)
"""
RUN = """
import numpy as np
from a_package_of_a_test.kernel import SCALE
from reference_model.numerics import compiled_once
compiled_once.LONG = {long}
x = np.ones(1)
SCALE(x)
(dispatcher,) = SCALE.kinds.values()
print(x[0], sum(dispatcher.stats.cache_hits.values()), sum(dispatcher.stats.cache_misses.values()))
"""


@pytest.fixture
def package(tmp_path):
    """Return a package with a kernel that uses a factor from another file."""
    folder = tmp_path / "a_package_of_a_test"
    folder.mkdir()
    (folder / "__init__.py").touch()
    (folder / "factor.py").write_text(FACTOR.format(2.0))
    (folder / "kernel.py").write_text(KERNEL)
    return folder


def start(package, long=600.0, **environment):
    around = {**os.environ, "PYTHONDONTWRITEBYTECODE": "1", "PYTHONPATH": str(package.parent)}
    around.pop("NUMBA_CACHE_DIR", None)
    return subprocess.Popen(
        [sys.executable, "-c", RUN.format(long=long)],
        env={**around, **environment},
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )


def printed(process):
    """Return the factor, whether the process loaded the kernel, and whether it compiled the kernel."""
    output, errors = process.communicate()
    assert process.returncode == 0, errors
    assert errors == ""
    factor, loaded, made = output.split()
    return float(factor), loaded == "1", made == "1"


def test_a_kernel_is_compiled_again_if_another_file_of_its_package_changes(package):
    assert printed(start(package)) == (2.0, False, True)
    (package / "factor.py").write_text(FACTOR.format(3.0))
    assert printed(start(package)) == (3.0, False, True)
    (package / "factor.py").write_text(FACTOR.format(2.0))
    assert printed(start(package)) == (2.0, True, False)


def test_one_of_several_simultaneous_processes_compiles_and_the_others_load(package):
    runs = [printed(each) for each in [start(package) for _ in range(2)]]
    assert sorted(runs) == [(2.0, False, True), (2.0, True, False)]


def test_kernels_of_a_read_only_package_are_kept_in_the_cache_of_the_user(package, tmp_path):
    (package / "__pycache__").touch()  # no folder can be made in it, whoever runs the test
    home = {"HOME": str(tmp_path / "home"), "USERPROFILE": str(tmp_path / "home")}
    for expected in ((2.0, False, True), (2.0, True, False)):
        assert printed(start(package, **home)) == expected
    assert list((tmp_path / "home" / ".cache" / "friction-discs").rglob("*.nbi"))


def test_kernel_runs_if_no_cache_can_be_written(package, tmp_path):
    (tmp_path / "file").touch()
    run = start(package, NUMBA_CACHE_DIR=str(tmp_path / "file"))
    assert printed(run) == (2.0, False, True)


def test_long_compilation_is_reported_in_one_line(package):
    _, errors = start(package, long=0.0).communicate()
    assert errors.count("Compiling for this machine") == len(errors.splitlines()) == 1


def test_cache_directory_of_numba_does_not_change(package, tmp_path, monkeypatch):
    def fill(x):
        x[0] = 1.0

    monkeypatch.setattr(numba.config, "CACHE_DIR", str(tmp_path))
    compiled_once.compiled_for((numba.float64[::1],), fill, package)
    assert str(tmp_path) == numba.config.CACHE_DIR
    assert list(tmp_path.glob(f"{package.name}-*/**/*.nbi"))


@pytest.mark.parametrize(
    ("days", "kept"),
    [((0.1, 0.3, 0.6, 0.9, 1.2, 1.5), 4), ((10.0, 11.0, 12.0, 13.0, 14.0), compiled_once.VERSIONS - 1)],
    ids=["used during the last day", "the newest"],
)
def test_versions_of_the_sources_that_were_not_used_recently_are_deleted(days, kept, tmp_path, monkeypatch):
    package = tmp_path / "package"
    package.mkdir()
    monkeypatch.setattr(numba.config, "CACHE_DIR", str(tmp_path))
    for age in days:
        old = tmp_path / f"package-{age}"
        old.mkdir()
        last = time.time() - 86_400.0 * age
        os.utime(old, (last, last))
    now = Path(compiled_once.folder_of(package))
    expected = {now.name, *(f"package-{age}" for age in days[:kept])}
    assert {path.name for path in tmp_path.glob("package-*")} == expected


HOLDS_A_LOCK = """
import sys, time
from pathlib import Path
from reference_model.numerics.compiled_once import _locked
with _locked(Path(sys.argv[1])):
    print("held", flush=True)
    time.sleep(600.0)
"""


def test_lock_is_released_by_an_exception_and_by_a_killed_process(tmp_path):
    lock = tmp_path / "lock"
    with pytest.raises(KeyError), compiled_once._locked(lock):
        raise KeyError
    arguments = [sys.executable, "-c", HOLDS_A_LOCK, str(lock)]
    with subprocess.Popen(arguments, stdout=subprocess.PIPE) as owner:
        owner.stdout.readline()
        owner.kill()
    began = time.monotonic()
    with compiled_once._locked(lock):
        assert time.monotonic() - began < 1.0
