"""``results.json``: the report for programs, described by ``results.schema.json``.

It contains the verdict of each claim and engine with the numbers of the deciding element. All numbers are in separate
tables, which ``read_results`` adds.
"""

import csv
import io
import lzma
import sys
from collections.abc import Iterator, Mapping
from contextlib import suppress
from dataclasses import asdict
from itertools import count, cycle, repeat
from pathlib import Path
from typing import Any

import numpy as np

from compare.claims.as_json import as_json, claim_as_json
from compare.claims.claim import EVIDENCE, Claim
from compare.claims.errata import Erratum, Evidence
from compare.claims.prose import slug
from compare.claims.study import Study
from compare.output.outside_text import printable, reason_of
from compare.output.text_files import LARGEST, read_file, read_json
from compare.report.at_a_glance import Glance
from compare.report.matrix import (
    VERDICTS,
    WORST_FIRST,
    Matrix,
    Row,
    State,
    gap_of,
    single_gap,
)
from compare.report.numbers import Element, worst
from compare.report.quotes import filled
from compare.report.schema import faults, schema
from compare.run.runner import Run
from compare.run.store import Drawing
from compare.run.workers import Failure
from reference_model.systems import FloatArray

# --- All numbers of each claim as a table: comma-separated values, a row for each element and engine.
#
# ``measurement`` counts repeated claims of an engine from 1. Numbers have all digits, or are "nan" or "inf". Large
# tables are compressed (xz); pandas and R read them directly.

FOLDER = "arrays"

COLUMNS = (
    "engine",
    "measurement",
    "element",
    "place",
    "unit",
    "predicted",
    "measured",
    "numerical_error",
    "size",
)
"""Columns of a table; ``element`` counts from 0, ``place`` describes it."""

LARGE = 32_768
"""In bytes; larger tables are compressed."""


def tables(matrix: Matrix) -> dict[str, tuple[str, bytes]]:
    """Return path and content of each claim's table, by identity."""
    return {row.identity: table(row) for row in matrix.rows if row.claims}


def table(row: Row) -> tuple[str, bytes]:
    """Return path and content of a claim's table."""
    stream = io.StringIO()
    writer = csv.writer(stream, lineterminator="\n")
    writer.writerow(COLUMNS)
    for engine, cell in row.cells.items():
        for i, claim in enumerate(cell.claims, 1):
            writer.writerows((engine, i, *element) for element in _elements(claim))
    content = stream.getvalue().encode()
    path = f"{FOLDER}/{row.identity}.csv"
    return (f"{path}.xz", lzma.compress(content, preset=2)) if len(content) > LARGE else (path, content)


def _elements(claim: Claim) -> Iterator[tuple[object, ...]]:
    shape = claim.predicted.shape
    numbers = [
        repeat("")
        if array is None
        else map(repr, np.broadcast_to(array, shape).astype(float).ravel().tolist())
        for array in (claim.predicted, claim.measured, claim.budget.numerical, claim.size)
    ]
    return zip(count(), claim.elements(), cycle(claim.units), *numbers)


def with_arrays(results: Mapping[str, Any], folder: Path) -> dict[str, Any]:
    """Return the results of the report in ``folder`` with the arrays of each claim.

    The arrays have the format of ``compare.claims.as_json.claim_as_json``; ``places`` contains the name and the unit
    of each element. Raises ``OSError`` or ``ValueError`` if a table is missing or invalid.
    """
    studies = []
    for study in results["studies"]:
        tables: dict[str, dict[tuple[str, str], list[dict[str, str]]]] = {}
        claims = []
        for claim in study["claims"]:
            if not (folder / claim["arrays"]).resolve().is_relative_to(folder.resolve()):
                raise ValueError(f"the table {claim['arrays']!r} is not in the folder of the report")
            path = folder / claim["arrays"]
            try:
                if claim["arrays"] not in tables:
                    tables[claim["arrays"]] = _read(path)
                rows = tables[claim["arrays"]].get((claim["engine"], str(claim["measurement"])), [])
                claims.append(claim | _arrays(rows, claim))
            except OSError:
                raise
            except Exception as error:  # a damaged table may raise anything
                raise ValueError(f"the table {str(path)!r} is damaged: {reason_of(error)}") from None
        studies.append(study | {"claims": claims})
    return {**results, "studies": studies}


def _axes(rows: list[dict[str, str]], claim: Mapping[str, Any]) -> list[list[str]]:
    if "," not in claim["unit"]:
        return []
    return [[]] * (len(claim["shape"]) - 1) + [[row["place"] for row in rows[: claim["shape"][-1]]]]


def _read(path: Path) -> dict[tuple[str, str], list[dict[str, str]]]:
    raw = read_file(path)
    text = (lzma.LZMADecompressor().decompress(raw, LARGEST) if path.suffix == ".xz" else raw).decode()
    found: dict[tuple[str, str], list[dict[str, str]]] = {}
    for row in csv.DictReader(io.StringIO(printable(text, sys.maxsize))):
        found.setdefault((row["engine"], row["measurement"]), []).append(row)
    return found


