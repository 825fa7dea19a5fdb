"""Results of a sweep on disk: a Zarr store of xarray Datasets, valid at every moment.

- ``round-0``, ``round-1``, ...: what was simulated, one Dataset a round, written chunk by chunk. A chunk counts
  when ``done`` says so, which is written after all of it.
- ``check``, ``result``, ``curves``: written when all chunks are done.

A group is made under another name and renamed when it is whole. The attributes of the store have the plan, the code
that computed it and its libraries.
"""

from __future__ import annotations

import json
import os
import shutil
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
import zarr
from numpy.typing import NDArray

from compare.store import version_of
from compare.sweep.plan import Numbers, Plan, as_json, from_json
from compare.sweep.quantities import RESULTS, components
from compare.sweep.stamp import sweep_stamp

FORMAT: dict[str, Any] = {"zarr_format": 2, "consolidated": False}
"""Every version of Zarr reads it, and no copy of the metadata goes stale when a round grows."""

PART = "part"
"""Name of a group that is being written."""

ROUND = "round-{}"

MISSING = {"f8": np.nan, "u1": 255, "i8": -1}
"""What an array has where nothing is written, by its type: no result is like this."""


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

    @classmethod
    def create(cls, path: Path, plan: Plan, chunk: int) -> SweepStore:
        """Make a store where nothing is yet; ``FileExistsError`` where something is."""
        made = path.with_name(f"{path.name}.{PART}")
        shutil.rmtree(made, ignore_errors=True)
        libraries = ("friction-discs", "numpy", "scipy", "numba", "xarray", "zarr")
        attributes = {
            "title": f"friction-discs sweep: {plan.kind}",
            "plan": json.dumps(as_json(plan)),
            "chunk": chunk,
            "stamp": sweep_stamp(),
            "versions": json.dumps({name: version_of(name) for name in libraries}),
        }
        xr.Dataset(attrs=attributes).to_zarr(made, mode="w", **FORMAT)
        os.rename(made, path)
        return cls(path, plan, chunk, sweep_stamp())

    @classmethod
    def open(cls, path: Path) -> SweepStore:
        """Open a store; raise ``ValueError`` if there is none of a sweep."""
        try:
            attributes = xr.open_zarr(path, consolidated=False, chunks=None).attrs
            plan = from_json(json.loads(attributes["plan"]))
            return cls(path, plan, int(attributes["chunk"]), attributes["stamp"])
        except (OSError, KeyError, TypeError, ValueError):
            raise ValueError(f"{str(path)!r} is no store of a sweep") from None

    def round(self, i: int, numbers: Numbers) -> Round:
        """Return round ``i`` of the trajectories ``numbers``, made if it is not there."""
        name = ROUND.format(i)
        if not (self.path / name).exists():
            self._make_round(name, len(numbers))
        return Round(self.path / name, numbers, self.chunk)

    def _make_round(self, name: str, count: int) -> None:
        """Make arrays without chunks; they grow to their size before the group gets its name."""
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
        variables["done"] = ("chunk", np.zeros(0, "u1"), {"long_name": "1 where the chunk is written"})
        encoding["done"] = {"chunks": (1,), "_FillValue": 0}
        shapes["done"] = (-(-count // self.chunk),)
        template = xr.Dataset(variables, coords={"component": state})
        self._write(PART, template, encoding)
        group = _arrays(self.path / PART)
        for variable, shape in shapes.items():
            group[variable].resize(shape)
        os.rename(self.path / PART, self.path / name)

    def put(self, name: str, dataset: xr.Dataset) -> None:
        """Write a group, in place of an older one."""
        self._write(PART, dataset, {})
        shutil.rmtree(self.path / name, ignore_errors=True)
        os.rename(self.path / PART, self.path / name)

    def _write(self, name: str, dataset: xr.Dataset, encoding: Mapping[str, Any]) -> None:
        shutil.rmtree(self.path / name, ignore_errors=True)
        dataset.to_zarr(
            self.path, group=name, mode="w", encoding=dict(encoding), write_empty_chunks=True, **FORMAT
        )

    def get(self, name: str) -> xr.Dataset | None:
        """Return a group, or None if it is not there."""
        if not (self.path / name).exists():
            return None
        group: xr.Dataset = xr.open_zarr(self.path, group=name, consolidated=False, chunks=None)
        return group


class Round:
    """The trajectories of a round on disk."""

    def __init__(self, path: Path, numbers: Numbers, chunk: int) -> None:
        self.numbers = numbers
        self._chunk = chunk
        self._arrays = _arrays(path)
        self.done: NDArray[np.bool_] = np.asarray(self._arrays["done"][:]) == 1

    def numbers_of(self, chunk: int) -> Numbers:
        """Return the numbers of the trajectories of a chunk."""
        return self.numbers[self._slice(chunk)]

    def write(self, chunk: int, results: Mapping[str, NDArray[Any]]) -> None:
        """Write a chunk, and then that it is written."""
        for name, values in results.items():
            self._arrays[name][self._slice(chunk)] = values
        self._arrays["done"][chunk] = 1
        self.done[chunk] = True

    def read(self, name: str, where: int | slice = slice(None)) -> NDArray[Any]:
        """Return results of trajectories in the order of ``numbers``."""
        return np.asarray(self._arrays[name][where])

    def _slice(self, chunk: int) -> slice:
        return slice(chunk * self._chunk, min((chunk + 1) * self._chunk, len(self.numbers)))


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
