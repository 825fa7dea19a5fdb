"""Kills, damage and resumption in any order."""

import shutil
import tempfile
from contextlib import suppress
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, Phase, settings
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, initialize, rule
from long_sweeps import assert_same, content, silent

from compare.claims.parameters import FIG5
from compare.sweep.compute.executors import InProcess
from compare.sweep.compute.run import finished, run
from compare.sweep.compute.work import Plain, simulate_chunk
from compare.sweep.plan import Basin
from compare.sweep.quantities import Axis
from compare.sweep.store import SweepStore
from reference_model.ensemble import EndState

X, Y = Axis("x", -0.3, 0.5, 5), Axis("vx", -0.4, 0.4, 5)
PLAN = Basin(
    system=FIG5, duration=300.0, tolerance=1e-6, seed=1, start=(0.1, 0.0, 0.03, 0.0), x=X, y=Y, coarse=3
)
"""Plan with several rounds of several chunks."""

CHUNK = 5


class Counting(InProcess):
    """Counts simulated chunks; stops after some tasks."""

    def __init__(self, tasks=10**9):
        self.left, self.simulated = tasks, 0

    def run(self, tasks):
        for task in tasks:
            if self.left == 0:
                raise KeyboardInterrupt
            self.left -= 1
            self.simulated += task.function is simulate_chunk
            yield task.key, task.function(*task.arguments)


class Store(RuleBasedStateMachine):
    whole = None

    @initialize()
    def begin(self):
        self.folder = Path(tempfile.mkdtemp())
        SweepStore.create(self.folder / "sweep.zarr", PLAN, CHUNK)
        if Store.whole is None:
            SweepStore.create(self.folder / "whole.zarr", PLAN, CHUNK)
            run(SweepStore.open(self.folder / "whole.zarr"), InProcess(), silent)
            Store.whole = content(self.folder / "whole.zarr")
            assert ("round-1", "end") in Store.whole

    def files(self):
        """Return all files but the description, which is needed to open the store."""
        found = sorted(path for path in (self.folder / "sweep.zarr").rglob("*") if path.is_file())
        return [path for path in found if path != self.folder / "sweep.zarr" / "zarr.json"]

    @rule(tasks=st.integers(1, 12))
    def work_and_be_killed(self, tasks):
        with suppress(KeyboardInterrupt):
            run(SweepStore.open(self.folder / "sweep.zarr"), Counting(tasks), silent)

    @rule(data=st.data())
    def lose_a_file(self, data):
        if files := self.files():
            data.draw(st.sampled_from(files)).unlink()

    @rule(data=st.data(), share=st.floats(0.0, 0.99))
    def cut_a_file(self, data, share):
        if files := self.files():
            path = data.draw(st.sampled_from(files))
            path.write_bytes(path.read_bytes()[: int(share * path.stat().st_size)])

    @rule(data=st.data(), place=st.floats(0.0, 0.999), bit=st.integers(0, 7))
    def flip_a_bit(self, data, place, bit):
        if files := self.files():
            path = data.draw(st.sampled_from(files))
            damaged = bytearray(path.read_bytes())
            if damaged:
                damaged[int(place * len(damaged))] ^= 1 << bit
                path.write_bytes(damaged)
                if finished(SweepStore.open(self.folder / "sweep.zarr")):
                    pytest.fail(f"a bit of {path} is another one, and nobody tells")

    @rule()
    def resume(self):
        for again in (False, True):
            run(SweepStore.open(self.folder / "sweep.zarr"), counting := Counting(), silent)
            assert not (again and counting.simulated)
        assert finished(SweepStore.open(self.folder / "sweep.zarr"))
        assert_same(content(self.folder / "sweep.zarr"), Store.whole)

    def teardown(self):
        if hasattr(self, "folder"):
            self.resume()
            shutil.rmtree(self.folder)


Store.TestCase.settings = settings(
    max_examples=3,
    stateful_step_count=6,
    deadline=None,
    suppress_health_check=list(HealthCheck),
    phases=(Phase.reuse, Phase.generate),  # shrinking an example takes minutes
)


@pytest.mark.usefixtures("no_reference")
class TestStore(Store.TestCase):
    pass


@pytest.fixture
def no_reference(monkeypatch):
    same = Plain(end=EndState.WHIRL, state=np.zeros(4))
    monkeypatch.setattr("compare.sweep.compute.run.recompute", lambda *arguments: same)
