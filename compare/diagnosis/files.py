"""The files of a matrix: numbers and sentences as JSON, and the picture."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path

from compare.claims.as_json import as_json
from compare.diagnosis.picture import drawn
from compare.diagnosis.row import Row
from compare.output.figures import paper_style, saved
from compare.output.text_files import replacing, write_text


def write_rows(rows: Sequence[Row], folder: Path) -> None:
    """Write what is found so far into ``folder``/matrix.json; a file that is there is complete."""
    content = [as_json(row) | {"sentences": list(row.sentences), "wrong": row.wrong} for row in rows]
    write_text(folder / "matrix.json", json.dumps(content, indent=1, ensure_ascii=False, allow_nan=False))


def write_picture(rows: Sequence[Row], folder: Path) -> None:
    """Write matrix.svg and matrix.png, if any motion was simulated."""
    if not any(row.motions for row in rows):
        return
    with paper_style():
        figure = drawn(rows)
    for ending, content in zip(("svg", "png"), saved(figure), strict=True):
        with replacing(folder / f"matrix.{ending}", "wb") as stream:
            stream.write(content)
