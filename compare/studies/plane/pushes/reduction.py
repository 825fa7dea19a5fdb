"""Reduction of the logs of measured planar pushes to one row per push.

The logs come from the repository robinzhoucmu/MLab_EXP, commit 4d86db94, folder PushExp/sensor_log (J. Zhou, Carnegie
Mellon University, 2015, Apache-2.0) and are not part of this project. ``reduced.csv`` contains the rows;
``friction-discs report pushes --data FOLDER`` compares them with the logs.

Choices, and their effect on a series' median error of the force's direction, which is 5 to 9 degrees:

- Only the first and last poses are recorded, so a body is assumed to move straight and turn uniformly. Displacement
  and force are in its axes halfway. The axes of the first pose, with a linearised displacement, raise the median by
  up to 8.3 degrees.
- The mean force excludes the first 30 % of the samples (``SETTLING``), while the pusher closes a gap of 2.5 mm and
  the load settles. Shares from 20 % to 50 % change the median by at most 0.8 degrees and the work by at most 8 %; a
  start 0.2 s after the force exceeds 1 N, by at most 0.4 degrees and 2 %.
- The first sample is the sensor's offset, as in the authors' work; the mean of the first 20 changes the median by at
  most 0.5 degrees.
- The force acts at the hand's final position. Its initial position changes the median error of the wrench by at most
  2 degrees, and the work by at most 4 %.
"""

from __future__ import annotations

import csv
import lzma
import math
import re
from collections.abc import Iterator, Sequence
from dataclasses import astuple, dataclass, fields
from importlib.resources import files
from pathlib import Path
from typing import Any

import numpy as np

from reference_model.systems import FloatArray

SETTLING = 0.3
"""Share of a push's samples that the mean force excludes."""

AT_REST = 20
"""Samples before contact; their scatter is the sensor's noise."""

SENSOR = np.array([[1.0, 1.0], [1.0, -1.0]]) / math.sqrt(2.0)
"""Minus the map from the sensor's components to the force on the body, in the hand's axes."""

NAMES = re.compile(r"((?:wood_)?(?:\d+(?:_\d+){5}|patch))-exp_.*\.txt(?:\.xz)?")
"""File names of logs; the first group names the series."""

TOLERANCE = 1e-6
"""Largest difference between the table and a log, in mm, rad or N."""


@dataclass(frozen=True)
class Push:
    """One measured push, the ``number``-th of its log.

    - ``series``: "wood" or nothing for the board, then the positions of three feet or "patch".
    - ``samples``: number of force samples.
    - ``x``, ``y``, ``turn``: displacement (mm) of the body's origin, in the axes halfway, and rotation (rad).
    - ``lift``, ``tilt_x``, ``tilt_y``: changes of height (mm) and tilts (rad), which are errors on a flat surface.
    - ``force_x``, ``force_y``: mean force of the pusher on the body (N), in the axes halfway.
    - ``noise``: standard deviation (N) of a force component before contact.
    - ``start_x``, ``start_y``, ``end_x``, ``end_y``: first and last position of the hand (mm) in the body's frame.
    """

    series: str
    number: int
    samples: int
    x: float
    y: float
    turn: float
    lift: float
    tilt_x: float
    tilt_y: float
    force_x: float
    force_y: float
    noise: float
    start_x: float
    start_y: float
    end_x: float
    end_y: float


def reduce_log(path: Path) -> list[Push]:
    """Return the pushes of a log, a text file that may be compressed by xz.

    Raise ``ValueError`` if its name or content is invalid, and ``OSError`` if it cannot be read.
    """
    name = NAMES.fullmatch(path.name)
    if name is None:
        raise ValueError(f"{path}: the name of a log is like 10_90_10_10_30_130-exp_08_15_50.txt.xz")
    raw = path.read_bytes()
    try:
        lines = iter((lzma.decompress(raw) if path.suffix == ".xz" else raw).decode().splitlines())
    except (lzma.LZMAError, UnicodeDecodeError) as error:
        raise ValueError(f"{path}: {error}") from None
    log = _Log(path, lines)
    pushes = [_reduced(name[1], i + 1, log) for i in range(log.count("the number of pushes"))]
    if any(line.strip() for line in lines):
        raise log.fault(f"more lines follow the last of {len(pushes)} pushes")
    return pushes


@dataclass
class _Log:
    """Unread lines of a log, and the number of the last line read."""

    path: Path
    lines: Iterator[str]
    line: int = 0

    def rows(self, rows: int, columns: int, what: str) -> FloatArray:
        found = []
        for _ in range(rows):
            text, self.line = next(self.lines, ""), self.line + 1
            try:
                numbers = [float(word) for word in text.split()]
            except ValueError:
                numbers = []
            if len(numbers) != columns or not np.isfinite(numbers).all():
                raise self.fault(f"{text[:40]!r} is not {what}: expected {columns} numbers")
            found.append(numbers)
        return np.array(found)

    def count(self, what: str, least: int = 1) -> int:
        """Return the next line as a whole number; raise ``ValueError`` unless it is at least ``least``."""
        number = float(self.rows(1, 1, what)[0, 0])
        if number < least or not number.is_integer():
            raise self.fault(f"{what} is {number:g}: it must be a whole number >= {least}")
        return int(number)

    def fault(self, problem: str) -> ValueError:
        return ValueError(f"{self.path}, line {self.line}: {problem}")


