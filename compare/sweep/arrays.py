"""Groups of arrays in Zarr version 3, which xarray writes at once or region by region.

Every piece has a crc32c checksum, so other readers notice a damaged piece. The seals of groups and chunks also bind
each piece to its place in this store, so a moved or missing piece is damage.
"""

import hashlib
import json
import re
from collections.abc import Iterable, Mapping
from contextlib import suppress
from dataclasses import dataclass
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np
import xarray as xr
import zarr
from numpy.typing import NDArray
from zarr.codecs import BloscCodec, Crc32cCodec

from compare.sweep.files import Files, StoreError, store_errors
from compare.sweep.plan import Numbers
from compare.sweep.quantities import RESULTS

DESCRIPTION = "zarr.json"

FORMAT: dict[str, Any] = {"zarr_format": 3, "consolidated": False}
"""Arguments for Zarr; consolidated metadata would become outdated when a group grows."""

CODECS = (BloscCodec(cname="lz4"), Crc32cCodec())

TYPES = {"float64", "uint8", "int64", "string"}
CHAINS = [[first, "blosc", "crc32c"] for first in ("bytes", "vlen-utf8")]
"""Allowed data types with their codecs."""

MISSING = {"f8": -np.inf, "u1": 255, "i8": -1}
"""Fill values by type; no result has them, because Zarr may omit a piece that contains nothing else."""

CHECKSUM = "checksum"

CHUNK_SEAL = "{}/end/seals/{}"
"""File with the seal of a chunk of a round, in the folder of an array, where Zarr looks only for pieces."""

SEALED = re.compile(rf"(?!round-\d+/({'|'.join(RESULTS)})/c/)[^/]+/[^/]+/({DESCRIPTION}|c(/\d+)*)")
"""Files that the seal of their group covers: all but the chunks of rounds, which have seals of their own."""


class Large(NamedTuple):
    """An array that is written region by region."""

    dimensions: tuple[str, ...]
    shape: tuple[int, ...]
    pieces: tuple[int, ...]
    dtype: str
    attributes: dict[str, Any]


@dataclass(frozen=True)
class Group:
    """A group of a store, which any process may open.

    ``description`` is the digest of the store's description; another machine may have another store at that path.
    """

    files: Files
    description: str
    name: str

    @property
    def _place(self) -> dict[str, Any]:
        return {"group": self.name, "storage_options": self.files.options, **FORMAT}

    def create(self, arrays: Mapping[str, Large]) -> None:
        """Create a group with empty arrays."""
        group = zarr.create_group(
            self.files.url, path=self.name, zarr_format=3, storage_options=self.files.options
        )
        for name, array in arrays.items():
            group.create_array(
                name,
                shape=array.shape,
                chunks=array.pieces,
                dtype=array.dtype,
                fill_value=MISSING[array.dtype],
                compressors=CODECS,
                dimension_names=array.dimensions,
                attributes=array.attributes,
            )

    def add(self, dataset: xr.Dataset) -> None:
        """Write all variables of a dataset into the group."""
        texts = [name for name, values in dataset.variables.items() if values.dtype.kind == "U"]
        # Zarr 3 has no standard data type for NumPy's fixed-length strings
        dataset = dataset.assign({name: dataset[name].astype(object) for name in texts})
        encoding = {name: {"compressors": CODECS} for name in dataset.variables}
        dataset.to_zarr(self.files.url, mode="a", encoding=encoding, write_empty_chunks=True, **self._place)

    def write(self, values: Mapping[str, NDArray[Any]], region: Mapping[str, slice]) -> None:
        """Write a region of arrays, whose first dimensions are the ordered keys of ``region``.

        Raises :class:`StoreError` if it cannot be written, or if this is a different store.
        """
        with store_errors(self.files.url):
            self._check_there()
            dimensions = (*region, "component")
            written = xr.Dataset({name: (dimensions[: one.ndim], one) for name, one in values.items()})
            try:
                written.to_zarr(self.files.url, mode="r+", region=region, **self._place)
            except Exception:
                self._check_there()
                raise

    def _check_there(self) -> None:
        described = self.files.read(f"{self.name}/{DESCRIPTION}")
        if described is None or description_of(self.files) != self.description:
            raise StoreError(
                f"cannot find the sweep in {self.files.url!r}; it was removed, or a worker cannot reach it because "
                "--output is not a shared folder or an object store"
            )

    def array(self, name: str) -> Any:
        """Return an array without reading its values."""
        return _opened(self, name)

    def dataset(self) -> xr.Dataset:
        """Return all arrays with their labels without reading their values."""
        found: xr.Dataset = xr.open_zarr(self.files.url, chunks=None, **self._place)
        return found

    def seal(self) -> None:
        """Write the checksum that makes the group valid."""
        self.files.write({f"{self.name}/{DESCRIPTION}": self._seal(self._sealed())})

    def is_intact(self) -> bool | None:
        """Return whether the group matches its seal; None for an unfinished group, which has none."""
        seal = self.files.read(f"{self.name}/{DESCRIPTION}")
        with suppress(ValueError, KeyError, TypeError, RecursionError):
            if seal is None or json.loads(seal)["attributes"] == {}:
                return None
        names = self._sealed()
        described = (self.files.read(name) or b"" for name in names if name.endswith(DESCRIPTION))
        return all(map(is_ours, described)) and seal == self._seal(names)

    def _sealed(self) -> list[str]:
        return [name for name in self.files.names(self.name) if SEALED.fullmatch(name)]

    def _seal(self, names: Iterable[str]) -> bytes:
        digests = {name: digest_of(self.files.read(name) or b"") for name in names}
        return group_content({CHECKSUM: checksum(digests | {"": self.description})})

    def seal_chunk(self, where: slice, values: Mapping[str, NDArray[Any]]) -> None:
        """Write the checksum that makes a chunk of a round valid, after all its arrays."""
        chunk = where.start // self.array("end").chunks[0]
        self.files.write({CHUNK_SEAL.format(self.name, chunk): self._chunk_seal(where, values)})

    def is_whole(self, chunk: int, where: slice) -> bool:
        """Return whether the arrays of a chunk of a round match its seal."""
        try:
            values = {name: self.array(name)[where] for name in RESULTS}
            return self.files.read(CHUNK_SEAL.format(self.name, chunk)) == self._chunk_seal(where, values)
        except MemoryError:
            raise
        except Exception:  # a damaged file may raise anything
            return False

    def _chunk_seal(self, where: slice, values: Mapping[str, NDArray[Any]]) -> bytes:
        found = hashlib.blake2b(repr((self.description, self.name, where)).encode(), digest_size=8)
        for name, result in RESULTS.items():
            found.update(np.ascontiguousarray(values[name], result.dtype).tobytes())
        return found.hexdigest().encode()


