"""The trajectories of a round in the store: arrays whose regions are written by whoever simulates a chunk.

Two who write the same chunk write the same bits.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from compare.sweep.define.plan import Numbers
from compare.sweep.define.quantities import RESULTS
from compare.sweep.store.arrays import Group


@dataclass(frozen=True)
class Chunks:
    """The chunks of a round, of ``count`` trajectories: ``size`` of them in each but the last."""

    group: Group
    count: int
    size: int

    def __len__(self) -> int:
        return -(-self.count // self.size)

    def where(self, chunk: int) -> slice:
        """Return the places of the trajectories of a chunk."""
        return slice(chunk * self.size, min((chunk + 1) * self.size, self.count))

    def read(self, name: str, where: int | slice) -> NDArray[Any]:
        """Return results of trajectories in the order of the round."""
        return np.asarray(self.group.array(name)[where])

    def write(self, chunk: int, results: Mapping[str, NDArray[Any]]) -> None:
        """Write a chunk; raise ``StoreError`` where that can't be."""
        self.group.write(results, {"trajectory": self.where(chunk)})

    def there(self) -> list[int]:
        """Return the chunks of which all files are there."""
        files = set(self.group.files.names(self.group.name))
        keys = {name: "{}/0" if name == "states" else "{}" for name in RESULTS}  # one for each dimension
        return [
            chunk
            for chunk in range(len(self))
            if all(f"{self.group.name}/{name}/c/{key.format(chunk)}" in files for name, key in keys.items())
        ]

    def is_whole(self, chunk: int) -> bool:
        """Return whether all results of a chunk can be read."""
        return all(self.group.can_read(name, self.where(chunk)) for name in RESULTS)


class Round:
    """The trajectories ``numbers`` of a round; ``done`` says of each chunk whether it is there and whole."""

    def __init__(self, chunks: Chunks, numbers: Numbers) -> None:
        self.chunks, self.numbers = chunks, numbers
        self.done: NDArray[np.bool_] = np.zeros(len(chunks), dtype=bool)

    def numbers_of(self, chunk: int) -> Numbers:
        """Return the numbers of the trajectories of a chunk."""
        return self.numbers[self.chunks.where(chunk)]

    @property
    def ends(self) -> Any:
        """What the trajectories end as, an array that reads itself once its values are wanted."""
        return self.chunks.group.array("end")
