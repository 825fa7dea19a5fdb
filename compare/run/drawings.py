"""What is drawn of a study, and kept: equal data, drawn by equal code, are equal files."""

from __future__ import annotations

import hashlib
from collections.abc import Collection, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from zipfile import ZIP_DEFLATED, ZipFile

import numpy as np

from compare.claims.study import Data, Study
from compare.output.figures import as_svg, paper_style
from compare.output.text_files import replacing
from compare.run.stamp import stamp


@dataclass(frozen=True)
class Drawing:
    """Figures as SVG and animations as GIF, by name."""

    figures: dict[str, bytes] = field(default_factory=dict)
    animations: dict[str, bytes] = field(default_factory=dict)


def drawn(study: Study, data: Mapping[str, Data]) -> Drawing:
    """Return the figures and animations of a study as bytes."""
    with paper_style():
        figures = {name: as_svg(figure) for name, figure in study.draw(data).items()} if data else {}
        animations = study.animate(data) if data else {}
    return Drawing(figures, animations)


def drawing_stamp(data: Mapping[str, Data]) -> str:
    """Return what a drawing depends on: each number of the data, the code and the libraries."""
    digest = hashlib.sha256()
    for engine, arrays in data.items():
        for name, values in arrays.items():
            array = np.asarray(values)
            digest.update(repr((engine, name, array.dtype.str, array.shape)).encode())
            digest.update(array.tobytes())
    return stamp(digest.hexdigest())


@dataclass(frozen=True)
class DrawingStore:
    """A folder with one archive for each study that was drawn.

    Parameters
    ----------
    folder : Path
        Made when the first drawing is kept.

    """

    folder: Path

    def keep(self, study: str, stamp: str, drawing: Drawing) -> None:
        """Write the drawing; a file that is there is complete."""
        self.folder.mkdir(parents=True, exist_ok=True)
        with replacing(self._path(study), "wb") as stream, ZipFile(stream, "w", ZIP_DEFLATED) as archive:
            archive.comment = _comment(stamp, len(drawing.figures) + len(drawing.animations))
            for kind, files in vars(drawing).items():
                for name, content in files.items():
                    archive.writestr(f"{kind}/{name}", content)

    def find(self, study: str, stamp: str, names: Collection[str]) -> Drawing | None:
        """Return the drawing if it is there, legible, of this stamp, and has no other figures than ``names``."""
        found: dict[str, dict[str, bytes]] = {"figures": {}, "animations": {}}
        try:
            with ZipFile(self._path(study)) as archive:
                paths = archive.namelist()
                if archive.comment != _comment(stamp, len(paths)):
                    return None
                for path in paths:
                    kind, _, name = path.partition("/")
                    if name not in names:  # it may lead out of the report's folder
                        return None
                    found[kind][name] = archive.read(path)
        except Exception:  # whatever the libraries raise for a damaged file: then it is drawn again
            return None
        return Drawing(**found)

    def _path(self, study: str) -> Path:
        return self.folder / f"{study}.zip"


def _comment(stamp: str, files: int) -> bytes:
    """Return the archive's comment. A damaged table of contents may list fewer files than were written."""
    return f"{stamp} {files}".encode()
