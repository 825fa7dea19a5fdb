"""Findings and drawings on disk, valid for the version of the code that made them."""

import hashlib
import io
import json
import re
from collections.abc import Callable, Collection, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import TypeVar
from zipfile import ZIP_DEFLATED, ZipFile

import numpy as np

from compare.claims.as_json import claim_as_json, claim_from_json
from compare.claims.study import Data, Findings, Study
from compare.output.figures import as_svg, paper_style
from compare.output.outside_text import all_printable
from compare.output.text_files import read_file, replacing
from compare.run.provenance import stamp

# --- Archives: contents by path, each with a checksum, valid for the version of the code that made them.
#
# joblib and diskcache would pickle results, which is neither readable nor safe to share.

LONGEST = 100
"""Largest number of readable characters of a file name, because file systems limit it."""

Value = TypeVar("Value")


@dataclass(frozen=True)
class _Archives:
    """A folder with an archive for each finished piece of work."""

    folder: Path

    def _keep(self, key: tuple[str, ...], stamp: str | None, contents: Mapping[str, bytes]) -> None:
        """Write an archive; without a stamp it is never found again."""
        self.folder.mkdir(parents=True, exist_ok=True)
        with replacing(self._path(key), "wb") as stream, ZipFile(stream, "w", ZIP_DEFLATED) as archive:
            archive.comment = _comment(stamp, contents)
            for path, content in contents.items():
                archive.writestr(path, content)

    def _find(
        self, key: tuple[str, ...], stamp: str | None, restored: Callable[[dict[str, bytes]], Value | None]
    ) -> Value | None:
        try:
            with ZipFile(io.BytesIO(read_file(self._path(key)))) as archive:
                contents = {path: archive.read(path) for path in archive.namelist()}
            return (
                None if stamp is None or archive.comment != _comment(stamp, contents) else restored(contents)
            )
        except Exception:  # any error of the libraries in a damaged file
            return None

    def _path(self, key: tuple[str, ...]) -> Path:
        # The digest makes names unique, even on file systems that ignore case.
        words = re.sub(r"[^\w-]", "_", "--".join(key), flags=re.ASCII)[:LONGEST]
        return self.folder / f"{words}--{hashlib.sha256(repr(key).encode()).hexdigest()[:16]}.zip"


def _comment(stamp: str | None, contents: Mapping[str, bytes]) -> bytes:
    """Return the archive's comment, which binds the stamp to the contents, so changed numbers are measured again."""
    facts = (stamp, sorted(contents.items()))
    return hashlib.sha256(repr(facts).encode()).hexdigest().encode()


# --- Findings: claims as JSON, arrays as NPZ.


class Store(_Archives):
    """Findings of each study and engine."""

    def keep(self, study: str, engine: str, stamp: str | None, findings: Findings, seconds: float) -> None:
        """Write the findings and their duration in s."""
        arrays = io.BytesIO()
        np.savez(arrays, **findings.data)  # type: ignore[arg-type]
        content = {
            "seconds": seconds,
            "not_simulated": findings.not_simulated,
            "claims": [claim_as_json(claim) for claim in findings.claims],
        }
        files = {"findings.json": json.dumps(content).encode(), "arrays.npz": arrays.getvalue()}
        self._keep((study, engine), stamp, files)

    def find(
        self, study: str, engine: str, stamp: str | None, identities: Collection[str] = ()
    ) -> tuple[Findings, float] | None:
        """Return the findings and their duration in s; None if they are missing, damaged or have another stamp.

        Claims must have one of the ``identities`` or none, because they become file names.
        """

        def restored(files: dict[str, bytes]) -> tuple[Findings, float] | None:
            content = all_printable(json.loads(files["findings.json"]))
            claims = tuple(claim_from_json(claim) for claim in content["claims"])
            if not {claim.identity for claim in claims} <= {"", *identities}:
                return None
            with np.load(io.BytesIO(files["arrays.npz"]), allow_pickle=False) as arrays:
                data = {name: arrays[name] for name in arrays.files}
            return Findings(claims, data, content["not_simulated"]), float(content["seconds"])

        return self._find((study, engine), stamp, restored)


# --- Drawings of studies on disk; equal data drawn by equal code give equal files.


@dataclass(frozen=True)
class Drawing:
    """Figures as SVG and animations as GIF, by name."""

    figures: dict[str, bytes] = field(default_factory=dict)
    animations: dict[str, bytes] = field(default_factory=dict)


def drawn(study: Study, data: Mapping[str, Data], partial: Sequence[str] = ()) -> Drawing:
    """Return the figures and animations of a study as bytes.

    The engines in ``partial`` lack claims. An engine is left out if a figure needs the data of these claims. If the
    others lack data too, each engine is tried.
    """
    shown = {name: arrays for name, arrays in data.items() if name not in partial}
    try:
        found = _drawn(study, shown)
    except KeyError:
        if len(shown) < 2:
            raise
        return drawn(study, data, tuple(data))
    for engine in partial:
        more = {name: arrays for name, arrays in data.items() if name in {*shown, engine}}
        with suppress(KeyError):
            found, shown = _drawn(study, more), more
    return found


def _drawn(study: Study, data: Mapping[str, Data]) -> Drawing:
    with paper_style():
        figures = {name: as_svg(figure) for name, figure in study.draw(data).items()} if data else {}
        animations = study.animate(data) if data else {}
    return Drawing(figures, animations)


def drawing_stamp(data: Mapping[str, Data]) -> str:
    """Return the digest of data, code and libraries."""
    digest = hashlib.sha256()
    for engine, arrays in data.items():
        for name, values in arrays.items():
            array = np.asarray(values)
            digest.update(repr((engine, name, array.dtype.str, array.shape)).encode())
            digest.update(array.tobytes())
    return stamp(digest.hexdigest())


class DrawingStore(_Archives):
    """Drawings of each study."""

    def keep(self, study: str, stamp: str, drawing: Drawing) -> None:
        """Write the drawing."""
        contents = {
            f"{kind}/{name}": content
            for kind, files in vars(drawing).items()
            for name, content in files.items()
        }
        self._keep((study,), stamp, contents)

    def find(self, study: str, stamp: str, names: Collection[str]) -> Drawing | None:
        """Return the drawing; None if it is missing, damaged, has another stamp or figures not in ``names``."""

        def restored(contents: dict[str, bytes]) -> Drawing | None:
            drawing = Drawing()
            for path, content in contents.items():
                kind, _, name = path.partition("/")
                if name not in names:  # it may point outside the report
                    return None
                getattr(drawing, kind)[name] = content
            return drawing

        return self._find((study,), stamp, restored)
