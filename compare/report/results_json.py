"""``results.json``: every number of the report for programs."""

from __future__ import annotations

from typing import Any

from compare.claims.as_json import as_json, claim_as_json
from compare.claims.claim import EVIDENCE, Claim
from compare.claims.errata import Evidence
from compare.report.matrix import VERDICTS, Cell, Matrix, State
from compare.report.quotes import filled
from compare.report.worst import worst
from compare.run.runner import Drawing, Run
from compare.run.workers import Failure


def results(run: Run, matrix: Matrix, stamp: dict[str, str]) -> dict[str, Any]:
    """Return the content of ``results.json``; numbers that JSON doesn't know are "nan", "inf", "-inf"."""
    return {
        "stamp": stamp,
        "engines": list(run.engines),
        "interrupted": run.interrupted,
        "totals": {state.value: matrix.totals[state] for state in State},
        "evidence": {
            evidence: {state.value: matrix.of_evidence(evidence)[state] for state in VERDICTS}
            for evidence in EVIDENCE
        },
        "studies": [_study(run, matrix, i) for i in range(len(run.studies))],
        "recorded": [
            {
                "study": recorded.study.name,
                "engine": setting.engine,
                "setting": setting.setting,
                "version": setting.version,
                "date": setting.date,
                "claims": [claim_as_json(claim) for claim in setting.claims],
            }
            for recorded in matrix.recorded
            for setting in recorded.settings
        ],
        "errata": [
            {
                "equation": erratum.equation,
                "printed": erratum.printed,
                "correct": erratum.correct,
                "explanation": erratum.explanation,
                "evidence": _evidence(run.evidence.get(i)),
            }
            for i, erratum in enumerate(run.errata)
        ],
    }


def _study(run: Run, matrix: Matrix, i: int) -> dict[str, Any]:
    study, group = run.studies[i], matrix.groups[i]
    drawing = run.drawings.get(study.name)
    return {
        "name": study.name,
        "title": study.title,
        "finding": filled(study.finding, group.claims),
        "units": {column: _unit(run, study.name, column) for column in run.columns(study)},
        "figures": sorted(drawing.figures) if isinstance(drawing, Drawing) else [],
        "figures_failed": drawing.reason if isinstance(drawing, Failure) else "",
        "claims": [
            _verdict(claim, cell)
            for row in group.rows
            for cell in row.cells.values()
            for claim in cell.claims
        ],
    }


def _verdict(claim: Claim, cell: Cell) -> dict[str, Any]:
    """Return a claim with its kind of evidence in this report, and the numbers of the element that decides."""
    element = worst(claim)
    return claim_as_json(claim) | {
        "evidence": cell.evidence,
        "follows_from": cell.implied_by,
        "decided_by": {
            "element": element.index,
            "element_name": element.name,
            "difference": as_json(element.difference),
            "allowed": as_json(element.total),
            "largest_difference": as_json(element.largest_difference),
        },
    }


def _unit(run: Run, study: str, column: str) -> dict[str, Any]:
    outcome = run.outcomes.get((study, column))
    state, reason = State.MISSING.value, ""
    if isinstance(outcome, Failure):
        state, reason = State.FAILED.value, outcome.reason
    elif outcome is not None:
        reason = outcome.not_simulated
        state = State.NOT_SIMULATED.value if reason else "finished"
    return {
        "state": state,
        "reason": reason,
        "seconds": run.seconds.get((study, column)),
    }


def _evidence(evidence: Evidence | Failure | None) -> dict[str, Any] | None:
    if evidence is None:
        return None
    if isinstance(evidence, Failure):
        return {"failed": evidence.reason}
    content: dict[str, Any] = as_json(evidence)
    return content
