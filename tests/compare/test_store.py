import json

import numpy as np
from fake_studies import GOOD, claim, measure_verdicts, straight

from compare.fingerprint import fingerprint
from compare.store import PACKAGES, Store, claim_as_json, claim_from_json, stamp
from compare.study import Findings

NOW = stamp(fingerprint(straight, PACKAGES))


def same(a, b):
    return json.dumps(claim_as_json(a)) == json.dumps(claim_as_json(b))


def test_findings_come_back_to_the_last_bit(tmp_path):
    store, findings = Store(tmp_path / "data"), measure_verdicts(GOOD)
    store.keep("fig03", "good", NOW, findings, 1.5)
    found, seconds = store.find("fig03", "good", NOW)
    assert seconds == 1.5
    assert all(same(a, b) for a, b in zip(found.claims, findings.claims, strict=True))
    for name, array in findings.data.items():
        np.testing.assert_array_equal(found.data[name], array)


def test_numbers_that_json_does_not_know_come_back(tmp_path):
    made = claim(
        "c", "good", [0.0, np.inf], [np.nan, -np.inf], np.inf, parameters={"a": np.float64(1.0), "n": 3}
    )
    text = json.dumps(claim_as_json(made), allow_nan=False)
    back = claim_from_json(json.loads(text))
    np.testing.assert_array_equal(back.measured, made.measured)
    assert back.budget.numerical == np.inf
    assert back.verdict is made.verdict


def test_findings_of_other_code_are_not_taken(tmp_path):
    store = Store(tmp_path)
    store.keep("fig03", "good", "another version", Findings(), 0.0)
    assert store.find("fig03", "good", NOW) is None


def test_broken_files_are_computed_again(tmp_path):
    store = Store(tmp_path)
    store.keep("fig03", "good", NOW, Findings(), 0.0)
    (tmp_path / "fig03--good.npz").write_bytes(b"")
    assert store.find("fig03", "good", NOW) is None
    (tmp_path / "fig03--good.json").write_text("{")
    assert store.find("fig03", "good", NOW) is None


def test_engines_of_ones_own_have_files_of_their_own(tmp_path):
    store = Store(tmp_path)
    store.keep("fig03", "mine.py:simulate", NOW, Findings(), 0.0)
    assert store.find("fig03", "mine.py:simulate", NOW) is not None
    assert store.find("fig03", "mine", NOW) is None


def test_the_stamp_knows_the_code_of_the_engine_and_of_the_packages():
    assert stamp(fingerprint(straight, PACKAGES)) == NOW
    assert stamp(fingerprint(json.dumps, PACKAGES)) != NOW
    assert stamp(fingerprint(straight, PACKAGES), code=("reference_model",)) != NOW
