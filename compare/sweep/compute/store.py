"""Results of a sweep on disk: a Zarr store of xarray Datasets, valid at every moment.

- ``round-0``, ``round-1``, ...: what was simulated, one Dataset a round, written chunk by chunk. A chunk counts
  when ``checksum`` is that of its contents, which is written after all of it.
- ``check``, ``result``, ``curves``: written when all chunks are done.

A group is made under another name and renamed when it is whole, with a checksum of its files. The attributes of the
store have the plan, the code that computed it and its libraries, and their checksum. What does not have the contents
that it was written with is computed again, and ``SweepStore.broken`` says so.
"""

from __future__ import annotations

import hashlib
import json
import os
import shutil
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
import zarr
from numpy.typing import NDArray

from compare.run.stamp import version_of
from compare.sweep.compute.stamp import sweep_stamp
from compare.sweep.define.plan import Numbers, Plan, plan_as_json, plan_from_json
from compare.sweep.define.quantities import RESULTS, components

FORMAT: dict[str, Any] = {"zarr_format": 2, "consolidated": False}
"""Every version of Zarr reads it, and no copy of the metadata goes stale when a round grows."""

MOST_NAMED = 10
"""Chunks that a sentence lists."""

PART = "part"
"""Name of a group that is being written."""

ROUND = "round-{}"

MISSING = {"f8": np.nan, "u1": 255, "i8": -1}
"""What an array has where nothing is written, by its type: no result is like this."""


CHECKSUM = "checksum"

FILES_OF_GROUP = (".z*", "*/.z*", "*/[0-9]*")
"""Those of a group that is written at once; what else may lie in a folder makes no difference."""

FILES_OF_ROUND = (".zgroup", "*/.z*", "component/[0-9]*")
"""Those of a round that are there before its chunks."""


