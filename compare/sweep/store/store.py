"""Results of a sweep on disk or in an object store: a Zarr store of xarray Datasets, valid at every moment.

- ``round-0``, ``round-1``, ...: what was simulated, one Dataset a round, whose chunks are written by those who
  simulate them (:mod:`compare.sweep.store.round`).
- ``check``, ``result``, ``curves``, ``branches``: written when all chunks are done.

A group is there once it has the file ``.zgroup``, which is written last, and as long as its files have the checksum
in its attributes. The attributes of the store have the plan, the code that computed it and its libraries, and their
checksum; who writes them first is the one who makes the store. What does not have the contents that it was written
with is computed again, and ``SweepStore.broken`` says so.
"""

from __future__ import annotations

import hashlib
import json
import re
import secrets
import tempfile
from collections.abc import Iterable, Mapping
from fnmatch import fnmatch
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import xarray as xr
import zarr
from numpy.typing import NDArray

from compare.output.outside_text import all_printable
from compare.run.provenance import version_of
from compare.run.stamp import stamp as stamp_now
from compare.sweep.define.plan import Numbers, Plan, plan_as_json, plan_from_json
from compare.sweep.define.quantities import RESULTS, components
from compare.sweep.store.files import Files, told
from compare.sweep.store.round import CHECKSUM, DESCRIPTION, Arrays, Chunks, Round, description_of

FORMAT: dict[str, Any] = {"zarr_format": 2, "consolidated": False}
"""Every version of Zarr reads it, and no copy of the metadata goes stale when a round grows."""

MOST_NAMED = 10
"""Chunks that a sentence lists."""

ROUND = "round-{}"

MISSING = {"f8": np.nan, "u1": 255, "i8": -1}
"""What an array has where nothing is written, by its type: no result is like this."""

ARRAY = ".zarray"
"""Name of the file that describes an array."""

TYPES, FILTERS, COMPRESSOR = re.compile(r"[<|](f8|[iu]8|u1|b1|U\d+)"), (None, [{"id": "vlen-utf8"}]), "blosc"
"""What the versions of Zarr write for our arrays."""

GROUP, GROUP_CONTENT = ".zgroup", json.dumps({"zarr_format": FORMAT["zarr_format"]}).encode()

FILES_OF_GROUP = (".z*", "*/.z*", "*/[0-9]*")
"""Those of a group of which all is written before it counts; what else may lie in a folder makes no difference."""

FILES_OF_ROUND = (
    GROUP,
    "component/0",
    *(f"{name}/{file}" for name in (*RESULTS, CHECKSUM, "component") for file in (ARRAY, ".zattrs")),
)
"""Those of a round that are there before its chunks."""


class Large(NamedTuple):
    """An array that is written piece by piece: its dimensions, shape, and that of its pieces, type and attributes.

    ``missing`` is what it has where nothing is written, None if all of it will be.
    """

    dimensions: tuple[str, ...]
    shape: tuple[int, ...]
    pieces: tuple[int, ...]
    dtype: str
    attributes: dict[str, Any]
    missing: float | None = None


