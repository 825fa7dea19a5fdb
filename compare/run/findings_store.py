"""Findings on disk: claims as compressed JSON, arrays as NPZ, valid for the version of the code that made them.

Libraries that keep results of functions (joblib, diskcache) pickle them: that is neither legible nor safe to pass on.
"""

from __future__ import annotations

import hashlib
import json
import lzma
import re
from collections.abc import Collection
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from compare.claims.as_json import claim_as_json, claim_from_json
from compare.claims.study import Findings
from compare.output.outside_text import all_printable
from compare.output.text_files import replacing

LONGEST = 100
"""Letters of a file's name that say what is in it: the name of a program may be longer than a file's may be."""


@dataclass(frozen=True)
class Store:
    """A folder with one pair of files for each finished piece of work.

    Parameters
    ----------
    folder : Path
        Made when the first findings are kept.

    """

    folder: Path

    def keep(self, study: str, engine: str, stamp: str | None, findings: Findings, seconds: float) -> None:
        """Write the findings; a file that is there is complete. Without a stamp they are never found again."""
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
        """Return findings and their seconds if they are there, legible, and of this stamp.

        A claim of theirs must have one of the ``identities`` or none, since files of the report have its name.
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
        except Exception:  # whatever the libraries raise for a damaged file: then it is computed again
            return None

    def _json(self, study: str, engine: str) -> Path:
        return self._path(study, engine).with_suffix(".json.xz")

    def _path(self, study: str, engine: str) -> Path:
        # Names differ by the digest alone, also on file systems that ignore case; the words are for people.
        words = re.sub(r"[^\w-]", "_", f"{study}--{engine}", flags=re.ASCII)[:LONGEST]
        digest = hashlib.sha256(repr((study, engine)).encode()).hexdigest()[:16]
        return self.folder / f"{words}--{digest}"
