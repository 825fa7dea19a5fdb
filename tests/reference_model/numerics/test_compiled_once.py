"""Of those that need a compiled function at once the first compiles it and the others wait; a terminal is told."""

import importlib
import subprocess
import sys
import threading
import time
from pathlib import Path

import pytest

from reference_model.numerics import compiled_once
from reference_model.numerics.compiled_once import Kept


@pytest.fixture
def function(tmp_path, monkeypatch):
    """Return a function of a module with an empty cache."""
    (tmp_path / "kept_for_a_test.py").write_text("def half(x):\n    return 0.5 * x\n")
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.delitem(sys.modules, "kept_for_a_test", raising=False)
    return importlib.import_module("kept_for_a_test").half


def test_who_needs_what_another_process_compiles_waits_and_loads_it(function):
    other, waiting = Kept(function), Kept(function)
    assert other(3.0) == 1.5
    index = Path(other._cache._cache_file._index_path)
    away, lock = index.with_suffix(".away"), index.with_suffix(".nbi.lock")
    index.rename(away)
    found = []
    thread = threading.Thread(target=lambda: found.append(waiting(3.0)))
    with compiled_once._locked(lock):  # as if the other were not done yet
        thread.start()
        thread.join(0.3)
        away.rename(index)
    thread.join()
    assert found == [1.5]
    assert sum(waiting.stats.cache_misses.values()) == 0


HOLDS_A_LOCK = """
import sys, time
from pathlib import Path
from reference_model.numerics.compiled_once import _locked
with _locked(Path(sys.argv[1])):
    print("held", flush=True)
    time.sleep(600.0)
"""


def test_a_lock_ends_with_a_failure_and_with_a_process_that_is_killed(tmp_path):
    lock = tmp_path / "new" / "lock"
    with pytest.raises(KeyError), compiled_once._locked(lock):
        raise KeyError
    arguments = [sys.executable, "-c", HOLDS_A_LOCK, str(lock)]
    with subprocess.Popen(arguments, stdout=subprocess.PIPE) as owner:
        owner.stdout.readline()
        owner.kill()
    began = time.monotonic()
    with compiled_once._locked(lock):
        assert time.monotonic() - began < 1.0


def test_where_no_lock_can_be_it_is_done_without(tmp_path):
    (tmp_path / "file").touch()
    with compiled_once._locked(tmp_path / "file" / "lock"):
        pass


def test_a_terminal_is_told_once_where_it_is_kept(function, monkeypatch, capsys):
    monkeypatch.setattr(compiled_once, "_told_already", threading.Lock())
    monkeypatch.setattr(compiled_once, "LONG", 0.0)
    Kept(function)(1.0)
    assert capsys.readouterr().err == ""  # no terminal
    monkeypatch.setattr(sys.stderr, "isatty", lambda: True)
    for number in (1, 1j):
        Kept(function)(number)
    told = capsys.readouterr().err
    assert told.count("Compiling") == 1
    assert str(Kept(function)._cache.cache_path) in told