class SweepStore:
    """A store that is open, of a plan.

    Parameters
    ----------
    path : Path
        Folder of the store.
    plan : Plan
        What is computed.
    chunk : int
        Number of trajectories that are computed and written together.
    stamp : str
        Of the code that computes them.

    """

    def __init__(self, path: Path, plan: Plan, chunk: int, stamp: str) -> None:
        self.path, self.plan, self.chunk, self.stamp = path, plan, chunk, stamp
        self.broken: list[str] = []  # what is not as it was written, in words
        self._whole: set[str] = set()

    @classmethod
    def create(cls, path: Path, plan: Plan, chunk: int) -> SweepStore:
        """Make a store where nothing is yet; ``FileExistsError`` where something is."""
        made = path.with_name(f"{path.name}.{PART}")
        shutil.rmtree(made, ignore_errors=True)
        libraries = ("friction-discs", "numpy", "scipy", "numba", "xarray", "zarr")
        attributes = {
            "title": f"friction-discs sweep: {plan.kind}",
            "plan": json.dumps(plan_as_json(plan)),
            "chunk": chunk,
            "stamp": sweep_stamp(),
            "versions": json.dumps({name: version_of(name) for name in libraries}),
        }
        attributes[CHECKSUM] = _checksum_of_text(attributes)
        xr.Dataset(attrs=attributes).to_zarr(made, mode="w", **FORMAT)
        os.rename(made, path)
        return cls(path, plan, chunk, sweep_stamp())

    @classmethod
    def open(cls, path: Path) -> SweepStore:
        """Open a store; raise ``ValueError`` if there is none of a sweep, or its description is broken."""
        try:  # not by Zarr, which would look at all groups, and one of them may be broken
            group, attributes = (
                json.loads((path / name).read_text("utf-8")) for name in (".zgroup", ".zattrs")
            )
            whole = group["zarr_format"] == FORMAT["zarr_format"]
            whole = attributes.pop(CHECKSUM) == _checksum_of_text(attributes) and whole
            plan = plan_from_json(json.loads(attributes["plan"]))
            chunk, stamp = int(attributes["chunk"]), str(attributes["stamp"])
        except (OSError, AttributeError, KeyError, TypeError, ValueError):
            whole = False
        if not whole:
            raise ValueError(f"{str(path)!r} is no store of a sweep, or its description is broken")
        return cls(path, plan, chunk, stamp)

    def round(self, i: int, numbers: Numbers) -> Round:
        """Return round ``i`` of the trajectories ``numbers``, made if it is not there, mended if it is broken."""
        found = self.look(i, numbers)
        if found is None:
            name = ROUND.format(i)
            if (self.path / name).exists():
                self._mend_round(name, len(numbers))
            else:
                self._make_round(name, len(numbers))
            found = self.look(i, numbers)
            assert found is not None
        return found

    def look(self, i: int, numbers: Numbers) -> Round | None:
        """Return round ``i`` of the trajectories ``numbers``, or None if it is not there or can't be read."""
        name = ROUND.format(i)
        if not (self.path / name).exists():
            return None
        if _checksum_in(self.path / name) != _checksum(self.path / name, FILES_OF_ROUND):
            self.broken.append(f"the description of {name}")
            return None
        found = Round(self.path / name, numbers, self.chunk)
        if found.broken:
            shown = ", ".join(map(str, found.broken[:MOST_NAMED]))
            more = f" and {len(found.broken) - MOST_NAMED} more" if len(found.broken) > MOST_NAMED else ""
            self.broken.append(f"of {len(found.done)} chunks of {name} these: {shown}{more}")
        return found

    def _make_round(self, name: str, count: int) -> None:
        """Make arrays without chunks; they grow to their size before the group gets its name."""
        self._make_template(count)
        os.rename(self.path / PART, self.path / name)

    def _mend_round(self, name: str, count: int) -> None:
        """Write again what was there before the chunks, which are looked at afterwards."""
        self._make_template(count)
        for file in _files(self.path / PART, (*FILES_OF_ROUND, ".zattrs")):
            target = self.path / name / file.relative_to(self.path / PART)
            target.parent.mkdir(parents=True, exist_ok=True)
            os.replace(file, target)
        shutil.rmtree(self.path / PART)

    def _make_template(self, count: int) -> None:
        variables: dict[str, Any] = {}
        encoding: dict[str, Any] = {}
        shapes: dict[str, tuple[int, ...]] = {}
        state = list(components(self.plan.system))
        for variable, result in RESULTS.items():
            more = (len(state),) if variable == "states" else ()
            dimensions = ("trajectory", "component")[: 1 + len(more)]
            attributes = {"long_name": result.meaning, "units": result.unit} | flags(variable)
            variables[variable] = (dimensions, np.zeros((0, *more), result.dtype), attributes)
            encoding[variable] = {"chunks": (self.chunk, *more), "_FillValue": MISSING[result.dtype]}
            shapes[variable] = (count, *more)
        meaning = "of all that is written of the chunk, 0 where nothing is"
        variables[CHECKSUM] = ("chunk", np.zeros(0, "u8"), {"long_name": meaning})
        encoding[CHECKSUM] = {"chunks": (1,), "_FillValue": 0}
        shapes[CHECKSUM] = (-(-count // self.chunk),)
        template = xr.Dataset(variables, coords={"component": state})
        self._write(PART, template, encoding)
        group = _arrays(self.path / PART)
        for variable, shape in shapes.items():
            group[variable].resize(shape)
        _write_checksum(self.path / PART, FILES_OF_ROUND)

    def put(self, name: str, dataset: xr.Dataset) -> None:
        """Write a group, in place of an older one."""
        self._write(PART, dataset, {})
        _write_checksum(self.path / PART, FILES_OF_GROUP)
        shutil.rmtree(self.path / name, ignore_errors=True)
        os.rename(self.path / PART, self.path / name)
        self._whole.add(name)

    def _write(self, name: str, dataset: xr.Dataset, encoding: Mapping[str, Any]) -> None:
        shutil.rmtree(self.path / name, ignore_errors=True)
        dataset.to_zarr(
            self.path, group=name, mode="w", encoding=dict(encoding), write_empty_chunks=True, **FORMAT
        )

    def get(self, name: str) -> xr.Dataset | None:
        """Return a group, or None if it is not there or broken."""
        folder = self.path / name
        if not folder.exists():
            return None
        if name not in self._whole and _checksum_in(folder) != _checksum(folder, FILES_OF_GROUP):
            self.broken.append(name)
            return None
        self._whole.add(name)
        group: xr.Dataset = xr.open_zarr(self.path, group=name, consolidated=False, chunks=None)
        return group


class Round:
    """The trajectories of a round on disk.

    ``done`` says for each chunk whether it is there with the contents that it was written with; ``broken`` are the
    numbers of those that were written and are not.
    """

    def __init__(self, path: Path, numbers: Numbers, chunk: int) -> None:
        self.numbers = numbers
        self._chunk = chunk
        self._arrays = _arrays(path)
        marks = [self._mark(i) for i in range(-(-len(numbers) // chunk))]
        found = [mark != 0 and mark == self._checksum(i) for i, mark in enumerate(marks)]
        self.done: NDArray[np.bool_] = np.array(found, dtype=bool)
        self.broken = [i for i, mark in enumerate(marks) if mark != 0 and not found[i]]

    def numbers_of(self, chunk: int) -> Numbers:
        """Return the numbers of the trajectories of a chunk."""
        return self.numbers[self._slice(chunk)]

    def write(self, chunk: int, results: Mapping[str, NDArray[Any]]) -> None:
        """Write a chunk, and then that it is written."""
        for name, values in results.items():
            self._arrays[name][self._slice(chunk)] = values
        self._arrays[CHECKSUM][chunk] = _checksum_of_arrays(chunk, results)
        self.done[chunk] = True

    def read(self, name: str, where: int | slice = slice(None)) -> NDArray[Any]:
        """Return results of trajectories in the order of ``numbers``."""
        return np.asarray(self._arrays[name][where])

    def _mark(self, chunk: int) -> int | None:
        """Return the checksum that was written with a chunk, 0 if there is none, None if it can't be read."""
        try:
            return int(self._arrays[CHECKSUM][chunk])
        except MemoryError:
            raise
        except Exception:  # whatever is raised by a file that may have any contents
            return None

    def _checksum(self, chunk: int) -> int | None:
        """Return the checksum of what is there of a chunk, None if it can't be read."""
        try:
            return _checksum_of_arrays(chunk, {name: self.read(name, self._slice(chunk)) for name in RESULTS})
        except MemoryError:
            raise
        except Exception:  # as above
            return None

    def _slice(self, chunk: int) -> slice:
        return slice(chunk * self._chunk, min((chunk + 1) * self._chunk, len(self.numbers)))


def _checksum_of_arrays(chunk: int, results: Mapping[str, NDArray[Any]]) -> int:
    """Return the checksum of the results of a chunk, which is never 0."""
    digest = hashlib.blake2b(str(chunk).encode(), digest_size=8)
    for name, result in RESULTS.items():
        digest.update(np.ascontiguousarray(results[name], dtype=result.dtype).tobytes())
    return int.from_bytes(digest.digest(), "little") or 1


def _checksum_of_text(attributes: Mapping[str, Any]) -> str:
    return hashlib.blake2b(json.dumps(attributes, sort_keys=True).encode(), digest_size=8).hexdigest()


def _files(folder: Path, patterns: Iterable[str]) -> list[Path]:
    """Return the files below ``folder`` whose paths are like one of ``patterns``."""
    return sorted({file for pattern in patterns for file in folder.glob(pattern) if file.is_file()})


def _checksum(folder: Path, patterns: Iterable[str]) -> str:
    """Return the checksum of files of a group, but for its attributes, which hold this."""
    digest = hashlib.blake2b(digest_size=8)
    for file in _files(folder, patterns):
        if file != folder / ".zattrs":
            digest.update(f"{file.relative_to(folder).as_posix()} {file.stat().st_size} ".encode())
            digest.update(file.read_bytes())
    return digest.hexdigest()


def _write_checksum(folder: Path, patterns: Iterable[str]) -> None:
    (folder / ".zattrs").write_text(json.dumps({CHECKSUM: _checksum(folder, patterns)}), encoding="utf-8")


def _checksum_in(folder: Path) -> str | None:
    """Return the checksum that a group was written with, None if there is none that can be read."""
    try:
        content = json.loads((folder / ".zattrs").read_text(encoding="utf-8"))
        return str(content[CHECKSUM])
    except (OSError, ValueError, KeyError, TypeError):
        return None


def _arrays(path: Path) -> dict[str, Any]:
    """Return the arrays of a group by their names, open to be changed in place."""
    return dict(zarr.open_group(str(path), mode="r+").arrays())


def flags(variable: str) -> dict[str, Any]:
    """Return what the values of an end mean, after the CF conventions."""
    if variable != "end":
        return {}
    from reference_model.ensemble import EndState

    return {
        "flag_values": [int(end) for end in EndState],
        "flag_meanings": " ".join(end.name.lower() for end in EndState),
    }
