import json
import subprocess
import sys

import numpy as np
import pytest
from fake_studies import GOOD, claim, measure_verdicts
from processes import environment

from compare.claims.as_json import claim_as_json, claim_from_json
from compare.claims.study import Findings
from compare.run.store import Store

NOW = "a stamp"


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
    (arrays,), (claims,) = tmp_path.glob("*.npz"), tmp_path.glob("*.json.xz")
    arrays.write_bytes(b"")
    assert store.find("fig03", "good", NOW) is None
    claims.write_text("{")
    assert store.find("fig03", "good", NOW) is None


def test_only_claims_that_a_study_declares_are_taken(tmp_path):
    store = Store(tmp_path)
    for identity, taken in {"": True, "fig03/rests": True, "fig03/../../escaped": False}.items():
        findings = Findings((claim("c", "good", 0.0, 0.0, 0.0, identity=identity),))
        store.keep("fig03", "good", NOW, findings, 0.0)
        assert (store.find("fig03", "good", NOW, {"fig03/rests"}) is not None) is taken


SIMILAR = [
    ("fig03", "exec:./a.b"),
    ("fig03", "exec:./a_b"),
    ("fig03", "exec:./A_b"),
    ("fig03", "exec:./ä_b"),
    ("fig03", "exec:./\udce4_b"),
    ("fig03--exec", "./a_b"),
    ("fig03", 100 * "exec:a"),
    ("fig03", 101 * "exec:a"),
]


def test_no_two_engines_share_a_file_of_the_store_however_similar_or_long_their_names_are(tmp_path):
    store = Store(tmp_path)
    for seconds, names in enumerate(SIMILAR):
        store.keep(*names, NOW, Findings(), float(seconds))
    assert [store.find(*names, NOW)[1] for names in SIMILAR] == list(range(len(SIMILAR)))
    assert len({path.name.lower() for path in tmp_path.glob("*.npz")}) == len(SIMILAR)


@pytest.mark.parametrize(("first", "settings"), [("compare.engines", "off"), ("exudyn", "on")])
def test_a_users_own_settings_of_exudyn_are_switched_off_and_reports_say_whether_they_are(
    first, settings, tmp_path
):
    (tmp_path / "config.json").write_text('{"version": 1, "config": {"suppressWarnings": true}}')
    code = (
        f"import {first}, exudyn\n"
        "import compare.run.runner\n"
        "from compare.run.provenance import exudyn_user_settings\n"
        "from compare.run.workers import Workers\n"
        "from exudyn.misc.overrideSettings import Applied\n"
        "if __name__ == '__main__':\n"
        "    with Workers(2) as workers:\n"
        "        workers.submit('key', Applied)\n"
        "        in_worker = [done.value for done in workers.finished()]\n"
        "    print(bool(Applied()), in_worker, exudyn_user_settings())\n"
    )
    (tmp_path / "script.py").write_text(code)
    variables = environment(EXUDYN_CONFIG_FILE=str(tmp_path / "config.json"))
    del variables["EXUDYN_NO_USER_SETTINGS"]
    command = [sys.executable, str(tmp_path / "script.py")]
    done = subprocess.run(command, env=variables, capture_output=True, text=True)
    expected = f"{settings == 'on'} [[]] {settings}\n"
    assert done.stdout.endswith(expected), done.stdout + done.stderr
