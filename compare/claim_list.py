"""What each study claims of engines, known before anything is measured: ``claims.json`` beside the studies.

It is taken from reports with all of the project's engines. A claim that changes needs its study's part anew::

    friction-discs report trajectories
    python -m compare.claim_list report/results.json
"""

from __future__ import annotations

import json
import sys
from pathlib import Path

PATH = Path(__file__).with_name("studies") / "claims.json"

Sentences = dict[str, list[str]]


def sentences() -> Sentences:
    """Return the sentences that each study claims of engines, by the study's name."""
    listed: Sentences = json.loads(PATH.read_text(encoding="utf-8"))
    return listed


def renewed(listed: Sentences, results: Path) -> Sentences:
    """Return ``listed`` with what the report of ``results``, a ``results.json``, measured; in report order.

    Raises ``ValueError`` if an engine of the project is missing there, or has no result.
    """
    from compare.claim import THEORY
    from compare.engines import engines
    from compare.report.matrix import State
    from compare.studies import STUDIES

    report = json.loads(results.read_text(encoding="utf-8"))
    missing = {engine.name for engine in engines()} - set(report["engines"])
    lost = [state.value for state in (State.FAILED, State.MISSING) if report["totals"][state.value]]
    if missing or lost:
        raise ValueError(f"{results} is not complete: {', '.join([*sorted(missing), *lost])}")
    found = {
        study["name"]: list(
            dict.fromkeys(claim["sentence"] for claim in study["claims"] if claim["engine"] != THEORY)
        )
        for study in report["studies"]
    }
    both = listed | found
    return {study.name: both[study.name] for study in STUDIES if both.get(study.name)}


if __name__ == "__main__":
    text = json.dumps(renewed(sentences(), Path(sys.argv[1])), ensure_ascii=False, indent=1)
    PATH.write_text(text + "\n", encoding="utf-8", newline="\n")
