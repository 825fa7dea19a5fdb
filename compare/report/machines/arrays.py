"""All numbers of each claim as a table: a file of comma-separated values beside the page, and back again.

A row for each element and engine. Where an engine makes a claim several times, ``measurement`` counts them from 1.
Numbers come back to the last bit; "nan" and "inf" are what they are called. Large tables are compressed (xz),
which pandas and R read as they are.
"""

from __future__ import annotations

import csv
import io
import lzma
import sys
from collections.abc import Iterator, Mapping
from itertools import count, cycle, repeat
from pathlib import Path
from typing import Any

import numpy as np

from compare.claims.claim import Claim
from compare.output.outside_text import printable
from compare.report.matrix import Matrix, Row
from reference_model.systems import FloatArray

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
"""``element`` counts from 0, ``place`` says in words which it is, ``size`` is empty where a claim has none."""

LARGE = 32_768
"""Bytes from which a table is compressed."""


def tables(matrix: Matrix) -> dict[str, tuple[str, bytes]]:
    """Return the path in the report's folder and the content of each claim's file, by the claim's identity."""
    return {row.identity: table(row) for row in matrix.rows if row.claims}


def table(row: Row) -> tuple[str, bytes]:
    """Return the path of a claim's file in the report's folder, and what is in it."""
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
    """Yield the columns from ``element`` on of each element."""
    shape = claim.predicted.shape
    numbers = [
        repeat("")
        if array is None
        else map(repr, np.broadcast_to(array, shape).astype(float).ravel().tolist())
        for array in (claim.predicted, claim.measured, claim.budget.numerical, claim.size)
    ]
    return zip(count(), claim.elements(), cycle(claim.units), *numbers)


def with_arrays(results: Mapping[str, Any], folder: Path) -> dict[str, Any]:
    """Return ``results.json`` of the report in ``folder`` with the arrays of each claim in it.

    They are as in ``compare.claims.as_json.claim_as_json``; ``places`` has the name and the unit of each element.
    Raises ``OSError`` or ``ValueError`` for a file that is not there, or is no such table.
    """
    studies = []
    for study in results["studies"]:
        tables: dict[str, dict[tuple[str, str], list[dict[str, str]]]] = {}
        claims = []
        for claim in study["claims"]:
            if not (folder / claim["arrays"]).resolve().is_relative_to(folder.resolve()):
                raise ValueError(f"the table {claim['arrays']!r} is not in the folder of the report")
            if claim["arrays"] not in tables:
                tables[claim["arrays"]] = _read(folder / claim["arrays"])
            rows = tables[claim["arrays"]].get((claim["engine"], str(claim["measurement"])), [])
            claims.append(claim | _arrays(rows, claim))
        studies.append(study | {"claims": claims})
    return {**results, "studies": studies}


def _axes(rows: list[dict[str, str]], claim: Mapping[str, Any]) -> list[list[str]]:
    """Return names of the last axis, which say the units where they are mixed."""
    if "," not in claim["unit"]:
        return []
    return [[]] * (len(claim["shape"]) - 1) + [[row["place"] for row in rows[: claim["shape"][-1]]]]


def _read(path: Path) -> dict[tuple[str, str], list[dict[str, str]]]:
    """Return the rows of a table by engine and measurement."""
    raw = path.read_bytes()
    text = (lzma.decompress(raw) if path.suffix == ".xz" else raw).decode()
    found: dict[tuple[str, str], list[dict[str, str]]] = {}
    for row in csv.DictReader(io.StringIO(printable(text, sys.maxsize))):
        found.setdefault((row["engine"], row["measurement"]), []).append(row)
    return found


def _arrays(rows: list[dict[str, str]], claim: Mapping[str, Any]) -> dict[str, Any]:
    if len(rows) != int(np.prod(claim["shape"], dtype=int)):
        raise ValueError(
            f"{claim['arrays']} has {len(rows)} numbers of {claim['engine']}: is it of this report?"
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