@lru_cache(maxsize=64)
def _opened(group: Group, name: str) -> Any:
    files = group.files
    with store_errors(files.url, "read from"):
        place = f"{group.name}/{name}"
        return zarr.open_array(files.url, path=place, mode="r", zarr_format=3, storage_options=files.options)


def is_ours(description: bytes) -> bool:
    """Return whether sweeps write such arrays; other codecs, such as "pickle", could run foreign code."""
    try:
        found = json.loads(description)
        chain = [codec["name"] for codec in found["codecs"]]
        known = found["data_type"] in TYPES and chain in CHAINS and not found.get("storage_transformers")
        return bool(known and found["zarr_format"] == 3 and found["node_type"] == "array")
    except (ValueError, KeyError, TypeError, RecursionError):
        return False


def group_content(attributes: Mapping[str, Any]) -> bytes:
    """Return the contents of the file that describes a group."""
    content = {"zarr_format": 3, "node_type": "group", "attributes": attributes}
    return json.dumps(content, sort_keys=True).encode()


def description_of(files: Files) -> str:
    """Return the digest of a store's description."""
    return digest_of(files.read(DESCRIPTION) or b"")


def checksum(attributes: Mapping[str, Any]) -> str:
    """Return the checksum of attributes."""
    return digest_of(json.dumps(attributes, sort_keys=True).encode())


def digest_of(content: bytes) -> str:
    """Return the digest of the contents of a file."""
    return hashlib.blake2b(content, digest_size=8).hexdigest()


class Round:
    """The trajectories ``numbers`` of a round, in chunks of at most ``size``; ``done`` marks the readable chunks.

    Two workers that write the same chunk write the same bits.
    """

    def __init__(self, group: Group, numbers: Numbers, size: int) -> None:
        self.group, self.numbers, self.size = group, numbers, size
        self.done: NDArray[np.bool_] = np.zeros(-(-len(numbers) // size), dtype=bool)

    def where(self, chunk: int) -> slice:
        """Return the indices of a chunk's trajectories in the round."""
        return slice(chunk * self.size, min((chunk + 1) * self.size, len(self.numbers)))

    def there(self) -> list[int]:
        """Return the chunks with a seal."""
        files = set(self.group.files.names(f"{self.group.name}/end"))
        return [
            chunk for chunk in range(len(self.done)) if CHUNK_SEAL.format(self.group.name, chunk) in files
        ]
