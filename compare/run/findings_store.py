"""Findings on disk: claims as JSON, arrays as NPZ, valid for the version of the code that made them."""

from __future__ import annotations

import hashlib
import json
import math
import re
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any
from zipfile import BadZipFile

import numpy as np

from compare.claims.claim import Claim, ErrorBudget
from compare.claims.study import Findings
from compare.text_files import replacing, write_text
from reference_model.systems import FloatArray

ROOT = Path(__file__).resolve().parents[2]
"""Where the packages are."""

PACKAGES = ("reference_model", "exudyn_models", "compare")
LIBRARIES = ("numpy", "scipy", "exudyn", "numba")


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
            "claims": [claim_as_json(claim) for claim in findings.claims],
        }
        write_text(path.with_suffix(".json"), json.dumps(content, indent=1, ensure_ascii=False))

    def find(self, study: str, engine: str, stamp: str | None) -> tuple[Findings, float] | None:
        """Return findings and their seconds if they are there, legible, and of this stamp."""
        path = self._path(study, engine)
        try:
            content = json.loads(path.with_suffix(".json").read_text(encoding="utf-8"))
            if stamp is None or content["stamp"] != stamp:
                return None
            claims = tuple(claim_from_json(claim) for claim in content["claims"])
            with np.load(path.with_suffix(".npz"), allow_pickle=False) as arrays:
                data = {name: arrays[name] for name in arrays.files}
            return Findings(claims, data, content["not_simulated"]), float(content["seconds"])
        except (OSError, EOFError, BadZipFile, ValueError, KeyError, TypeError):  # so it is computed again
            return None

    def _path(self, study: str, engine: str) -> Path:
        # no dot: with_suffix would take it for a suffix
        return self.folder / re.sub(r"[^\w-]", "_", f"{study}--{engine}")


def stamp(*fingerprints: str, code: Sequence[str] = PACKAGES, libraries: Sequence[str] = LIBRARIES) -> str:
    """Return what findings depend on: packages or modules ``code``, libraries, and what else has a fingerprint."""
    digest = hashlib.sha256("".join([_digest(ROOT, tuple(code)), *fingerprints]).encode())
    versions = " ".join(f"{name}-{version_of(name)}" for name in libraries)
    if "exudyn" in libraries:
        versions += f" exudyn-user-settings-{exudyn_user_settings()}"
    return f"{version_of('friction-discs')} {digest.hexdigest()[:16]} {versions}"


def version_of(distribution: str) -> str:
    """Return the installed version, "none" where it isn't installed."""
    try:
        return version(distribution)
    except PackageNotFoundError:
        return "none"


def exudyn_user_settings() -> str:
    """Return "off", or "on" where Exudyn was imported before a study and has found a user's own settings."""
    found = sys.modules.get("exudyn.misc.overrideSettings")
    return "on" if found is not None and found.Applied() else "off"


@cache
def _digest(root: Path, code: tuple[str, ...]) -> str:
    """Return what the files below ``root`` of the packages or modules ``code`` come to."""
    digest = hashlib.sha256()
    for name in code:
        place = root.joinpath(*name.split("."))
        files = [path for kind in ("*.py", "*.json") for path in place.rglob(kind)]
        for path in sorted(files) if place.is_dir() else [place.with_suffix(".py")]:
            digest.update(path.relative_to(root).as_posix().encode())
            digest.update(path.read_bytes())
    return digest.hexdigest()


def claim_as_json(claim: Claim) -> dict[str, Any]:
    """Return the claim as JSON values; ``claim_from_json`` gives the same claim again, to the last bit."""
    return {
        "sentence": claim.sentence,
        "equation": claim.equation,
        "kind": claim.kind,
        "engine": claim.engine,
        "unit": claim.unit,
        "predicted": numbers_as_json(claim.predicted),
        "measured": numbers_as_json(claim.measured),
        "difference": numbers_as_json(claim.difference),
        "numerical_error": numbers_as_json(claim.budget.numerical),
        "model_error": claim.budget.model,
        "resolution": number_as_json(claim.budget.resolution),
        "verdict": claim.verdict.value,
        "parameters": {name: _parameter_as_json(value) for name, value in claim.parameters.items()},
        "source": claim.source,
        "note": claim.note,
        "basis": claim.basis,
        "implied_by": claim.implied_by,
        "answers": claim.answers,
        "named": dict(claim.named),
        "id": claim.identity,
        "axes": [list(names) for names in claim.axes],
    }


def claim_from_json(content: dict[str, Any]) -> Claim:
    """Return the claim of ``claim_as_json``."""
    return Claim(
        content["sentence"],
        equation=content["equation"],
        kind=content["kind"],
        engine=content["engine"],
        predicted=numbers_from_json(content["predicted"]),
        measured=numbers_from_json(content["measured"]),
        budget=ErrorBudget(
            numbers_from_json(content["numerical_error"]),
            model=content["model_error"],
            resolution=float(content["resolution"]),
        ),
        parameters=content["parameters"],
        source=content["source"],
        unit=content["unit"],
        note=content["note"],
        basis=content["basis"],
        implied_by=content["implied_by"],
        answers=content["answers"],
        named=content["named"],
        identity=content["id"],
        axes=content["axes"],
    )


def number_as_json(value: float) -> float | str:
    """Return a number, or "nan", "inf", "-inf", which JSON has no numbers for; ``float`` reads both."""
    return float(value) if math.isfinite(value) else str(float(value))


def numbers_as_json(values: FloatArray) -> Any:
    """Return a number, or nested lists of them, for an array of any shape."""
    if values.ndim == 0:
        return number_as_json(float(values))
    return [numbers_as_json(value) for value in np.asarray(values)]


def numbers_from_json(content: Any) -> FloatArray:
    """Return the array of ``numbers_as_json``."""
    return np.array(content, dtype=float)


def _parameter_as_json(value: Any) -> Any:
    """Return a parameter's value; what is no number (a list of speeds, a word) stays as it is."""
    if isinstance(value, (float, np.floating)):
        return number_as_json(float(value))
    if isinstance(value, np.ndarray):
        return numbers_as_json(value)
    return value.item() if isinstance(value, np.generic) else value
