"""Results of a sweep as labelled arrays; workers write them block by block."""

import math
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from compare.claims import shares
from compare.claims.shares import Share
from compare.sweep.arrays import Group, Large, Round
from compare.sweep.compute.motions import Motion, matched, motions_of
from compare.sweep.compute.sensitivity import GROUPS, Moments, indices, moments
from compare.sweep.compute.theory import curves, theory_branches
from compare.sweep.plan import BASES, Basin, Continuation, Map, Plan, RandomBasin, Uncertainty
from compare.sweep.quantities import RESULTS, Axis, components, units
from compare.sweep.refinement import Grid
from compare.sweep.store import flags
from reference_model.ensemble import EndState
from reference_model.systems import System

SHOWN = ("end", "time", "least_radius", "largest_radius", "slip_power")
"""Labelled results of a trajectory; its state remains in its round."""

BLOCK = 1 << 17
"""Approximate number of trajectories per block, for little memory."""

ENDS = [end.name.lower() for end in EndState]

SENSITIVE = ("largest_radius", "whirl")
"""Results with sensitivities; "whirl" is 1 for a whirl, else 0."""

Variables = dict[str, tuple[Any, ...]]
Values = dict[str, NDArray[Any]]


class Block(NamedTuple):
    """Trajectories ``first`` to ``last`` of a plan, and their region of the arrays."""

    first: int
    last: int
    where: tuple[slice, ...]


class Part(NamedTuple):
    """Trajectories of a block from one round: their indices in both."""

    group: Group
    where: slice
    places: slice | NDArray[np.int64]


class Labelled(NamedTuple):
    """Summary of a block.

    ``counts``, shape (rows, ends), are the trajectories of each ``EndState``, with a row for each value of a
    continuation, else one row. ``motions`` are listed for each value.
    """

    counts: NDArray[np.int64]
    moments: Moments | None
    motions: list[list[Motion]]


