"""Trajectories as CSV or JSON files."""

import json
from collections.abc import Callable
from pathlib import Path
from typing import IO

from compare.claims.as_json import as_json
from compare.run.provenance import version_of
from reference_model.systems import COLUMNS
from reference_model.trajectory import Trajectory


def writer(path: Path) -> Callable[[Trajectory, str, IO[str]], None]:
    """Return the function that writes the format of ``path``; raise ``ValueError`` for an unknown suffix."""
    if path.suffix not in WRITERS:
        raise ValueError(f"unknown format of {path.name!r}: the file name must end in {' or '.join(WRITERS)}")
    return WRITERS[path.suffix]


def write_csv(trajectory: Trajectory, engine: str, stream: IO[str]) -> None:
    """Write column names with units, then one line per time."""
    header = [("t", "s"), *COLUMNS[type(trajectory.system)]]
    stream.write(",".join(f"{name} [{unit}]" for name, unit in header) + "\n")
    for time, state in zip(trajectory.times, trajectory.states, strict=True):
        stream.write(",".join(repr(float(value)) for value in (time, *state)) + "\n")


def write_json(trajectory: Trajectory, engine: str, stream: IO[str]) -> None:
    """Write the motion with parameters, phases and details of its solution."""
    columns = COLUMNS[type(trajectory.system)]
    content = {
        "version": version_of("friction-discs"),
        "engine": engine,
        "system": type(trajectory.system).__name__,
        "parameters": as_json(trajectory.system),
        "columns": [name for name, _ in columns],
        "units": {"t": "s", **dict(columns)},
        "phases": as_json(trajectory.phases),
        "solution": as_json(trajectory.solution),
        "times": as_json(trajectory.times),
        "states": as_json(trajectory.states),
    }
    json.dump(content, stream, ensure_ascii=False, allow_nan=False)
    stream.write("\n")


WRITERS: dict[str, Callable[[Trajectory, str, IO[str]], None]] = {".csv": write_csv, ".json": write_json}
