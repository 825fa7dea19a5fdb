"""``results.json``: the report for programs, described by ``results.schema.json``.

It has the verdict of each claim and engine with the numbers that decide it. All other numbers are in tables beside
it, see ``compare.report.machines.arrays``; ``read_results`` puts both together.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from importlib.resources import files
from pathlib import Path
from typing import Any

from compare.claims.as_json import as_json, claim_as_json
from compare.claims.claim import EVIDENCE, Claim
from compare.claims.errata import Erratum, Evidence
from compare.claims.prose import slug
from compare.claims.study import Study
from compare.output.outside_text import all_printable
from compare.report.machines.arrays import with_arrays
from compare.report.matrix import VERDICTS, Cell, Matrix, RecordedMatrix, State
from compare.report.quotes import filled
from compare.report.worst import worst
from compare.run.drawings import Drawing
from compare.run.runner import Run
from compare.run.workers import Failure

FORMAT, VERSION = "friction-discs results", 1
"""What the file says of itself; the version rises when a reader of the old one would be misled."""

FILE = "results.json"


def schema() -> dict[str, Any]:
    """Return the JSON schema (draft 2020-12) of ``results.json``."""
    content = files("compare.report.machines").joinpath("results.schema.json").read_text(encoding="utf-8")
    found: dict[str, Any] = json.loads(content)
    return found


def read_results(path: Path) -> dict[str, Any]:
    """Return a report's results with the arrays of each claim, from ``results.json`` or the folder that it is in.

    Raises
    ------
    ValueError
        For a file that is not there or is no such file, of another version too.

    """
    file = path / FILE if path.is_dir() else path
    try:
        content = all_printable(json.loads(file.read_text(encoding="utf-8")))
    except OSError as error:
        raise ValueError(f"can't read {str(file)!r}: {error.strerror}") from None
    except ValueError:
        content = None
    if not isinstance(content, dict) or content.get("format") != FORMAT:
        raise ValueError(f"{str(file)!r} is no results.json of a report")
    if content["version"] != VERSION:
        raise ValueError(
            f"{str(file)!r} has version {content['version']}: this program reads version {VERSION}"
        )
    try:
        return with_arrays(content, file.parent)
    except OSError as error:
        raise ValueError(
            f"can't read {str(error.filename)!r}, a table of {str(file)!r}: {error.strerror}"
        ) from None


def results(run: Run, matrix: Matrix, stamp: Mapping[str, str], paths: Mapping[str, str]) -> dict[str, Any]:
    """Return the content of ``results.json``; numbers that JSON doesn't know are "nan", "inf", "-inf".

    ``paths`` are those of the claims' tables, by identity.
    """
    return {
        "format": FORMAT,
        "version": VERSION,
        "stamp": dict(stamp),
        "engines": list(run.engines),
        "engine_versions": {name: run.versions.get(name, "") for name in run.engines},
        "interrupted": run.interrupted,
        "totals": {state.value: matrix.totals[state] for state in State},
        "evidence": {
            evidence: {state.value: matrix.of_evidence(evidence)[state] for state in VERDICTS}
            for evidence in EVIDENCE
        },
        "studies": [_study(run, study, matrix.of(study), paths) for study in matrix.studies],
        "recorded": [
            {
                "study": recorded.study.name,
                "engine": setting.engine,
                "setting": setting.setting,
                "version": setting.version,
                "date": setting.date,
                "claims": [_recorded(recorded, claim) for claim in setting.claims],
            }
            for recorded in matrix.recorded
            for setting in recorded.settings
        ],
        "errata": [
            {
                "id": erratum_id(erratum),
                "equation": erratum.equation,
                "printed": erratum.printed,
                "correct": erratum.correct,
                "explanation": erratum.explanation,
                "evidence": _evidence(run.evidence.get(i)),
            }
            for i, erratum in enumerate(run.errata)
        ],
    }


def _study(run: Run, study: Study, own: Matrix, paths: Mapping[str, str]) -> dict[str, Any]:
    drawing = run.drawings.get(study.name)
    return {
        "name": study.name,
        "title": study.title,
        "finding": filled(study.prose.finding, own.claims),
        "units": {column: _unit(run, study.name, column) for column in run.columns(study)},
        "figures": sorted(drawing.figures) if isinstance(drawing, Drawing) else [],
        "figures_failed": drawing.reason if isinstance(drawing, Failure) else "",
        "claims": [
            _verdict(claim, cell, i, row.identity, paths[row.identity])
            for row in own.rows
            for cell in row.cells.values()
            for i, claim in enumerate(cell.claims, 1)
        ],
    }


def _verdict(claim: Claim, cell: Cell, measurement: int, identity: str, path: str) -> dict[str, Any]:
    """Return a claim with its kind of evidence in this report, and where its numbers are."""
    said = _without_arrays(claim)
    more = {
        "measurement": measurement,
        "evidence": cell.evidence,
        "follows_from": cell.implied_by,
        "arrays": path,
    }
    return {"id": identity} | said | more | _deciding(claim)


def _recorded(recorded: RecordedMatrix, claim: Claim) -> dict[str, Any]:
    return {"id": f"{recorded.study.name}/{slug(claim.sentence)}"} | _without_arrays(claim) | _deciding(claim)


def _without_arrays(claim: Claim) -> dict[str, Any]:
    content = claim_as_json(claim)
    for name in ("predicted", "measured", "difference", "numerical_error", "size", "axes", "id"):
        del content[name]
    return content | {"shape": list(claim.predicted.shape)}


def _deciding(claim: Claim) -> dict[str, Any]:
    """Return the numbers of the element that decides, and the largest difference in each unit."""
    element = worst(claim)
    return {
        "decided_by": as_json(
            {
                "element": element.index,
                "name": element.name,
                "unit": element.unit,
                "predicted": element.predicted,
                "measured": element.measured,
                "difference": element.difference,
                "numerical_error": element.numerical,
                "allowed": element.total,
            }
        ),
        "largest": [
            {"element": one.index, "name": one.name, "unit": one.unit, "difference": as_json(one.difference)}
            for one in element.largest
        ],
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


def erratum_id(erratum: Erratum) -> str:
    """Return what an erratum is called for good, as "erratum-13"."""
    return f"erratum-{slug(erratum.equation)}"


def _evidence(evidence: Evidence | Failure | None) -> dict[str, Any] | None:
    if evidence is None:
        return None
    if isinstance(evidence, Failure):
        return {"failed": evidence.reason}
    content: dict[str, Any] = as_json(evidence)
    return content
