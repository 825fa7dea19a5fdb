"""Rows of engines of other people, from what is recorded of them."""

from __future__ import annotations

import math
from typing import Any

from compare.claims.as_json import from_json
from compare.diagnosis.findings import Creep, Lag, Motion, falling
from compare.diagnosis.ladder import RUNGS
from compare.diagnosis.laws import Friction
from compare.diagnosis.row import Row
from compare.foreign.cases import CASES
from compare.foreign.records import COLUMNS, Recording, recordings
from reference_model.systems import FloatArray

TOLERANCE, ERROR, CHANGE, SECONDS = (
    COLUMNS.index(name) for name in ("tolerance", "error", "change", "seconds")
)

KINDS: dict[str, Any] = {"law": Friction, "creep": Creep, "lag": Lag}
"""What is recorded of each of ``PROBES``."""


def recorded_rows() -> tuple[Row, ...]:
    """Return a row for each recorded setting of an engine that is not ours."""
    return tuple(_row(recording) for recording in recordings() if recording.setting)


def _row(recording: Recording) -> Row:
    motions = {name: _motion(runs, name) for name, runs in recording.runs.items()}
    probes = {
        name: from_json(KINDS[name], content) for name, content in recording.probes.items() if name in KINDS
    }
    version = f"{recording.version}, recorded on {recording.recorded}"
    return Row(recording.name, version, motions=motions, **probes)


def _motion(runs: FloatArray, name: str) -> Motion:
    """Return the last rungs of a recorded ladder, whose last two changes are the estimate as in the report."""
    ratio = float(runs[-2, TOLERANCE] / runs[-1, TOLERANCE]) if len(runs) > 1 else math.nan
    changes = [change for change in runs[-2:, CHANGE].tolist() if math.isfinite(change)]
    return Motion(
        tuple(runs[-RUNGS:, ERROR].tolist()),
        sum(changes),
        falling(runs[-2:, ERROR], ratio),
        CASES[name].resolution,
        float(runs[-1, SECONDS]),
    )
