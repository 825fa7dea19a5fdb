"""Results of a sweep on disk or in an object store: a Zarr store of xarray Datasets that is always valid.

- ``round-0``, ``round-1``, ...: trajectories, written region by region (:mod:`compare.sweep.arrays`).
- ``check``, ``result``, ``curves``, ``branches``: written after all chunks.

A group is valid once it is sealed. Damaged groups and chunks are recomputed. A small finished store in a local folder
becomes one file.
"""

from __future__ import annotations

import json
import secrets
import shutil
import tempfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import xarray as xr

from compare.output.outside_text import all_printable
from compare.run.provenance import stamp as stamp_now
from compare.run.provenance import version_of
from compare.sweep.arrays import (
    CHECKSUM,
    DESCRIPTION,
    Group,
    Large,
    Round,
    checksum,
    description_of,
    group_content,
)
from compare.sweep.files import (
    Files,
    StoreError,
    files_in,
    is_remote,
    member,
    pack,
    store_errors,
    unpacked,
)
from compare.sweep.plan import Numbers, Plan, count, plan_as_json, plan_from_json
from compare.sweep.quantities import RESULTS, components

SMALL = 1_000_000  # smallest number of trajectories of a finished store that remains a folder
MOST_NAMED = 10
EACH, LEAST_ROOM = 300, 100_000_000  # most bytes of an archive per trajectory or file, and in addition
FILES = 20  # most files of a chunk
ROUND = "round-{}"