def _layout(plan: Plan) -> tuple[tuple[str, ...], tuple[int, ...], int, int]:
    """Return dimensions, shape, trajectories per row, and rows per block of the labelled arrays."""
    if isinstance(plan, RandomBasin):
        return ("sample",), (plan.samples,), 1, BLOCK
    if isinstance(plan, Uncertainty):
        size = min(plan.samples // GROUPS, 1 << (BLOCK // plan.row).bit_length() - 1)
        return ("sample",), (BASES * plan.samples,), plan.row, size
    if isinstance(plan, Continuation):
        dimensions, shape = (plan.x.name, "sample"), (plan.x.points, plan.samples)
    else:
        assert isinstance(plan, Basin | Map)
        dimensions, shape = (plan.y.name, plan.x.name), (plan.y.points, plan.x.points)
    size = max(1, BLOCK // shape[-1])
    if isinstance(plan, Map):
        return ("start", *dimensions), plan.shape, shape[-1], size
    return dimensions, shape, shape[-1], size


def blocks_of(plan: Plan) -> list[Block]:
    """Return the blocks of a plan, which do not depend on chunks or threads."""
    _, shape, across, size = _layout(plan)
    labels = BASES if isinstance(plan, Uncertainty) else 1
    *planes, rows = shape[:-1] or (shape[0] // labels,)
    inside = tuple(slice(0, count) for count in shape[1:][-1:])
    blocks = []
    for plane in range(math.prod(planes)):
        outside = tuple(slice(plane, plane + 1) for _ in planes)
        for i in range(0, rows, size):
            j = min(i + size, rows)
            first, last = ((plane * rows + row) * across for row in (i, j))
            blocks.append(Block(first, last, (*outside, slice(labels * i, labels * j), *inside)))
    return blocks


def large_of(plan: Plan) -> dict[str, Large]:
    """Return the labelled arrays with one value per trajectory."""
    dimensions, shape, *_ = _layout(plan)
    pieces = tuple(at.stop - at.start for at in blocks_of(plan)[0].where)

    def large(dtype: str, attributes: dict[str, Any]) -> Large:
        return Large(dimensions, shape, pieces, dtype, attributes)

    found: dict[str, Large] = {}
    if isinstance(plan, RandomBasin | Uncertainty):
        inputs = plan.varied if isinstance(plan, Uncertainty) else (plan.x, plan.y)
        found = {one.name: large("f8", {"units": units(plan.system)[one.name]}) for one in inputs}
    for name in SHOWN:
        attributes = {"long_name": RESULTS[name].meaning, "units": RESULTS[name].unit}
        found[name] = large(RESULTS[name].dtype, attributes | flags(name))
    if isinstance(plan, Map):
        found["modulation"] = large("f8", {"long_name": "(largest − least)/(largest + least) radius"})
    if isinstance(plan, Basin):
        meaning = {
            "long_name": "1 if the trajectory was simulated, 0 if its end was inferred from its neighbours"
        }
        found["simulated"] = large("u1", meaning)
    return found


def parts_of(block: Block, rounds: Sequence[Round]) -> list[Part]:
    """Return the parts of a block in the rounds."""
    parts = []
    for one in rounds:
        if isinstance(one.numbers, range):
            where = slice(block.first, block.last)
            parts.append(Part(one.group, where, slice(None)))
        else:
            start, stop = np.searchsorted(one.numbers, (block.first, block.last)).tolist()
            if start < stop:
                where = slice(start, stop)
                parts.append(Part(one.group, where, one.numbers[where] - block.first))
    return parts


def label(
    group: Group, plan: Plan, block: Block, parts: Sequence[Part], grid: tuple[NDArray[Any], ...] | None
) -> Labelled:
    """Write the results of a block; ``grid`` contains a basin's ends and marks."""
    found = {name: _found(name, block, parts) for name in SHOWN}
    sensitive, motions = None, list[list[Motion]]()
    numbers = range(block.first, block.last)
    values: Values = dict(found)
    if isinstance(plan, Basin):
        assert grid is not None
        values["end"], values["simulated"] = (part.ravel() for part in grid)
    elif isinstance(plan, Map):
        least, largest = found["least_radius"], found["largest_radius"]
        with np.errstate(invalid="ignore"):
            values["modulation"] = np.where(largest == 0.0, 0.0, (largest - least) / (largest + least))
    elif isinstance(plan, Continuation):
        table = [found[name].reshape(-1, plan.samples) for name in ("end", "least_radius", "largest_radius")]
        motions = [motions_of(*row) for row in zip(*table, strict=True)]
    elif isinstance(plan, RandomBasin):
        states, _ = plan.trajectories(numbers)
        places = list(components(plan.system))
        values |= {axis.name: states[:, places.index(axis.name)] for axis in (plan.x, plan.y)}
    else:
        assert isinstance(plan, Uncertainty)
        sensitive = moments(_sensitive(plan, found, _found("states", block, parts)))
        drawn = np.arange(block.first, block.last).reshape(-1, plan.row)[:, :BASES].ravel()
        values = plan.values(drawn) | {name: all_[drawn - block.first] for name, all_ in found.items()}
    shape = tuple(at.stop - at.start for at in block.where)
    region = dict(zip(_layout(plan)[0], block.where, strict=True))
    group.write({name: one.reshape(shape) for name, one in values.items()}, region)
    ends = values["end"].reshape(-1, plan.samples) if isinstance(plan, Continuation) else [values["end"]]
    counts = np.array([shares.counted(row) for row in ends])
    return Labelled(counts, sensitive, motions)


def _found(name: str, block: Block, parts: Sequence[Part]) -> NDArray[Any]:
    """Return a result of a block, shape (n, ...); NaN or 0 where none was simulated."""
    found = [(part.places, part.group.array(name)[part.where]) for part in parts]
    more = found[0][1].shape[1:] if found else ()
    dtype = np.dtype(RESULTS[name].dtype)
    values = np.full((block.last - block.first, *more), np.nan if dtype.kind == "f" else 0, dtype)
    for places, there in found:
        values[places] = there
    return values


def _sensitive(plan: Uncertainty, found: Values, states: NDArray[Any]) -> NDArray[Any]:
    last_radius = np.hypot(*states[:, :2].T)
    radius = np.where(found["end"] == EndState.UNDECIDED, last_radius, found["largest_radius"])
    return np.stack((radius, found["end"] == EndState.WHIRL)).reshape(len(SENSITIVE), -1, plan.row)


def labels_of(plan: Plan, found: Sequence[Labelled], grid: Grid | None) -> xr.Dataset:
    """Return all results from the ordered summaries of blocks."""
    rows = np.concatenate([one.counts for one in found])
    counts = np.sum(rows, axis=0)
    variables: Variables = {
        "count": (("end_state",), counts, {"long_name": "number of trajectories with this end"})
    }
    coordinates: dict[str, Any] = {"end_state": ENDS}
    if isinstance(plan, Basin | Map):
        axes = (plan.y, plan.x)
        coordinates |= _coordinates(plan.system, axes)
    if isinstance(plan, Basin):
        assert grid is not None
        variables |= _shares(shares.of_grid(grid.ends), shares.GRID)
    elif isinstance(plan, Map):
        coordinates["component"] = list(components(plan.system))
        variables["initial_state"] = (("start", "component"), np.array(plan.starts))
    elif isinstance(plan, Continuation):
        coordinates |= _coordinates(plan.system, (plan.x,))
        columns = [_shares(shares.of_counts(row), shares.SAMPLE) for row in rows]
        for name, (_, _, *attributes) in columns[0].items():
            values = np.array([column[name][1] for column in columns])
            variables[name] = ((plan.x.name, "end_state"), values, *attributes)
        variables |= _motions(plan, [motions for one in found for motions in one.motions])
    else:
        variables |= _shares(shares.of_counts(counts), shares.SAMPLE)
    if isinstance(plan, Uncertainty):
        coordinates |= {"quantity": list(SENSITIVE), "uncertain": [one.name for one in plan.varied]}
        blocks = [one.moments for one in found if one.moments is not None]
        for name, values in indices(blocks)._asdict().items():
            variables[f"sobol_{name}"] = (("quantity", "uncertain"), values)
    return xr.Dataset(variables, coords=coordinates)


def _motions(plan: Continuation, found: Sequence[Sequence[Motion]]) -> Variables:
    branches = matched(found, lambda motion: motion.end)
    ends = [next(iter(branch.values())).end for branch in branches]
    variables: Variables = {
        "motion_end": (("motion",), np.array(ends, dtype="u1"), flags("end")),
        **_along(plan, "motion", branches, ("least", "largest")),
    }
    intervals = np.full((3, len(branches), plan.x.points), np.nan)
    for j, branch in enumerate(branches):
        for i, motion in branch.items():
            intervals[:, j, i] = shares.of_count(motion.starts, plan.samples)
    for name, values in zip(
        ("motion_share", "motion_share_low", "motion_share_high"), intervals, strict=True
    ):
        variables[name] = (("motion", plan.x.name), values)
    return variables


def _along(
    plan: Continuation, name: str, branches: Sequence[Mapping[int, Any]], fields: Sequence[str]
) -> Variables:
    variables: Variables = {}
    for field in fields:
        values = np.full((len(branches), plan.x.points), np.nan)
        for j, branch in enumerate(branches):
            for i, motion in branch.items():
                values[j, i] = getattr(motion, field)
        attributes = {"long_name": f"{field} radius", "units": "m"} if field != "stable" else {}
        variables[f"{name}_{field}"] = ((name, plan.x.name), values, attributes)
    return variables


def branches_of(plan: Continuation) -> xr.Dataset:
    """Return the motions of formulas and continuation; ``theory_stable`` is 1 or 0."""
    found = theory_branches(plan)
    meanings = [next(iter(branch.values())).meaning for branch in found]
    return xr.Dataset(
        _along(plan, "theory", found, ("least", "largest", "stable")),
        coords=_coordinates(plan.system, (plan.x,)) | {"theory": np.array(meanings, dtype=str)},
    )


def curves_of(plan: Map) -> xr.Dataset:
    """Return the theory's curves in the plane of a map."""
    found = curves(plan)
    points = np.concatenate([curve.points for curve in found]) if found else np.empty((0, 2))
    of_curve = np.repeat(np.arange(len(found)), [len(curve.points) for curve in found])
    return xr.Dataset(
        {
            plan.x.name: (("point",), points[:, 0], {"units": units(plan.system)[plan.x.name]}),
            plan.y.name: (("point",), points[:, 1], {"units": units(plan.system)[plan.y.name]}),
            "of_curve": (("point",), of_curve),
        },
        coords={"curve": [curve.meaning for curve in found]},
    )


def _coordinates(system: System, axes: Sequence[Axis]) -> dict[str, Any]:
    return {axis.name: (axis.name, axis.values, {"units": units(system)[axis.name]}) for axis in axes}


def _shares(found: Mapping[EndState, Share], meaning: str) -> Variables:
    values = np.array([found[end] for end in EndState])
    names = ("share", "share_low", "share_high")
    result: Variables = {name: (("end_state",), column) for name, column in zip(names, values.T, strict=True)}
    for name in names[1:]:
        result[name] += ({"long_name": meaning},)
    return result
