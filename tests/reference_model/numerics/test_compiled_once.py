"""Of those that need a compiled function at once the first compiles it and the others wait; a terminal is told."""

import importlib
import os
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
    lock.touch()  # as if the other were not done yet
    found = []
    thread = threading.Thread(target=lambda: found.append(waiting(3.0)))
    thread.start()
    thread.join(5.0 * compiled_once.LOOK_AGAIN)
    away.rename(index)
    lock.unlink()
    thread.join()
    assert found == [1.5]
    assert sum(waiting.stats.cache_misses.values()) == 0


def test_a_lock_is_gone_after_a_failure_and_one_of_a_killed_process_is_taken_over(tmp_path):
    lock = tmp_path / "new" / "lock"

    def fail():
        with compiled_once._locked(lock):
            assert lock.exists()
            raise KeyError

    with pytest.raises(KeyError):
        fail()
    assert not lock.exists()
    lock.touch()
    long_ago = time.time() - 2.0 * compiled_once.ABANDONED
    os.utime(lock, (long_ago, long_ago))
    with compiled_once._locked(lock):
        assert time.time() - lock.stat().st_mtime < compiled_once.ABANDONED
    assert not lock.exists()


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