def _arrays(rows: list[dict[str, str]], claim: Mapping[str, Any]) -> dict[str, Any]:
    if len(rows) != int(np.prod(claim["shape"], dtype=int)):
        raise ValueError(
            f"it contains {len(rows)} numbers of {claim['engine']}, but results.json expects "
            f"{int(np.prod(claim['shape'], dtype=int))}; they may be from different reports"
        )

    def column(name: str) -> FloatArray:
        return np.array([float(row[name]) for row in rows]).reshape(claim["shape"])

    predicted, measured = column("predicted"), column("measured")
    return {
        "predicted": predicted.tolist(),
        "measured": measured.tolist(),
        "difference": np.abs(measured - predicted).tolist(),
        "numerical_error": column("numerical_error").tolist(),
        "size": column("size").tolist() if rows[0]["size"] else None,
        "places": [(row["place"], row["unit"]) for row in rows],
        "axes": _axes(rows, claim),
    }


# --- The report as one file.

FORMAT, VERSION = "friction-discs results", 1
"""Name and version of the format; incompatible changes increase the version."""

FILE = "results.json"


def read_results(path: Path) -> dict[str, Any]:
    """Return a report's results with the arrays of each claim, from ``results.json`` or its folder.

    Raises ``ValueError`` with the file and the place if it is missing, is not a report, or breaks its schema.
    """
    file = path / FILE if path.is_dir() else path
    try:
        content = read_json(file)
    except OSError as error:
        raise ValueError(f"cannot read {str(file)!r}: {error.strerror}") from None
    except ValueError as error:
        raise ValueError(f"{str(file)!r} is not the results.json of a report: {error}") from None
    if not isinstance(content, dict) or content.get("format") != FORMAT:
        raise ValueError(f"{str(file)!r} is not the results.json of a report")
    if (version := content.get("version")) != VERSION:
        raise ValueError(f"{str(file)!r} has version {version}, but this program reads version {VERSION}")
    if fault := next(faults(content, schema()), ""):
        raise ValueError(f"{str(file)!r} is not a valid report: {fault}")
    try:
        return with_arrays(content, file.parent)
    except OSError as error:
        raise ValueError(
            f"cannot read {str(error.filename)!r}, a table of {str(file)!r}: {error.strerror}"
        ) from None


def seconds_of_last_run(*folders: Path) -> dict[tuple[str, str], float]:
    """Return the duration in s of each measurement in the first report of ``folders``."""
    for folder in folders:
        with suppress(OSError, ValueError, KeyError, TypeError, AttributeError):
            content = read_json(folder / FILE)
            return {
                (study["name"], engine): float(unit["seconds"])
                for study in content["studies"]
                for engine, unit in study["units"].items()
                if unit["seconds"] is not None
            }
    return {}


def results(
    run: Run,
    matrix: Matrix,
    stamp: Mapping[str, str],
    paths: Mapping[str, str],
    glances: tuple[Glance, ...],
) -> dict[str, Any]:
    """Return the content of ``results.json``; ``paths`` are the claims' tables by identity."""
    return {
        "format": FORMAT,
        "version": VERSION,
        "stamp": dict(stamp),
        "engines": list(run.engines),
        "engine_versions": {name: run.versions.get(name, "") for name in run.engines},
        "in_short": {one.engine: one.sentence for one in glances},
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
                "claims": [
                    _claim(f"{recorded.study.name}/{slug(claim.sentence)}", claim) for claim in setting.claims
                ],
            }
            for recorded in matrix.recorded
            for setting in recorded.settings
        ],
        "validations": [{"study": study.name} | asdict(one) for study, one in matrix.validations],
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
            _claim(
                row.identity,
                claim,
                measurement=i,
                evidence=cell.evidence,
                follows_from=cell.implied_by,
                arrays=paths[row.identity],
            )
            for row in own.rows
            for cell in row.cells.values()
            for i, claim in enumerate(cell.claims, 1)
        ],
    }


LEFT_OUT = ("id", "predicted", "measured", "difference", "numerical_error", "size", "axes")
"""Fields of a claim that ``results.json`` stores in other places."""


def _claim(identity: str, claim: Claim, **more: Any) -> dict[str, Any]:
    """Return a claim without its arrays, with ``more`` and the numbers that decide its verdict."""
    content = {name: value for name, value in claim_as_json(claim).items() if name not in LEFT_OUT}
    element = worst(claim)
    decides = _number(element) | {
        "predicted": element.predicted,
        "measured": element.measured,
        "numerical_error": element.numerical,
        "allowed": element.total,
    }
    return {
        "id": identity,
        **content,
        "shape": list(claim.predicted.shape),
        **more,
        "decided_by": as_json(decides),
        "largest": [as_json(_number(one)) for one in element.largest],
    }


def _number(element: Element) -> dict[str, Any]:
    return {
        "element": element.index,
        "name": element.name,
        "unit": element.unit,
        "difference": element.difference,
    }


def _unit(run: Run, study: str, column: str) -> dict[str, Any]:
    outcome, whole = run.outcomes.get((study, column)), gap_of(run, study, column)
    gaps = [whole] if whole is not None else []
    gaps += [single_gap(why) for why in getattr(outcome, "gaps", {}).values()]
    states = {gap.state for gap in gaps}
    return {
        "state": next((state.value for state in WORST_FIRST if state in states), "finished"),
        "reason": "; ".join(dict.fromkeys(gap.reason for gap in gaps)) if outcome is not None else "",
        "seconds": run.seconds.get((study, column)),
    }


def erratum_id(erratum: Erratum) -> str:
    """Return the permanent identity of an erratum, such as "erratum-13"."""
    return f"erratum-{slug(erratum.equation)}"


def _evidence(evidence: Evidence | Failure | None) -> dict[str, Any] | None:
    if evidence is None:
        return None
    if isinstance(evidence, Failure):
        return {"failed": evidence.reason}
    content: dict[str, Any] = as_json(evidence)
    return content
