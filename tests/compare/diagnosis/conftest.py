import sys

import pytest

from compare.run.workers import Done, attempted


class Here:
    """Workers that work in this process, which need no start."""

    def __init__(self, jobs, limit=None):
        self.work = []

    def __enter__(self):
        return self

    def __exit__(self, *_):
        pass

    def submit(self, key, *call, owner=""):
        self.work.append((key, call))

    def finished(self):
        yield from (Done(key, attempted(*call), 0.0) for key, call in self.work)

    def ask(self, *call, owner=""):
        return attempted(*call)


@pytest.fixture
def in_this_process(monkeypatch):
    """Replace workers, and forget modules that a test imports."""
    for place in ("compare.run.workers.Workers", "compare.diagnosis.run.Workers"):
        monkeypatch.setattr(place, Here)
    monkeypatch.setattr(sys, "path", list(sys.path))
    yield
    for name in ("of_simulate", "refusing", "broken"):
        sys.modules.pop(name, None)