def _reduced(series: str, number: int, log: _Log) -> Push:
    before, after = log.rows(2, 7, "a pose of the body")
    samples = log.count("the number of samples of the force", least=AT_REST + 1)
    forces = log.rows(samples, 3, "a sample of the force")[:, 1:]
    hand = log.rows(log.count("the number of poses of the hand", least=2), 8, "a pose of the hand")[:, 1:]
    first, last = heading(before), heading(after)
    turn = math.remainder(last - first, 2.0 * math.pi)
    middle = first + 0.5 * turn
    on_body = -(forces - forces[0]) @ SENSOR.T
    mean = on_body[int(SETTLING * len(forces)) :].mean(axis=0)
    shift = turned(after[:2] - before[:2], -middle)
    return Push(
        series=series,
        number=number,
        samples=len(forces),
        turn=turn,
        lift=float(after[2] - before[2]),
        noise=float(forces[:AT_REST].std(axis=0).mean()),
        **_components("", shift),
        **_components("tilt_", tilt(after) - tilt(before)),
        **_components("force_", turned(mean, heading(hand[0]) - middle)),
        **_components("start_", turned(hand[0, :2] - before[:2], -first)),
        **_components("end_", turned(hand[-1, :2] - after[:2], -last)),
    )


def _components(name: str, vector: FloatArray) -> dict[str, Any]:
    return {f"{name}x": float(vector[0]), f"{name}y": float(vector[1])}


def heading(pose: FloatArray) -> float:
    """Return the rotation (rad) about the vertical of a pose: x, y, z (mm) and a quaternion."""
    w, x, y, z = pose[3:]
    return math.atan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z))


def tilt(pose: FloatArray) -> FloatArray:
    """Return the small rotations (rad) about the horizontal axes, shape (2,)."""
    w, x, y, z = pose[3:]
    return 2.0 * np.array([w * x + y * z, w * y - x * z])


def turned(vector: FloatArray, angle: float) -> FloatArray:
    cosine, sine = math.cos(angle), math.sin(angle)
    return np.array([[cosine, -sine], [sine, cosine]]) @ vector


SOURCE = """\
# Measured planar pushes, reduced by compare/studies/plane/pushes/reduction.py from the logs of the repository
# robinzhoucmu/MLab_EXP, commit 4d86db94, folder PushExp/sensor_log (J. Zhou, Carnegie Mellon University, 2015).
# Licence of the logs and of this table: Apache-2.0 (https://www.apache.org/licenses/LICENSE-2.0).
# Units: mm, rad and N; a description of each column is in the module.
"""

HEADINGS = [field.name for field in fields(Push)]


def table(pushes: Sequence[Push]) -> str:
    """Return the pushes as comma-separated values, after comments about their source."""
    rows = (
        ",".join(f"{value:.9g}" if isinstance(value, float) else str(value) for value in astuple(push))
        for push in pushes
    )
    return SOURCE + "\n".join([",".join(HEADINGS), *rows, ""])


def reduced_pushes() -> tuple[Push, ...]:
    text = files("compare.studies.plane.pushes").joinpath("reduced.csv").read_text(encoding="utf-8")
    lines = (line for line in text.splitlines() if not line.startswith("#"))
    kinds = (str, int, int, *[float] * (len(HEADINGS) - 3))
    return tuple(
        Push(*(kind(row[name]) for kind, name in zip(kinds, HEADINGS, strict=True)))
        for row in csv.DictReader(lines)
    )


def check_table(folder: Path) -> tuple[list[str], list[Push]]:
    """Compare the table with the logs in ``folder``.

    Return the names of the series that agree, and the pushes of other series. Raise ``ValueError`` if there are no
    logs, a log is invalid or a number differs.
    """
    logs = sorted(path for path in folder.iterdir() if NAMES.fullmatch(path.name)) if folder.is_dir() else []
    if not logs:
        raise ValueError(
            f"--data {folder}: no such folder, or it contains no logs like 10_90_10_10_30_130-exp_08_15_50.txt.xz"
        )
    known = reduced_pushes()
    agreeing, new = [], []
    for log in logs:
        pushes = reduce_log(log)
        rows = [push for push in known if push.series == pushes[0].series]
        if not rows:
            new += pushes
            continue
        if len(rows) != len(pushes):
            raise ValueError(
                f"{log} has {len(pushes)} pushes, but the table of reduced pushes has {len(rows)}"
            )
        for mine, theirs in zip(rows, pushes, strict=True):
            if not np.allclose(astuple(mine)[1:], astuple(theirs)[1:], rtol=0.0, atol=TOLERANCE):
                raise ValueError(f"{log}: push {mine.number} differs from the table of reduced pushes")
        agreeing.append(pushes[0].series)
    return agreeing, new
