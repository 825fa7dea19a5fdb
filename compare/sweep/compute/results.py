"""Results of a whole sweep as labelled arrays."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from compare.claims import shares
from compare.claims.shares import Share
from compare.sweep.compute.curves import curves
from compare.sweep.compute.store import Round, flags
from compare.sweep.define.axes import Axis
from compare.sweep.define.plan import BASES, Basin, Map, Plan, RandomBasin, Uncertainty
from compare.sweep.define.quantities import RESULTS, components, units
from compare.sweep.define.refinement import Grid
from reference_model.ensemble import EndState
from reference_model.systems import System

SHOWN = ("end", "time", "least_radius", "largest_radius", "slip_power")
"""What of a trajectory is labelled; its state stays with its round."""

ENDS = [end.name.lower() for end in EndState]

SENSITIVE = ("largest_radius", "whirl")
"""Of what the sensitivities are given.

Where a trajectory is undecided its last radius takes the place of the largest one of its end; "whirl" is 1 where it
ends as a whirl and 0 elsewhere.
"""

Variables = dict[str, tuple[Any, ...]]


def result_of(plan: Plan, rounds: Sequence[Round], grid: Grid | None) -> xr.Dataset:
    """Return the labelled results of ``plan``, all of whose rounds are done; ``grid`` is what a basin came to."""
    if isinstance(plan, Basin) and grid is not None:
        return _basin(plan, rounds, grid)
    (only,) = rounds
    if isinstance(plan, Map):
        return _map(plan, only)
    if isinstance(plan, Uncertainty):
        return _uncertainty(plan, only)
    assert isinstance(plan, RandomBasin)
    return _random_basin(plan, only)


def _basin(plan: Basin, rounds: Sequence[Round], grid: Grid) -> xr.Dataset:
    dimensions = (plan.y.name, plan.x.name)
    variables: Variables = {}
    for name in SHOWN[1:]:
        values = np.full(grid.ends.shape, np.nan)
        for one in rounds:
            values.flat[np.asarray(one.numbers)] = one.read(name)
        variables[name] = _variable(name, dimensions, values)
    variables["end"] = _variable("end", dimensions, grid.ends)
    attributes = {"long_name": "whether the trajectory was simulated; the others end as those around them"}
    variables["simulated"] = (dimensions, grid.simulated, attributes)
    return xr.Dataset(
        variables | _shares(shares.of_grid(grid.ends), shares.GRID),
        coords=_coordinates(plan.system, (plan.y, plan.x)) | {"end_state": ENDS},
    )


def _random_basin(plan: RandomBasin, found: Round) -> xr.Dataset:
    states, _ = plan.trajectories(found.numbers)
    places = list(components(plan.system))
    variables: Variables = {
        axis.name: _input(plan.system, axis.name, states[:, places.index(axis.name)])
        for axis in (plan.x, plan.y)
    }
    variables |= {name: _variable(name, ("sample",), found.read(name)) for name in SHOWN}
    variables |= _shares(shares.of_sample(variables["end"][1]), shares.SAMPLE)
    return xr.Dataset(variables, coords={"end_state": ENDS})


def _map(plan: Map, found: Round) -> xr.Dataset:
    dimensions = ("start", plan.y.name, plan.x.name)
    variables = {name: _variable(name, dimensions, found.read(name).reshape(plan.shape)) for name in SHOWN}
    least, largest = variables["least_radius"][1], variables["largest_radius"][1]
    with np.errstate(invalid="ignore"):
        modulation = np.where(largest == 0.0, 0.0, (largest - least) / (largest + least))
    attributes = {"long_name": "(largest − least)/(largest + least) radius"}
    variables["modulation"] = (dimensions, modulation, attributes)
    variables["initial_state"] = (("start", "component"), np.array(plan.starts))
    return xr.Dataset(
        variables,
        coords=_coordinates(plan.system, (plan.y, plan.x)) | {"component": list(components(plan.system))},
    )


def _uncertainty(plan: Uncertainty, found: Round) -> xr.Dataset:
    """Return the independent draws, and the sensitivities that come from all trajectories."""
    from compare.sweep.compute.sensitivity import indices

    tables = {name: found.read(name).reshape(plan.samples, plan.row) for name in SHOWN}
    draws = np.arange(plan.samples * plan.row).reshape(plan.samples, plan.row)[:, :BASES].ravel()
    variables: Variables = {
        name: _input(plan.system, name, values) for name, values in plan.values(draws).items()
    }
    for name, table in tables.items():
        variables[name] = _variable(name, ("sample",), table[:, :BASES].ravel())
    variables |= _shares(shares.of_sample(variables["end"][1]), shares.SAMPLE)
    last_radius = np.hypot(*found.read("states")[:, :2].T).reshape(plan.samples, plan.row)
    radius = np.where(tables["end"] == EndState.UNDECIDED, last_radius, tables["largest_radius"])
    sensitive = np.stack((radius, tables["end"] == EndState.WHIRL))
    for name, values in indices(sensitive)._asdict().items():
        variables[f"sobol_{name}"] = (("quantity", "uncertain"), values)
    names = [uncertain.name for uncertain in plan.varied]
    return xr.Dataset(variables, coords={"end_state": ENDS, "quantity": list(SENSITIVE), "uncertain": names})


def curves_of(plan: Map) -> xr.Dataset:
    """Return the curves that formulas draw in the plane of a map, point by point."""
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


def _variable(name: str, dimensions: tuple[str, ...], values: NDArray[Any]) -> tuple[Any, ...]:
    attributes = {"long_name": RESULTS[name].meaning, "units": RESULTS[name].unit}
    return dimensions, values, attributes | flags(name)


def _input(system: System, name: str, values: NDArray[Any]) -> tuple[Any, ...]:
    return ("sample",), values, {"units": units(system)[name]}


def _coordinates(system: System, axes: Sequence[Axis]) -> dict[str, Any]:
    return {axis.name: (axis.name, axis.values, {"units": units(system)[axis.name]}) for axis in axes}


def _shares(found: Mapping[EndState, Share], meaning: str) -> Variables:
    values = np.array([found[end] for end in EndState])
    names = ("share", "share_low", "share_high")
    result: Variables = {name: (("end_state",), column) for name, column in zip(names, values.T, strict=True)}
    for name in names[1:]:
        result[name] += ({"long_name": meaning},)
    return result
