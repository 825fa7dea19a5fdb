"""What each study claims of engines, known before anything is measured: ``claims.json`` beside the studies.

With every sentence stands its basis, and the claim that implies it, see ``compare.claims.claim.Claim``: with the
name of an engine they say what kind of evidence it is. The file is taken from reports with all of the project's
engines. A claim that changes needs its study's part anew::

    friction-discs report trajectories
    python -m compare.studies.claim_list report/results.json
"""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import TypedDict

from compare.claims.claim import THEORY, Basis
from compare.claims.study import Study

PATH = Path(__file__).with_name("claims.json")


class Listed(TypedDict):
    """What is known of a claim besides its sentence; ``implied_by`` is the sentence of another one, or ""."""

    basis: Basis
    implied_by: str


Claims = dict[str, dict[str, Listed]]
"""By the study's name and by their sentences."""


def listed_claims() -> Claims:
    """Return the claims that each study makes of engines."""
    claims: Claims = json.loads(PATH.read_text(encoding="utf-8"))
    return claims


def sentences(study: Study) -> list[str]:
    """Return the sentences that the study claims of engines."""
    return list(study.sentences()) if study.by_hand is None else list(listed_claims()[study.name])


def renewed(listed: Claims, results: Path) -> Claims:
    """Return ``listed`` with what the report of ``results``, a ``results.json``, measured; in report order.

    Raises ``ValueError`` if an engine of the project is missing there, or has no result.
    """
    from compare.engines import engines
    from compare.report.matrix import State
    from compare.studies import STUDIES

    report = json.loads(results.read_text(encoding="utf-8"))
    missing = {engine.name for engine in engines()} - set(report["engines"])
    lost = [state.value for state in (State.FAILED, State.MISSING) if report["totals"][state.value]]
    if missing or lost:
        raise ValueError(f"{results} is not complete: {', '.join([*sorted(missing), *lost])}")
    found: Claims = {
        study["name"]: {
            claim["sentence"]: {"basis": claim["basis"], "implied_by": claim["implied_by"]}
            for claim in study["claims"]
            if claim["engine"] != THEORY
        }
        for study in report["studies"]
    }
    both = listed | found
    return {study.name: both[study.name] for study in STUDIES if both.get(study.name)}


def as_text(listed: Claims) -> str:
    """Return the file's text: a line for each claim."""

    def written(value: object) -> str:
        return json.dumps(value, ensure_ascii=False)

    studies = (
        f" {written(study)}: {{\n"
        + ",\n".join(f"  {written(sentence)}: {written(claim)}" for sentence, claim in claims.items())
        + "\n }"
        for study, claims in listed.items()
    )
    return "{\n" + ",\n".join(studies) + "\n}\n"


if __name__ == "__main__":
    PATH.write_text(as_text(renewed(listed_claims(), Path(sys.argv[1]))), encoding="utf-8", newline="\n")
