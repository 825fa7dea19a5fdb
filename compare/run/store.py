"""Findings and drawings on disk, valid for the version of the code that made them."""

from __future__ import annotations

import hashlib
import json
import lzma
import re
from collections.abc import Collection, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from zipfile import ZIP_DEFLATED, ZipFile

import numpy as np

from compare.claims.as_json import claim_as_json, claim_from_json
from compare.claims.study import Data, Findings, Study
from compare.output.figures import as_svg, paper_style
from compare.output.outside_text import all_printable
from compare.output.text_files import replacing
from compare.run.provenance import stamp

# --- Findings on disk: claims as compressed JSON, arrays as NPZ, valid for the version of the code that made them.
#
# joblib and diskcache would pickle results, which is neither readable nor safe to share.

LONGEST = 100
"""Largest number of readable characters of a file name; a program's name may exceed the limit of the file system."""


@dataclass(frozen=True)
class Store:
    """A folder with one pair of files for each finished piece of work.

    Parameters
    ----------
    folder : Path
        Folder, made with the first findings.

    """

    folder: Path

    def keep(self, study: str, engine: str, stamp: str | None, findings: Findings, seconds: float) -> None:
        """Write the findings; existing files are always complete. Findings without a stamp are never found again."""
        self.folder.mkdir(parents=True, exist_ok=True)
        path = self._path(study, engine)
        with replacing(path.with_suffix(".npz"), "wb") as stream:
            np.savez_compressed(stream, **findings.data)  # type: ignore[arg-type]
        content = {
            "study": study,
            "engine": engine,
            "stamp": stamp,
            "seconds": seconds,
            "not_simulated": findings.not_simulated,
            "arrays": list(findings.data),
            "claims": [claim_as_json(claim) for claim in findings.claims],
        }
        with replacing(self._json(study, engine), "wb") as stream:
            stream.write(lzma.compress(json.dumps(content).encode(), preset=1))

    def find(
        self, study: str, engine: str, stamp: str | None, identities: Collection[str] = ()
    ) -> tuple[Findings, float] | None:
        """Return the findings and their duration in s; None if they are missing, damaged or have another stamp.

        Claims must have one of the ``identities`` or none, because they become file names of the report.
        """
        path = self._path(study, engine)
        try:
            raw = lzma.decompress(self._json(study, engine).read_bytes())
            content = all_printable(json.loads(raw))
            if stamp is None or content["stamp"] != stamp:
                return None
            claims = tuple(claim_from_json(claim) for claim in content["claims"])
            if not {claim.identity for claim in claims} <= {"", *identities}:
                return None
            with np.load(path.with_suffix(".npz"), allow_pickle=False) as arrays:
                data = {name: arrays[name] for name in arrays.files}
            if list(data) != content["arrays"]:  # a damaged table of contents may list fewer
                return None
            return Findings(claims, data, content["not_simulated"]), float(content["seconds"])
        except Exception:  # any error of the libraries in a damaged file: compute the findings again
            return None

    def _json(self, study: str, engine: str) -> Path:
        return self._path(study, engine).with_suffix(".json.xz")

    def _path(self, study: str, engine: str) -> Path:
        # The digest makes names unique, even on file systems that ignore case; the words are for people.
        words = re.sub(r"[^\w-]", "_", f"{study}--{engine}", flags=re.ASCII)[:LONGEST]
        digest = hashlib.sha256(repr((study, engine)).encode()).hexdigest()[:16]
        return self.folder / f"{words}--{digest}"


# --- Drawings of studies on disk; equal data drawn by equal code give equal files.


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
    """Return the digest of all that a drawing depends on: data, code and libraries."""
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
        Folder, made with the first drawing.

    """

    folder: Path

    def keep(self, study: str, stamp: str, drawing: Drawing) -> None:
        """Write the drawing; an existing file is always complete."""
        self.folder.mkdir(parents=True, exist_ok=True)
        with replacing(self._path(study), "wb") as stream, ZipFile(stream, "w", ZIP_DEFLATED) as archive:
            archive.comment = _comment(stamp, len(drawing.figures) + len(drawing.animations))
            for kind, files in vars(drawing).items():
                for name, content in files.items():
                    archive.writestr(f"{kind}/{name}", content)

    def find(self, study: str, stamp: str, names: Collection[str]) -> Drawing | None:
        """Return the drawing; None if it is missing, damaged, has another stamp or figures not in ``names``."""
        found: dict[str, dict[str, bytes]] = {"figures": {}, "animations": {}}
        try:
            with ZipFile(self._path(study)) as archive:
                paths = archive.namelist()
                if archive.comment != _comment(stamp, len(paths)):
                    return None
                for path in paths:
                    kind, _, name = path.partition("/")
                    if name not in names:  # it may point outside the report
                        return None
                    found[kind][name] = archive.read(path)
        except Exception:  # any error of the libraries in a damaged file: draw the figures again
            return None
        return Drawing(**found)

    def _path(self, study: str) -> Path:
        return self.folder / f"{study}.zip"


def _comment(stamp: str, files: int) -> bytes:
    """Return the archive's comment, with the number of files because a damaged table of contents may list fewer."""
    return f"{stamp} {files}".encode()
