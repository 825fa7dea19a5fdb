"""Rows of engines of other people, from what is recorded of them."""

from __future__ import annotations

import math

from compare.claims.as_json import from_json
from compare.claims.error_estimates import ROUNDING
from compare.diagnosis.findings import PROBES, Motion, falling
from compare.diagnosis.ladder import RUNGS
from compare.diagnosis.row import Row
from compare.foreign.cases import CASES
from compare.foreign.records import ERROR, SECONDS, TOLERANCE, Recording, estimate, recordings
from reference_model.systems import FloatArray


def recorded_rows() -> tuple[Row, ...]:
    """Return a row for each recorded setting of an engine that is not ours."""
    return tuple(row_of(recording) for recording in recordings() if recording.setting)


def row_of(recording: Recording) -> Row:
    """Return the row of one setting of an engine, or of an engine of ours, of which no law is recorded."""
    motions = {name: _motion(runs, name) for name, runs in recording.runs.items()}
    probes = {name: from_json(PROBES[name], content) for name, content in recording.probes.items()}
    version = f"{recording.version}, recorded on {recording.recorded}"
    lacking = tuple(name for name in CASES if name not in recording.runs)
    return Row(recording.name, version, motions=motions, not_simulated=lacking, **probes)


def _motion(runs: FloatArray, name: str) -> Motion:
    """Return the last rungs of a recorded ladder, with the estimate that the report has."""
    ratio = float(runs[-2, TOLERANCE] / runs[-1, TOLERANCE]) if len(runs) > 1 else math.nan
    return Motion(
        tuple(runs[-RUNGS:, ERROR].tolist()),
        estimate(runs) + ROUNDING * max(map(abs, CASES[name].start)),
        falling(runs[-2:, ERROR], ratio),
        CASES[name].resolution,
        float(runs[-1, SECONDS]),
    )
