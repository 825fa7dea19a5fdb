"""``files:DIR``: motions computed beforehand as an engine, in a folder created by ``plan``.

``plan.json`` lists the motions. A file such as ``0f3a.json``, named by a hash, contains a question of ``json_lines``,
and ``0f3a.csv`` its answer.
"""

import functools
import hashlib
import json
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from compare.engines.engine import KINDS, DeclaredLackError, Engine, UnsupportedSystemError
from compare.engines.outside.json_lines import question
from compare.engines.registry import Scheme, register_scheme
from compare.output.outside_text import printable
from reference_model.systems import COLUMNS, FloatArray
from reference_model.systems.joint import AnySystem
from reference_model.trajectory import Trajectory

INDEX = "plan.json"

FORMAT = 1

POINTS = "separate columns by commas, and write decimal points, not decimal commas"


ROUNDED = 5e-12  # largest relative error of a time with 12 digits


class BadFileError(RuntimeError):
    """A file does not contain a valid motion; the message names the line."""


@dataclass(frozen=True)
class MotionFiles:
    """A ``simulate`` that reads its motions from ``folder``."""

    folder: str

    @property
    def files(self) -> set[Path]:
        """Plan and motions."""
        return {Path(self.folder, INDEX), *Path(self.folder).glob("*.csv")}

    def __call__(
        self, system: AnySystem, initial_state: ArrayLike, times: ArrayLike, **accuracy: float
    ) -> Trajectory:
        """Return this motion from its file.

        Raises ``DeclaredLackError`` if the motion is not in the plan, ``UnsupportedSystemError`` if its file is
        incomplete, and ``BadFileError`` if the file is invalid.
        """
        name = name_of(question(system, initial_state, times, accuracy))
        if name not in _names(self.folder):
            raise DeclaredLackError(
                f"{Path(self.folder).name} does not contain this motion: {INDEX} has another version, "
                "or the motion depends on answers to others"
            )
        return read_motion(Path(self.folder, f"{name}.csv"), system, np.array(times, dtype=float))


def name_of(line: bytes) -> str:
    """Return the file name, without extension, of a question."""
    return hashlib.sha256(line).hexdigest()[:12]


def read_motion(path: Path, system: AnySystem, times: FloatArray) -> Trajectory:
    """Return the motion of ``system`` at ``times`` (n,) in s from a file."""
    place = f"{path.parent.name}/{path.name}"
    try:
        lines = path.read_text(encoding="utf-8", errors="replace").splitlines()
    except FileNotFoundError:
        raise UnsupportedSystemError(f"{place} is missing") from None
    except OSError as error:
        raise BadFileError(f"{place} cannot be read: {error.strerror}") from None
    described = (("t", "s"), *COLUMNS[type(system)])
    columns = [name for name, _ in described]
    for number, line in enumerate(lines, 1):
        if ";" in line:
            raise BadFileError(f"{place}, line {number}, contains a semicolon: {POINTS}")
    rows = [(number, line.split(",")) for number, line in enumerate(lines, 1) if line.strip()]
    order = list(range(len(columns)))
    if rows and not any(map(_is_number, rows[0][1])):
        order = _order(rows.pop(0)[1], described, place)
    if len(rows) > len(times):  # an event may have two rows, before and after it
        rows = [row for i, row in enumerate(rows) if i + 1 == len(rows) or row[1][0] != rows[i + 1][1][0]]
    found = len(rows)
    if found < len(times) or (found == len(times) and len(rows[-1][1]) < len(columns)):
        whole = found - (1 if rows and len(rows[-1][1]) < len(columns) else 0)
        raise UnsupportedSystemError(
            f"{place} ends after {whole} of {len(times)} times, before t = {times[whole]:g} s"
        )
    if found > len(times):
        raise BadFileError(f"{place} has {found} rows: expected {len(times)}, one per time")
    numbers = np.empty((found, len(columns)))
    for i, (number, row) in enumerate(rows):
        if len(row) != len(columns):
            raise BadFileError(
                f"{place}, line {number}, has {len(row)} numbers: it must have {len(columns)}, {', '.join(columns)}; "
                f"{POINTS}"
            )
        try:
            numbers[i] = row
        except ValueError:
            raise BadFileError(
                f"{place}, line {number}, does not consist of numbers: {','.join(row)[:60]!r}"
            ) from None
        if not np.isfinite(numbers[i]).all():
            raise BadFileError(f"{place}, line {number}, has a number that is not finite")
    numbers = numbers[:, order]
    same = np.isclose(numbers[:, 0], times, rtol=ROUNDED, atol=0.0)
    return Trajectory(system, np.where(same, times, numbers[:, 0]), numbers[:, 1:])


def _order(header: Sequence[str], columns: Sequence[tuple[str, str]], place: str) -> list[int]:
    """Return the positions of ``columns`` (names and units) in a header that names each once, as "x" or "x [m]"."""
    named = {form: name for name, unit in columns for form in (name, f"{name} [{unit}]")}
    found = [named.get(word.strip(" #\"'")) for word in header]  # savetxt of NumPy writes "# t,x"
    if sorted(map(str, found)) != sorted(name for name, _ in columns):
        rule = ", ".join(f"{name} [{unit}]" for name, unit in columns)
        raise BadFileError(
            f"{place} has the header {printable(','.join(header))[:80]!r}: it must name {rule}, in any order"
        )
    return [found.index(name) for name, _ in columns]


def files_engine(text: str) -> Engine:
    """Return the engine "files:TEXT"; raise ``ValueError`` if the folder does not contain a valid plan."""
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
        reason = f"{error.strerror}; create it with friction-discs plan"
    except (ValueError, KeyError, TypeError):
        reason = "it is not a plan of this version"
    else:
        return content
    raise ValueError(f"{Path(folder).name}/{INDEX} cannot be read: {reason}")


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
