"""What foreign engines yield, recorded by ``builders/record.py``, and our own engines recorded with them."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from reference_model.systems import FloatArray

FOLDER = Path(__file__).parent

COLUMNS = ("tolerance", "steps", "error", "change", "seconds", "wall")
"""Of a recorded run.

The error in m is the largest over time, against the exact motion; the change is that against the run before, whose
tolerance is larger by ``compare.claims.error_estimates.COARSENING``, and none at the first. Seconds are those of
the processor, wall those on the clock; of an engine that is another process both are those on the clock.
"""

TOLERANCE, STEPS, ERROR, CHANGE, SECONDS, WALL = range(len(COLUMNS))
"""Places of ``COLUMNS`` in a recorded run."""

DIGITS = 4
"""Of the numbers in the files."""


@dataclass(frozen=True, eq=False)
class Recording:
    """One setting of an engine.

    Parameters
    ----------
    engine, version, recorded, platform : str
        What ran, when and on what.
    setting : str
        Its name; "" for an engine of ours.
    says : str
        How it is set, in words.
    runs : mapping
        Of each case that it simulates, by the names of ``compare.foreign.cases.CASES``: arrays of shape
        (n, len(COLUMNS)), from the largest tolerance to the smallest.
    probes : mapping
        What tells the law of friction, as JSON of the parts ``compare.diagnosis.findings.PROBES``; empty where it is
        not recorded.

    """

    engine: str
    version: str
    recorded: str
    platform: str
    setting: str
    says: str
    runs: Mapping[str, FloatArray]
    probes: Mapping[str, Any]

    @property
    def name(self) -> str:
        """Engine and setting."""
        return f"{self.engine}, {self.setting}" if self.setting else self.engine


def recordings() -> tuple[Recording, ...]:
    """Return all that is recorded, our own engines first, the reference before the others.

    Raises
    ------
    ValueError
        For a file whose columns are not ``COLUMNS``.

    """
    found: list[Recording] = []
    for path in sorted(FOLDER.glob("*.json")):
        file = json.loads(path.read_text(encoding="utf-8"))
        if tuple(file["columns"]) != COLUMNS:
            raise ValueError(f"{path.name}: columns = {file['columns']}: they must be {list(COLUMNS)}")
        about = {key: file[key] for key in ("engine", "version", "recorded", "platform")}
        for setting in file["settings"]:
            runs = {case: np.array(rows, dtype=float) for case, rows in setting["runs"].items()}
            own = {"setting": setting["name"], "says": setting["says"], "probes": setting.get("probes", {})}
            found.append(Recording(**about, **own, runs=runs))
    return tuple(sorted(found, key=lambda it: (it.setting != "", it.engine != "reference", it.engine)))


def estimate(runs: FloatArray) -> float:
    """Return the error estimate in m of the finest of ``runs``, from their ladder: what its last two rungs changed.

    With an error ~ step^p and two halvings that is (4^p − 1) times the error: three times it at order 1, and it
    covers it from order 1/2 on. A ladder of one run, which nothing changes, has an error of rounding.
    """
    return float(np.nansum(runs[-2:, CHANGE]))