class SweepStore:
    """An open store.

    Code with the digest ``stamp`` computes and writes ``chunk`` trajectories together. ``place`` is the requested URL
    if ``files`` belong to an unpacked archive.
    """

    def __init__(self, files: Files, plan: Plan, chunk: int, stamp: str, place: str = "") -> None:
        self.files, self.plan, self.chunk, self.stamp = files, plan, chunk, stamp
        self.broken: list[str] = []  # damaged groups and chunks, in words
        self._place = place or files.url
        self._whole: set[str] = set()
        self._description = description_of(files)
        self._unpacked: tempfile.TemporaryDirectory[str] | None = None

    @property
    def packed(self) -> bool:
        """True if the store was opened from an archive, which lacks nothing unless it is damaged."""
        return self._unpacked is not None

    @property
    def path(self) -> str:
        """Path or URL for messages."""
        archive = archive_of(self._place)
        return str(archive) if archive is not None and archive.exists() else self._place

    @classmethod
    def create(cls, path: str | Path, plan: Plan, chunk: int) -> SweepStore:
        """Create a store; raise ``FileExistsError`` if one exists."""
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
        files.claim(DESCRIPTION, group_content(attributes | {CHECKSUM: checksum(attributes)}))
        return cls(files, plan, chunk, stamp_now())

    @classmethod
    def open(cls, path: str | Path) -> SweepStore:
        """Open a store; raise ``ValueError`` if it is damaged or not of a sweep."""
        files = Files.at(path)
        archive, place = archive_of(files.url), files.url
        packed = archive is not None and archive.exists()
        if archive is not None and not packed:
            files_in(Path(place))
        try:  # not with Zarr, which fails if any group is damaged
            content = (member(archive, DESCRIPTION) if archive and packed else files.read(DESCRIPTION)) or b""
            attributes = json.loads(content)["attributes"]
            whole = content == group_content(attributes)
            whole = attributes.pop(CHECKSUM) == checksum(attributes) and whole
            plan = plan_from_json(all_printable(json.loads(attributes["plan"])))
            chunk, stamp = int(attributes["chunk"]), str(attributes["stamp"])
            whole = whole and chunk >= 1
        except (StoreError, MemoryError):
            raise
        except Exception:  # the description of an unknown store may raise anything
            whole = False
        if not whole:
            raise ValueError(
                f"{place!r} is not the store of a sweep, or its description is damaged or too old"
            )
        most = LEAST_ROOM + EACH * (count(plan) + FILES * (count(plan) // chunk))
        folder = unpacked(archive, most) if archive and packed else None
        store = cls(files if folder is None else Files.at(folder.name), plan, chunk, stamp, place)
        store._unpacked = folder
        return store

    def pack(self) -> None:
        """Pack a small finished store into one file; :meth:`tidy` removes the folder."""
        archive = archive_of(self._place)
        if archive is None or count(self.plan) >= SMALL:
            return
        if not archive.exists() or self.broken:
            with store_errors(str(archive)):
                pack(Path(self.files.url), archive)

    def tidy(self) -> None:
        """Remove the folders of a packed store, which ends the use of this object."""
        archive = archive_of(self._place)
        if archive is not None and archive.exists():
            shutil.rmtree(self._place, ignore_errors=True)
        if self._unpacked is not None:
            self._unpacked.cleanup()

    def round(self, i: int, numbers: Numbers) -> Round:
        """Return round ``i`` of the trajectories ``numbers``; create it if necessary."""
        if found := self.look(i, numbers):
            return found
        group = self.begin(ROUND.format(i), self._template(len(numbers)))
        self.end(group, xr.Dataset(coords={"component": list(components(self.plan.system))}))
        return Round(group, numbers, self.chunk)

    def look(self, i: int, numbers: Numbers) -> Round | None:
        """Return round ``i`` of the trajectories ``numbers``, or None without an intact round."""
        group = self._group(ROUND.format(i))
        if not self._is_intact(group, f"the description of {group.name}"):
            return None
        return Round(group, numbers, self.chunk)

    def note_damaged(self, i: int, chunks: list[int], count: int) -> None:
        """Add damaged ``chunks`` of round ``i`` to ``broken``."""
        if chunks:
            shown = ", ".join(map(str, chunks[:MOST_NAMED]))
            more = f" and {len(chunks) - MOST_NAMED} more" if len(chunks) > MOST_NAMED else ""
            word = "chunk" if len(chunks) == 1 else "chunks"
            self.broken.append(f"{ROUND.format(i)}: {word} {shown}{more} (of {count})")

    def put(self, name: str, dataset: xr.Dataset) -> None:
        """Write a group and replace an older group."""
        self.end(self.begin(name, {}), dataset)

    def begin(self, name: str, arrays: Mapping[str, Large]) -> Group:
        """Replace a group by a group that workers write; :meth:`end` completes it."""
        self.files.remove(name)
        group = self._group(name)
        with store_errors(self.files.url):
            group.create(arrays)
        return group

    def end(self, group: Group, dataset: xr.Dataset) -> None:
        """Add a dataset to a group and seal it."""
        with store_errors(self.files.url):
            group.add(dataset)
        group.seal()
        self._whole.add(group.name)

    def get(self, name: str) -> xr.Dataset | None:
        """Return an intact group, or None."""
        group = self._group(name)
        return group.dataset() if self._is_intact(group, name) else None

    def finished(self, name: str) -> xr.Dataset:
        """Return an intact group; raise ``ValueError`` if the group is missing or damaged."""
        group = self.get(name)
        if group is None:
            raise ValueError(
                f"the sweep in {self.path!r} is not finished; repeat it with --resume to complete it"
            )
        return group

    def _group(self, name: str) -> Group:
        return Group(self.files, self._description, name)

    def _template(self, count: int) -> dict[str, Large]:
        arrays: dict[str, Large] = {}
        for name, result in RESULTS.items():
            more = (len(components(self.plan.system)),) if name == "states" else ()
            attributes = {"long_name": result.meaning, "units": result.unit} | flags(name)
            dimensions = ("trajectory", "component")[: 1 + len(more)]
            arrays[name] = Large(dimensions, (count, *more), (self.chunk, *more), result.dtype, attributes)
        return arrays

    def _is_intact(self, group: Group, called: str) -> bool:
        """Return whether a group matches its seal.

        A damaged group is added to ``broken``; a group without a seal is unfinished, which is damage in an archive.
        """
        if group.name in self._whole:
            return True
        intact = group.is_intact()
        if intact:
            self._whole.add(group.name)
        elif intact is not None or self.packed:
            self.broken.append(called)
        return bool(intact)


def archive_of(place: str) -> Path | None:
    """Return the file of a packed store, None in an object store."""
    return None if is_remote(place) else Path(f"{place}.zip")


def is_free(files: Files) -> bool:
    """Return whether no store exists at the place of ``files``."""
    archive = archive_of(files.url)
    return not files.inside() and (archive is None or not archive.exists())


def flags(variable: str) -> dict[str, Any]:
    """Return the meanings of the values of ``end`` as attributes of the CF conventions."""
    if variable != "end":
        return {}
    from reference_model.ensemble import EndState

    return {
        "flag_values": [int(end) for end in EndState],
        "flag_meanings": " ".join(end.name.lower() for end in EndState),
    }