class SweepStore:
    """A store that is open, of a plan.

    Parameters
    ----------
    files : Files
        Of the store.
    plan : Plan
        What is computed.
    chunk : int
        Number of trajectories that are computed and written together.
    stamp : str
        Of the code that computes them.

    """

    def __init__(self, files: Files, plan: Plan, chunk: int, stamp: str) -> None:
        self.files, self.plan, self.chunk, self.stamp = files, plan, chunk, stamp
        self.broken: list[str] = []  # what is not as it was written, in words
        self._whole: set[str] = set()
        self._description = description_of(files)

    @property
    def path(self) -> str:
        """Where it is, in words."""
        return self.files.url

    @classmethod
    def create(cls, path: str | Path, plan: Plan, chunk: int) -> SweepStore:
        """Make a store where nothing is yet; ``FileExistsError`` where something is, or another was the first."""
        files = Files.at(path)
        if not is_free(files):
            raise FileExistsError(files.url)
        libraries = ("friction-discs", "numpy", "scipy", "numba", "xarray", "zarr")
        attributes = {
            "title": f"friction-discs sweep: {plan.kind}",
            "plan": json.dumps(plan_as_json(plan)),
            "chunk": chunk,
            "stamp": stamp_now(),
            "versions": json.dumps({name: version_of(name) for name in libraries}),
            "id": secrets.token_hex(8),
        }
        attributes[CHECKSUM] = _checksum(attributes)
        files.write({GROUP: GROUP_CONTENT})
        files.claim(DESCRIPTION, json.dumps(attributes).encode())
        return cls(files, plan, chunk, stamp_now())

    @classmethod
    def open(cls, path: str | Path) -> SweepStore:
        """Open a store; raise ``ValueError`` if there is none of a sweep, or its description is broken."""
        files = Files.at(path)
        try:  # not by Zarr, which would look at all groups, and one of them may be broken
            group, attributes = (json.loads(files.read(name) or b"") for name in (GROUP, DESCRIPTION))
            whole = group["zarr_format"] == FORMAT["zarr_format"]
            whole = attributes.pop(CHECKSUM) == _checksum(attributes) and whole
            plan = plan_from_json(all_printable(json.loads(attributes["plan"])))
            chunk, stamp = int(attributes["chunk"]), str(attributes["stamp"])
        except (OSError, AttributeError, KeyError, TypeError, ValueError):
            whole = False
        if not whole:
            raise ValueError(f"{files.url!r} is no store of a sweep, or its description is broken")
        return cls(files, plan, chunk, stamp)

    def round(self, i: int, numbers: Numbers) -> Round:
        """Return round ``i`` of the trajectories ``numbers``, made if it is not there, mended if it is broken."""
        if not self.has(i):
            name = ROUND.format(i)
            self._seal(name, self._describe(name, *self._template(len(numbers))))
        return self._round(i, numbers)

    def look(self, i: int, numbers: Numbers) -> Round | None:
        """Return round ``i`` of the trajectories ``numbers``, or None if it is not there or can't be read."""
        return self._round(i, numbers) if self.has(i) else None

    def has(self, i: int) -> bool:
        """Return whether round ``i`` is described; what its chunks are is another question."""
        name = ROUND.format(i)
        if self.files.read(f"{name}/{GROUP}") is None:
            return False
        return self._is_whole(name, FILES_OF_ROUND, f"the description of {name}")

    def tell_broken(self, i: int, chunks: list[int], count: int) -> None:
        """Note that of the ``count`` chunks of round ``i`` some are not as they were written."""
        if chunks:
            shown = ", ".join(map(str, chunks[:MOST_NAMED]))
            more = f" and {len(chunks) - MOST_NAMED} more" if len(chunks) > MOST_NAMED else ""
            self.broken.append(f"of {count} chunks of {ROUND.format(i)} these: {shown}{more}")

    def put(self, name: str, dataset: xr.Dataset) -> None:
        """Write a group, in place of an older one."""
        self.files.remove(name)
        self._seal(name, self._describe(name, dataset, {}))

    def begin(self, name: str, dataset: xr.Dataset, large: Mapping[str, Large]) -> Arrays:
        """Begin a group, in place of an older one, with arrays that others write; :meth:`end` ends it."""
        self.files.remove(name)
        self._describe(name, dataset, large)
        return self._arrays(name)

    def end(
        self, name: str, dataset: xr.Dataset, large: Mapping[str, Large], digests: Mapping[str, str]
    ) -> None:
        """End a group with what else is to be in it; ``digests`` are those of the files that others wrote."""
        self._seal(name, self._describe(name, dataset, large) | dict(digests))

    def get(self, name: str) -> xr.Dataset | None:
        """Return a group, of which nothing is read yet, or None if it is not there or broken."""
        if self.files.read(f"{name}/{GROUP}") is None:
            return None
        if not self._is_whole(name, self._names(name), name):
            return None
        group: xr.Dataset = xr.open_zarr(
            self.files.below(name), chunks=None, storage_options=self.files.options, **FORMAT
        )
        return group

    def _arrays(self, name: str) -> Arrays:
        return Arrays(self.files, self._description, name)

    def _round(self, i: int, numbers: Numbers) -> Round:
        return Round(Chunks(self._arrays(ROUND.format(i)), len(numbers), self.chunk), numbers)

    def _template(self, count: int) -> tuple[xr.Dataset, dict[str, Large]]:
        """Return what a round of ``count`` trajectories has besides its chunks."""
        state = list(components(self.plan.system))
        large: dict[str, Large] = {}
        for name, result in RESULTS.items():
            more = (len(state),) if name == "states" else ()
            attributes = {"long_name": result.meaning, "units": result.unit} | flags(name)
            dimensions = ("trajectory", "component")[: 1 + len(more)]
            missing = MISSING[result.dtype]
            large[name] = Large(
                dimensions, (count, *more), (self.chunk, *more), result.dtype, attributes, missing
            )
        meaning = {"long_name": "of all that is written of the chunk, 0 where nothing is"}
        large[CHECKSUM] = Large(("chunk",), (-(-count // self.chunk),), (1,), "u8", meaning, 0)
        return xr.Dataset(coords={"component": state}), large

    def _describe(self, name: str, dataset: xr.Dataset, large: Mapping[str, Large]) -> dict[str, str]:
        """Write all of a group but its pieces and what makes it count; return the digests of its files."""
        with tempfile.TemporaryDirectory() as folder:
            _make(folder, dataset, large)
            made = Path(folder)
            contents = {
                path.relative_to(made).as_posix(): path.read_bytes()
                for path in made.rglob("*")
                if path.is_file() and path.parent != made
            }
        self.files.write({f"{name}/{file}": content for file, content in contents.items()})
        return {file: digest_of(content) for file, content in ({GROUP: GROUP_CONTENT} | contents).items()}

    def _seal(self, name: str, digests: Mapping[str, str]) -> None:
        """Write the checksum of a group, and then that it is there."""
        attributes = {CHECKSUM: _checksum(digests)}
        self.files.write({f"{name}/{DESCRIPTION}": json.dumps(attributes).encode()})
        self.files.write({f"{name}/{GROUP}": GROUP_CONTENT})
        self._whole.add(name)

    def _is_whole(self, group: str, names: Iterable[str], called: str) -> bool:
        """Return whether a group is as it was written, with arrays of ours alone; note it as broken otherwise."""
        if group in self._whole:
            return True
        ours, digests = True, {}
        for name in names:
            content = self.files.read(f"{group}/{name}")
            if content is not None and name != DESCRIPTION:  # which holds what the others come to
                digests[name] = digest_of(content)
                ours = ours and (not name.endswith(ARRAY) or is_ours(content))
        if not ours or self._checksum_in(group) != _checksum(digests):
            self.broken.append(called)
            return False
        self._whole.add(group)
        return True

    def _names(self, group: str) -> Iterable[str]:
        names = (name[len(group) + 1 :] for name in self.files.names(group))
        return (name for name in names if any(fnmatch(name, pattern) for pattern in FILES_OF_GROUP))

    def _checksum_in(self, group: str) -> str | None:
        """Return the checksum that a group was written with, None if there is none that can be read."""
        try:
            return str(json.loads(self.files.read(f"{group}/{DESCRIPTION}") or b"")[CHECKSUM])
        except (ValueError, KeyError, TypeError):
            return None


def is_free(files: Files) -> bool:
    """Return whether nothing is there, but what one leaves who is killed before a store has its description."""
    return set(files.inside()) <= {GROUP}


def is_ours(description: bytes) -> bool:
    """Return whether an array has a data type, filters and a compressor that sweeps write.

    Others, such as the filter "pickle", may run code of whoever wrote the array.
    """
    try:
        found = json.loads(description)
        known = found["filters"] in FILTERS and found["compressor"]["id"] == COMPRESSOR
        return known and TYPES.fullmatch(found["dtype"]) is not None
    except (ValueError, KeyError, TypeError):
        return False


def write_piece(
    arrays: Arrays, values: Mapping[str, NDArray[Any]], where: tuple[slice, ...]
) -> dict[str, str]:
    """Write a piece of each array of a group; return the digests of its files."""
    digests = {}
    with told(arrays.files.url):
        for name, piece in values.items():
            array = arrays.open(name)
            array[where] = piece
            place = ".".join(str(at.start // size) for at, size in zip(where, array.chunks, strict=True))
            content = arrays.files.read(f"{arrays.group}/{name}/{place}")
            if content is not None:  # it is not if nothing differs from what is missing
                digests[f"{name}/{place}"] = digest_of(content)
    return digests


def digest_of(content: bytes) -> str:
    """Return the digest of the contents of a file."""
    return hashlib.blake2b(content, digest_size=8).hexdigest()


def _checksum(attributes: Mapping[str, Any]) -> str:
    """Return the checksum of attributes, or of the digests of the files of a group."""
    return digest_of(json.dumps(attributes, sort_keys=True).encode())


def _make(folder: str, dataset: xr.Dataset, large: Mapping[str, Large]) -> None:
    """Write a group into a folder, with large arrays without pieces."""
    dataset, encoding = dataset.copy(), dict[str, Any]()
    for name, array in large.items():
        # of length 0, and as long as it has it a dimension of its own
        dimensions = (f"{name}, to grow", *array.dimensions[1:])
        dataset[name] = (dimensions, np.zeros((0, *array.shape[1:]), array.dtype), array.attributes)
        encoding[name] = {"chunks": array.pieces}
        if array.missing is not None:
            encoding[name]["_FillValue"] = array.missing
    dataset.to_zarr(folder, mode="w", encoding=encoding, write_empty_chunks=True, **FORMAT)
    for name, array in large.items():
        grown = zarr.open_array(f"{folder}/{name}", mode="r+")
        grown.resize(array.shape)
        grown.attrs["_ARRAY_DIMENSIONS"] = list(array.dimensions)


def flags(variable: str) -> dict[str, Any]:
    """Return what the values of an end mean, after the CF conventions."""
    if variable != "end":
        return {}
    from reference_model.ensemble import EndState

    return {
        "flag_values": [int(end) for end in EndState],
        "flag_meanings": " ".join(end.name.lower() for end in EndState),
    }
