"""What numba has compiled is taken from disk as long as all that it was compiled from is the same."""

import gc
import importlib
import os
import sys
from concurrent.futures import ThreadPoolExecutor
from time import sleep

import pytest

from reference_model.ensemble.disc import kernel
from reference_model.ensemble.pin import driver
from reference_model.numerics import compiled_cache

HEAD = """
import numba
from reference_model.numerics.compiled_cache import known_by_content

def kept(function):
    dispatcher = numba.njit(cache=True)(function)
    known_by_content(dispatcher)
    return dispatcher
"""

SOURCES = {
    "__init__.py": "",
    "head.py": HEAD,
    "constant.py": "VALUE = 3.0\n",
    "called.py": "from keeping.constant import VALUE\nfrom .head import kept\n\n"
    "@kept\ndef value():\n    return VALUE\n",
    "caller.py": "import keeping.called as called\nfrom keeping.head import kept\nvalue = called.value\n\n"
    "@kept\ndef twice():\n    return 2.0 * value()\n",
    "other.py": "UNUSED = 1\n",
}


def forget():
    """Let all files be read again."""
    for function in (compiled_cache._digest, compiled_cache._source, compiled_cache._imports):
        function.cache_clear()


@pytest.fixture
def run(tmp_path, monkeypatch):
    """Return a function that imports the package as a new process would and returns the result, and cache hits."""
    folder = tmp_path / "keeping"
    folder.mkdir()
    for name, text in SOURCES.items():
        (folder / name).write_text(text)
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.setattr(sys, "dont_write_bytecode", True)

    def run(changes=(), time=None):
        for name, text in dict(changes).items():
            (folder / name).write_text(text)
        if time is not None:
            for path in folder.glob("*.py"):
                os.utime(path, (time, time))
        for name in [name for name in sys.modules if name.partition(".")[0] == "keeping"]:
            del sys.modules[name]
        forget()
        importlib.invalidate_caches()
        twice = importlib.import_module("keeping.caller").twice
        importlib.import_module("keeping.other")
        return twice(), sum(twice.stats.cache_hits.values())

    yield run
    for name in [name for name in sys.modules if name.partition(".")[0] == "keeping"]:
        del sys.modules[name]


@pytest.mark.parametrize("time", [None, 1.0, 4e9], ids=["at once", "long ago", "in the future"])
def test_a_function_follows_a_change_in_any_module_that_it_is_made_of_whatever_the_time_of_the_file(
    run, time
):
    assert run(time=time) == (6.0, 0)
    assert run({"constant.py": "VALUE = 4.0\n"}, time) == (8.0, 0)
    longer = SOURCES["called.py"].replace("return VALUE", "return VALUE + 1.0")
    assert run({"called.py": longer}, time) == (10.0, 0)
    assert run({"caller.py": SOURCES["caller.py"].replace("2.0", "3.0")}, time) == (15.0, 0)


def test_a_function_is_not_compiled_again_for_new_times_or_what_it_does_not_use(run):
    assert run() == (6.0, 0)
    for time in (None, 1.0, 4e9):
        assert run(time=time) == (6.0, 1)
    assert run({"other.py": "UNUSED = 22\n"}) == (6.0, 1)
    assert run(SOURCES) == (6.0, 1)


@pytest.fixture
def hurried():
    """Let another thread have its turn when garbage is collected, which Python before 3.12 does while it parses."""

    def turn(phase, info):
        sleep(0)

    often = gc.get_threshold()
    gc.callbacks.append(turn)
    gc.set_threshold(200)
    yield
    gc.set_threshold(*often)
    gc.callbacks.remove(turn)


def test_threads_read_sources_at_once(hurried):
    modules = kernel.__name__, driver.__name__
    expected = [compiled_cache.sources_digest(module) for module in modules]
    forget()
    with ThreadPoolExecutor(len(modules)) as threads:
        assert list(threads.map(compiled_cache.sources_digest, modules)) == expected
    forget()
