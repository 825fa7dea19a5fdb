"""Machine code that was made beforehand: the same bits at all levels as code compiled here, and found by content."""

import math
import subprocess
import sys
from typing import NamedTuple

import numpy as np
import pytest

from reference_model.numerics import compiled_cache, machine_code
from reference_model.numerics.compiled_ahead import compile_ahead
from reference_model.numerics.compiled_once import Kept
from reference_model.numerics.machine_code import LEVELS, MachineCode, kind_of, levels_here


class Work(NamedTuple):
    """As a task of a kernel is."""

    values: np.ndarray
    shift: float


def turn(work, backwards, times, found):
    """Do what kernels do: loops for vectors, roots and quotients, the C library, room for arrays in other shapes."""
    room = np.zeros(6).reshape(2, 3)
    for _ in range(times):
        for i in range(16):
            x = work.values[0, i] * work.shift + 0.1
            room[0, 0] += math.sqrt(abs(x)) / (1.0 + x * x)
            found[i] += x / math.sqrt(1.0 + x * x) + work.values[1, i] * x
        room[1, 2] += math.hypot(room[0, 0], 1.0) + math.atan2(room[0, 0], 2.0)
    found[16] = -room[1, 2] if backwards else room[1, 2]


def arguments():
    values = np.random.default_rng(0).normal(size=(2, 16))
    return Work(values, 0.7), True, 3, np.zeros(17)


@pytest.fixture(scope="module")
def files(tmp_path_factory):
    """Return the files of ``turn`` by level."""
    with pytest.MonkeyPatch.context() as patch:
        folder = tmp_path_factory.mktemp("built")
        patch.setattr(machine_code, "_folder", lambda function: folder)
        return dict(zip(LEVELS, compile_ahead(turn, arguments(), tuple(LEVELS)), strict=True))


@pytest.fixture
def built(files, monkeypatch):
    """Let ``turn``'s machine code be where that of a kernel is."""
    folder = files["x86-64-v3"].parents[1]
    monkeypatch.setattr(machine_code, "_folder", lambda function: folder)
    return folder


def test_all_levels_of_this_processor_give_the_bits_of_what_is_compiled_here(files):
    here = arguments()
    Kept(turn, targetoptions={"error_model": "numpy"})(*here)
    assert here[3][16] != 0.0
    assert levels_here()
    for level in levels_here():
        found = arguments()
        MachineCode(files[level], "turn")(*found)
        np.testing.assert_array_equal(found[3], here[3])


def test_it_runs_without_numba(files):
    script = f"""
import sys
sys.modules["numba"] = None
import numpy as np
from reference_model.numerics.machine_code import MachineCode
found = np.zeros(17)
MachineCode({str(files[levels_here()[-1]])!r}, "turn")((np.ones((2, 16)), 0.7), True, 3, found)
print(found[0])
"""
    run = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    x = 0.8
    assert float(run.stdout) == pytest.approx(3.0 * (x / math.sqrt(1.0 + x * x) + x), rel=1e-15)


def test_it_is_found_for_arguments_of_its_kind_and_no_others(built):
    work, backwards, times, found = arguments()
    kind = kind_of((work, backwards, times, found))
    assert machine_code.machine_code(turn, kind) is not None
    fortran = Work(np.asfortranarray(work.values), work.shift)
    others = [
        (fortran, backwards, times, found),
        (work, backwards, times, found.astype(np.float32)),
        (work, backwards, float(times), found),
        (tuple(work), backwards, times, found),
        (work, 1, times, found),
        (work, backwards, times, found[np.newaxis]),
    ]
    read_only = found.copy()
    read_only.flags.writeable = False
    for arguments_ in [*others, (work, backwards, times, read_only)]:
        assert kind_of(arguments_) != kind
        assert machine_code.machine_code(turn, kind_of(arguments_)) is None


def test_it_is_not_taken_when_sources_change_or_another_processor_is_meant(built, monkeypatch):
    kind = kind_of(arguments())
    monkeypatch.setattr(machine_code, "sources_digest", lambda module: "changed")
    assert machine_code.machine_code(turn, kind) is None
    monkeypatch.setattr(machine_code, "sources_digest", compiled_cache.sources_digest)
    assert machine_code.machine_code(turn, kind) is not None
    monkeypatch.setattr(machine_code, "_maker", lambda: "changed")
    assert machine_code.machine_code(turn, kind) is None
    monkeypatch.undo()
    levels_here.cache_clear()
    monkeypatch.setenv("NUMBA_CPU_NAME", "generic")
    assert levels_here() == ()
    monkeypatch.undo()
    levels_here.cache_clear()
    monkeypatch.setattr(machine_code.binding, "get_host_cpu_features", lambda: {"avx": True, "avx2": True})
    assert levels_here() == ()
    levels_here.cache_clear()


def test_what_was_made_of_other_sources_goes_and_what_is_there_stays(built):
    levels = levels_here()[-1:]
    (file,) = compile_ahead(turn, arguments(), levels)
    written = file.stat().st_mtime_ns
    assert list(compile_ahead(turn, arguments(), levels)) == [file]
    assert file.stat().st_mtime_ns == written
    file.rename(file.with_name("turn-0000000000000000.o"))
    assert list(compile_ahead(turn, arguments(), levels)) == [file]
    assert list(file.parent.iterdir()) == [file]
