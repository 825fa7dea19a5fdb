"""``files:DIR``: motions that somebody computed beforehand as an engine, from a folder that ``plan`` has laid out.

``plan.json`` says which motions there are. Each is a file as ``0f3a.json`` with a question, of the form in which
programs are asked (``json_lines`` beside this), and waits for ``0f3a.csv`` with the answer: a line for each time,
with the time and the state, below a line of names if there is one. The names come from the questions: no answer is
taken for that to another one when there is another plan.
"""

from __future__ import annotations

import functools
import hashlib
import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from compare.engines.engine import KINDS, Engine, UnsupportedSystemError
from compare.engines.outside.json_lines import question
from compare.engines.registry import Scheme, register_scheme
from reference_model.systems import COLUMNS, FloatArray, System
from reference_model.trajectory import Trajectory

INDEX = "plan.json"

FORMAT = 1


class BadFileError(RuntimeError):
    """A file has something else in it than a motion; the message says in which line."""


@dataclass(frozen=True)
class MotionFiles:
    """The ``simulate`` that reads what stands in the folder ``folder``."""

    folder: str

    @property
    def files(self) -> set[Path]:
        """The plan and the motions."""
        return {Path(self.folder, INDEX), *Path(self.folder).glob("*.csv")}

    def __call__(
        self, system: System, initial_state: ArrayLike, times: ArrayLike, **accuracy: float
    ) -> Trajectory:
        """Return what the file of this motion says.

        Raises
        ------
        UnsupportedSystemError
            If it is not among those of the plan, is missing, or ends too early.
        BadFileError
            If the file holds anything else.

        """
        name = name_of(question(system, initial_state, times, accuracy))
        if name not in _names(self.folder):
            raise UnsupportedSystemError(
                f"{Path(self.folder).name} has no such motion: {INDEX} is of another version, "
                "or what is asked for depends on the answers"
            )
        return read_motion(Path(self.folder, f"{name}.csv"), system, np.array(times, dtype=float))


def name_of(line: bytes) -> str:
    """Return what the files of the motion of a question are called, without their endings."""
    return hashlib.sha256(line).hexdigest()[:12]


def read_motion(path: Path, system: System, times: FloatArray) -> Trajectory:
    """Return the motion of ``system`` at ``times`` (n,) in s that a file holds."""
    place = f"{path.parent.name}/{path.name}"
    try:
        lines = path.read_text(encoding="utf-8", errors="replace").splitlines()
    except FileNotFoundError:
        raise UnsupportedSystemError(f"{place} is missing") from None
    except OSError as error:
        raise BadFileError(f"cannot read {place}: {error.strerror}") from None
    columns = ("t", *(name for name, _ in COLUMNS[type(system)]))
    rows = [(number, line.split(",")) for number, line in enumerate(lines, 1) if line.strip()]
    if rows and not any(map(_is_number, rows[0][1])):
        rows = rows[1:]
    found = len(rows)
    if found < len(times) or (found == len(times) and len(rows[-1][1]) < len(columns)):
        whole = found - (1 if rows and len(rows[-1][1]) < len(columns) else 0)
        raise UnsupportedSystemError(
            f"{place} ends after {whole} of {len(times)} times, before t = {times[whole]:g} s"
        )
    if found > len(times):
        raise BadFileError(f"{place} has {found} rows: {len(times)} times were asked for")
    numbers = np.empty((found, len(columns)))
    for i, (number, row) in enumerate(rows):
        if len(row) != len(columns):
            raise BadFileError(
                f"{place}, line {number}, has {len(row)} numbers: it must have {len(columns)}, {', '.join(columns)}"
            )
        try:
            numbers[i] = row
        except ValueError:
            raise BadFileError(
                f"{place}, line {number}, is not made of numbers: {','.join(row)[:60]!r}"
            ) from None
        if not np.isfinite(numbers[i]).all():
            raise BadFileError(f"{place}, line {number}, has a number that is not finite")
    return Trajectory(system, numbers[:, 0], numbers[:, 1:])


def files_engine(text: str) -> Engine:
    """Return the engine "files:TEXT"; raise ``ValueError`` if the folder was laid out by no plan."""
    folder = str(Path(text or ".").resolve())
    content = _index(folder)
    return Engine(Path(folder).name, MotionFiles(folder), tuple(content["kinds"]), phases=False)


def _index(folder: str) -> dict[str, Any]:
    try:
        content: dict[str, Any] = json.loads(Path(folder, INDEX).read_text(encoding="utf-8"))
        if content["format"] != FORMAT or not set(content["kinds"]) <= set(KINDS):
            raise ValueError
        frozenset(content["motions"])
    except OSError as error:
        reason = f"{error.strerror}; write it with friction-discs plan"
    except (ValueError, KeyError, TypeError):
        reason = "it is not a plan of this version"
    else:
        return content
    raise ValueError(f"cannot read {Path(folder).name}/{INDEX}: {reason}")


@functools.cache
def _names(folder: str) -> frozenset[str]:
    return frozenset(_index(folder)["motions"])


def _is_number(word: str) -> bool:
    try:
        float(word)
    except ValueError:
        return False
    return True


register_scheme("files", Scheme(files_engine, files_engine))
