"""Stores of findings and drawings return the last stored content or nothing, even if files are damaged."""

import json
import shutil
import tempfile
from pathlib import Path

import numpy as np
import pytest
from fake_studies import GOOD, claim, measure_verdicts
from hypothesis import settings
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, rule

from compare.claims.as_json import claim_as_json
from compare.claims.study import Findings
from compare.run.store import Drawing, DrawingStore, Store

KEYS = [
    ("fig03", "exec:./a.b"),
    ("fig03", "exec:./a_b"),
    ("fig03", "exec:./A_b"),
    ("fig03", "exec:./ä_b"),
    ("fig03", "exec:./\udce4_b"),
    ("fig03--exec", "./a_b"),
    ("fig03", 100 * "exec:a"),
    ("fig03", 101 * "exec:a"),
]
"""Similar and long names of engines."""

UNUSUAL = claim(
    "c", "good", [0.0, np.inf], [np.nan, -np.inf], np.inf, parameters={"a": np.float64(1.0), "n": 3}
)
FOUND = (
    Findings((UNUSUAL,), {"half": np.array([0.5]), "both": np.zeros((1, 2))}),
    measure_verdicts(GOOD),
    Findings(not_simulated="no ring"),
)
DRAWN = (Drawing({"radius": b"<svg/>", "spin": b""}, {"motion": bytes(range(99))}), Drawing())


class OfFindings:
    keys, values, stamps = KEYS, FOUND, ("now", "then", None)

    def __init__(self, folder):
        self.store = Store(folder)

    def keep(self, key, stamp, value):
        self.store.keep(*key, stamp, value, float(len(value.claims)))

    def find(self, key, stamp):
        found = self.store.find(*key, stamp)
        return found and self.told(*found)

    def told(self, value, seconds=None):
        seconds = float(len(value.claims)) if seconds is None else seconds
        arrays = {name: (array.dtype.str, array.tolist()) for name, array in value.data.items()}
        return json.dumps([[*map(claim_as_json, value.claims)], arrays, value.not_simulated, seconds])


class OfDrawings:
    keys, values, stamps = ("fig03", "fig04"), DRAWN, ("now", "then")

    def __init__(self, folder):
        self.store = DrawingStore(folder)

    def keep(self, key, stamp, value):
        self.store.keep(key, stamp, value)

    def find(self, key, stamp):
        return self.store.find(key, stamp, ("radius", "spin", "motion"))

    def told(self, value):
        return value


class Stores(RuleBasedStateMachine):
    """Stores, damages and finds, compared with a dictionary."""

    kind = None

    def __init__(self):
        super().__init__()
        self.folder = Path(tempfile.mkdtemp())
        self.store, self.kept, self.files, self.damaged = self.kind(self.folder / "data"), {}, {}, set()

    def teardown(self):
        shutil.rmtree(self.folder)

    @rule(data=st.data())
    def keep(self, data):
        key, stamp = (data.draw(st.sampled_from(some)) for some in (self.store.keys, self.store.stamps))
        i = data.draw(st.integers(0, len(self.store.values) - 1))
        before = {str(path).lower() for path in self.folder.rglob("*.*")}
        self.store.keep(key, stamp, self.store.values[i])
        new = [path for path in self.folder.rglob("*.*") if str(path).lower() not in before]
        assert new or key in self.files  # no two keys share a file, even if case is ignored
        self.files.setdefault(key, new)
        self.kept[key] = stamp, self.store.told(self.store.values[i])
        self.damaged.discard(key)

    @rule(data=st.data(), share=st.floats(0.0, 0.99), gone=st.booleans())
    def damage(self, data, share, gone):
        if not self.files:
            return
        key = data.draw(st.sampled_from(list(self.files)))
        path = data.draw(st.sampled_from(self.files[key]))
        if gone or not path.exists():
            path.unlink(missing_ok=True)
        else:
            path.write_bytes(path.read_bytes()[: int(share * path.stat().st_size)])
        self.damaged.add(key)

    @rule()
    def find(self):
        for key in self.store.keys:
            for stamp in self.store.stamps:
                kept_by, kept = self.kept.get(key, (None, None))
                there = key not in self.damaged and stamp == kept_by and stamp is not None
                assert self.store.find(key, stamp) == (kept if there else None)


class FindingsStores(Stores):
    kind = OfFindings


class DrawingStores(Stores):
    kind = OfDrawings


for machine in (FindingsStores, DrawingStores):
    machine.TestCase.settings = settings(max_examples=20, stateful_step_count=12, deadline=None)
TestFindingsStore, TestDrawingStore = FindingsStores.TestCase, DrawingStores.TestCase


@pytest.mark.parametrize("kind", [OfFindings, OfDrawings])
def test_files_with_any_byte_changed_give_the_same_content_or_nothing(kind, tmp_path):
    store = kind(tmp_path)
    key, value = store.keys[0], store.values[0]
    store.keep(key, "now", value)
    for path in list(tmp_path.iterdir()):
        whole = path.read_bytes()
        for place in range(len(whole)):
            for change in (1, 0xFF):
                path.write_bytes(whole[:place] + bytes([whole[place] ^ change]) + whole[place + 1 :])
                assert store.find(key, "now") in (None, store.told(value))
        path.write_bytes(whole)


def test_only_declared_claims_and_figures_are_accepted(tmp_path):
    """Claims that are not declared are rejected, because files of the report have their names."""
    store = Store(tmp_path)
    for identity, taken in {"": True, "fig03/rests": True, "fig03/../../escaped": False}.items():
        findings = Findings((claim("c", "good", 0.0, 0.0, 0.0, identity=identity),))
        store.keep("fig03", "good", "now", findings, 0.0)
        assert (store.find("fig03", "good", "now", {"fig03/rests"}) is not None) is taken
    drawings = DrawingStore(tmp_path)
    for name, taken in {"radius": True, "../../escaped": False}.items():
        drawings.keep("fig03", "now", Drawing({name: b"<svg/>"}))
        assert (drawings.find("fig03", "now", ("radius",)) is not None) is taken
