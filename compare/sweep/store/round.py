"""The trajectories of a round in the store: arrays that whoever simulates a chunk writes, with its mark.

A chunk counts when its mark, an element of the array ``checksum``, is that of its contents. It is written after all
of them, and two who write the same chunk write the same bits.
"""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np
import zarr
from numpy.typing import NDArray

from compare.sweep.define.plan import Numbers
from compare.sweep.define.quantities import RESULTS
from compare.sweep.store.files import Files, StoreError, told

CHECKSUM = "checksum"

DESCRIPTION = ".zattrs"
"""Name of the file that says which sweep a store is of."""


@dataclass(frozen=True)
class Arrays:
    """The arrays of a group, wherever they are opened.

    Parameters
    ----------
    files : Files
        Of the store.
    description : str
        Checksum of the store's description: the files at the same place of another machine may be others.
    group : str
        Its name in the store.

    """

    files: Files
    description: str
    group: str

    def open(self, name: str) -> Any:
        """Return an array that can be changed in place; raise ``StoreError`` where this is another store."""
        return _opened(self, name)


@lru_cache(maxsize=64)
def _opened(arrays: Arrays, name: str) -> Any:
    files = arrays.files
    with told(files.url):
        if description_of(files) != arrays.description:
            raise StoreError(
                f"a worker does not find the sweep in {files.url!r}: --output must be a folder that all share, "
                "or an object store"
            )
        place = files.below(f"{arrays.group}/{name}")
        return zarr.open_array(place, mode="r+", zarr_format=2, storage_options=files.options)


def description_of(files: Files) -> str:
    """Return the checksum of the description of a store."""
    return hashlib.blake2b(files.read(DESCRIPTION) or b"", digest_size=8).hexdigest()


@dataclass(frozen=True)
class Chunks:
    """The chunks of a round, of ``count`` trajectories: ``size`` of them in each but the last."""

    arrays: Arrays
    count: int
    size: int

    def __len__(self) -> int:
        return -(-self.count // self.size)

    def where(self, chunk: int) -> slice:
        """Return the places of the trajectories of a chunk."""
        return slice(chunk * self.size, min((chunk + 1) * self.size, self.count))

    def read(self, name: str, where: int | slice) -> NDArray[Any]:
        """Return results of trajectories in the order of the round."""
        return np.asarray(self.arrays.open(name)[where])

    def write(self, chunk: int, results: Mapping[str, NDArray[Any]]) -> None:
        """Write a chunk, and then that it is written; raise ``StoreError`` where that can't be."""

        def put(item: tuple[str, NDArray[Any]]) -> None:
            name, values = item
            self.arrays.open(name)[self.where(chunk)] = values

        with told(self.arrays.files.url):
            with ThreadPoolExecutor(
                len(results)
            ) as pool:  # an object store answers late, and takes many at once
                list(pool.map(put, results.items()))
            self.arrays.open(CHECKSUM)[chunk] = _checksum_of(chunk, results)

    def is_whole(self, chunk: int) -> bool:
        """Return whether a chunk has the contents that it was written with."""
        where = self.where(chunk)
        try:
            mark = int(self.arrays.open(CHECKSUM)[chunk])
            return mark == _checksum_of(chunk, {name: self.read(name, where) for name in RESULTS})
        except MemoryError:
            raise
        except Exception:  # whatever is raised by a file that may have any contents
            return False


class Round:
    """The trajectories ``numbers`` of a round.

    ``done`` says for each chunk whether it is there with the contents that it was written with; ``marked`` are those
    that were written, as far as is known before one looks.
    """

    def __init__(self, chunks: Chunks, numbers: Numbers) -> None:
        self.chunks, self.numbers = chunks, numbers
        self.done: NDArray[np.bool_] = np.zeros(len(chunks), dtype=bool)
        arrays = chunks.arrays
        names = arrays.files.inside(f"{arrays.group}/{CHECKSUM}")
        self.marked = sorted(int(name) for name in names if name.isdigit() and int(name) < len(chunks))

    def numbers_of(self, chunk: int) -> Numbers:
        """Return the numbers of the trajectories of a chunk."""
        return self.numbers[self.chunks.where(chunk)]

    @property
    def ends(self) -> Any:
        """What the trajectories end as, an array that reads itself once its values are wanted."""
        return self.chunks.arrays.open("end")


def _checksum_of(chunk: int, results: Mapping[str, NDArray[Any]]) -> int:
    """Return the checksum of the results of a chunk, which is never 0."""
    digest = hashlib.blake2b(str(chunk).encode(), digest_size=8)
    for name, result in RESULTS.items():
        digest.update(np.ascontiguousarray(results[name], dtype=result.dtype).tobytes())
    return int.from_bytes(digest.digest(), "little") or 1
