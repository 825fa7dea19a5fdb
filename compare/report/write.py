"""Writes a report: ``index.html``, ``results.json``, ``junit.xml``, and the figures as files of their own."""

from __future__ import annotations

import json
from pathlib import Path

from compare.output.text_files import replacing, write_text
from compare.report.junit import junit
from compare.report.matrix import Matrix, matrix
from compare.report.page import page
from compare.report.results_json import results
from compare.run.runner import Drawing, Run
from compare.run.stamp import platform_stamp


def write_report(run: Run, output: Path) -> Matrix:
    """Write the report of a run, complete or not, into the folder ``output`` and return its matrix."""
    verdicts, stamp = matrix(run), platform_stamp()
    output.mkdir(parents=True, exist_ok=True)
    for drawing in run.drawings.values():
        if isinstance(drawing, Drawing):
            _write_pictures(drawing, output / "figures")
    content = json.dumps(results(run, verdicts, stamp), indent=1, ensure_ascii=False, allow_nan=False)
    write_text(output / "results.json", content)
    write_text(output / "junit.xml", junit(run, verdicts).decode("utf-8"))
    write_text(output / "index.html", page(run, verdicts, stamp))
    return verdicts


def _write_pictures(drawing: Drawing, folder: Path) -> None:
    folder.mkdir(exist_ok=True)
    files = {f"{name}.gif": content for name, content in drawing.animations.items()}
    for name, (svg, png) in drawing.figures.items():
        files |= {f"{name}.svg": svg, f"{name}.png": png}
    for name, content in files.items():
        with replacing(folder / name, "wb") as stream:
            stream.write(content)
