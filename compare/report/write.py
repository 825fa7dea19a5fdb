"""Writes the files of a report: page, results for programs, figures and arrays."""

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from compare.output.text_files import replacing, write_text
from compare.report.animation import still
from compare.report.at_a_glance import badge, glances
from compare.report.junit import junit
from compare.report.matrix import Matrix, matrix
from compare.report.page import page
from compare.report.results_json import FILE, results, tables
from compare.run.provenance import platform_stamp
from compare.run.runner import Run
from compare.run.store import Drawing

LINES = 4
"""Number of nesting levels of ``results.json`` with one line per value."""


def write_report(run: Run, output: Path) -> Matrix:
    """Write the report of a run to the folder ``output`` and return its matrix."""
    verdicts, stamp = matrix(run), platform_stamp()
    output.mkdir(parents=True, exist_ok=True)
    for drawing in run.drawings.values():
        if isinstance(drawing, Drawing):
            _write(_pictures(drawing), output)
    for recorded in verdicts.recorded:
        _write({path: file.read_bytes() for path, file in recorded.adapters.items()}, output)
    arrays = tables(verdicts)
    _write(dict(arrays.values()), output)
    paths = {identity: path for identity, (path, _) in arrays.items()}
    found = glances(run, verdicts)
    write_text(output / FILE, _lines(results(run, verdicts, stamp, paths, found), LINES) + "\n")
    write_text(output / "junit.xml", junit(run, verdicts).decode("utf-8"))
    write_text(output / "badge.svg", badge(verdicts))
    write_text(output / "index.html", page(run, verdicts, stamp, paths, found))
    return verdicts


def _pictures(drawing: Drawing) -> dict[str, bytes]:
    figures = {f"figures/{name}.svg": content for name, content in drawing.figures.items()}
    moving = {f"figures/{name}.gif": content for name, content in drawing.animations.items()}
    return figures | moving | {f"figures/{name}.png": still(gif) for name, gif in drawing.animations.items()}


def _lines(content: Any, depth: int) -> str:
    if depth == 0 or not content or not isinstance(content, dict | list):
        return json.dumps(content, ensure_ascii=False, allow_nan=False)
    if isinstance(content, list):
        return "[\n" + ",\n".join(_lines(one, depth - 1) for one in content) + "\n]"
    parts = (
        f"{json.dumps(name, ensure_ascii=False)}: {_lines(one, depth - 1)}" for name, one in content.items()
    )
    return "{\n" + ",\n".join(parts) + "\n}"


def _write(contents: Mapping[str, bytes], output: Path) -> None:
    for path, content in contents.items():
        file = output / path
        file.parent.mkdir(parents=True, exist_ok=True)
        with replacing(file, "wb") as stream:
            stream.write(content)
