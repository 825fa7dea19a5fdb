"""Groups of arrays in Zarr version 3, which xarray writes at once or region by region.

Every piece has a crc32c checksum, so reading a damaged piece raises an error.
"""

import hashlib
import json
from collections.abc import Iterable, Mapping, Sequence
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
            if description_of(self.files) != self.description:
                raise StoreError(
                    f"a worker cannot find the sweep in {self.files.url!r}; --output must be a shared folder or an "
                    "object store"
                )
            dimensions = (*region, "component")
            written = xr.Dataset({name: (dimensions[: one.ndim], one) for name, one in values.items()})
            written.to_zarr(self.files.url, mode="r+", region=region, **self._place)

    def array(self, name: str) -> Any:
        """Return an array without reading its values."""
        return _opened(self, name)

    def dataset(self) -> xr.Dataset:
        """Return all arrays with their labels without reading their values."""
        found: xr.Dataset = xr.open_zarr(self.files.url, chunks=None, **self._place)
        return found

    def seal(self) -> None:
        """Write the checksum that makes the group valid."""
        self.files.write({f"{self.name}/{DESCRIPTION}": _seal(self._described())})

    def is_intact(self, names: Sequence[str] = ()) -> bool | None:
        """Return whether the group matches its seal, and the arrays ``names`` (default: all) are readable.

        The result is None for an unfinished group, which has no seal.
        """
        seal = self.files.read(f"{self.name}/{DESCRIPTION}")
        with suppress(ValueError, KeyError, TypeError):
            if seal is None or json.loads(seal)["attributes"] == {}:
                return None
        described = self._described()
        if seal != _seal(described) or not all(map(is_ours, described.values())):
            return False
        return all(map(self._is_whole, names or described))

    def _is_whole(self, name: str) -> bool:
        array = self.array(name)
        pieces = range(0, array.shape[0], array.chunks[0])
        return array.nchunks_initialized == array.nchunks and all(
            self.can_read([name], slice(first, first + array.chunks[0])) for first in pieces
        )

    def can_read(self, names: Iterable[str], where: slice) -> bool:
        """Return whether a part of these arrays is intact."""
        try:
            for name in names:
                self.array(name)[where]
        except MemoryError:
            raise
        except Exception:  # a damaged file may raise anything
            return False
        return True

    def _described(self) -> dict[str, bytes]:
        files = {name: f"{self.name}/{name}/{DESCRIPTION}" for name in self.files.inside(self.name)}
        found = {name: self.files.read(file) for name, file in files.items()}
        return {name: content for name, content in found.items() if content is not None}


@lru_cache(maxsize=64)
def _opened(group: Group, name: str) -> Any:
    files = group.files
    with store_errors(files.url, "read from"):
        place = f"{group.name}/{name}"
        return zarr.open_array(files.url, path=place, mode="r", zarr_format=3, storage_options=files.options)


def _seal(described: Mapping[str, bytes]) -> bytes:
    return group_content({CHECKSUM: checksum({name: digest_of(one) for name, one in described.items()})})


def is_ours(description: bytes) -> bool:
    """Return whether sweeps write such arrays; other codecs, such as "pickle", could run foreign code."""
    try:
        found = json.loads(description)
        chain = [codec["name"] for codec in found["codecs"]]
        known = found["data_type"] in TYPES and chain in CHAINS and not found.get("storage_transformers")
        return bool(known and found["zarr_format"] == 3 and found["node_type"] == "array")
    except (ValueError, KeyError, TypeError):
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
        """Return the chunks with all files."""
        files = set(self.group.files.names(self.group.name))
        keys = {name: "{}/0" if name == "states" else "{}" for name in RESULTS}
        return [
            chunk
            for chunk in range(len(self.done))
            if all(f"{self.group.name}/{name}/c/{key.format(chunk)}" in files for name, key in keys.items())
        ]
