"""Results of a sweep as text."""

from collections.abc import Iterator

import numpy as np
import xarray as xr

from compare.sweep.compute.run import CHECK, RESULT
from compare.sweep.figures import MOST_DRAWS, in_words, shares_of
from compare.sweep.plan import Continuation, Uncertainty
from compare.sweep.quantities import units
from compare.sweep.store import SweepStore
from reference_model.ensemble import EndState
from reference_model.systems import COLUMNS

QUANTILES = (0.05, 0.5, 0.95)


def summary(store: SweepStore) -> Iterator[str]:
    """Yield the lines of the results of a finished sweep."""
    result, check = store.finished(RESULT), store.finished(CHECK)
    total = result["end"].size
    if "simulated" in result:
        yield f"{np.count_nonzero(result['simulated'].values)} of {total} starts simulated"
    else:
        yield f"{total} {'draws' if isinstance(store.plan, Uncertainty) else 'trajectories'}"
    percent: list[float] = []
    for end, words, percent in shares_of(result):
        shown = (
            "{:8.4f} %, between {:.4f} and {:.4f} %".format(*percent)
            if percent
            else result["count"].values[end]
        )
        yield f"  {words:14} {shown}"
    if percent:
        yield f"  bounds: {result['share_low'].attrs['long_name']}"
    if isinstance(store.plan, Uncertainty):
        yield from _uncertainty(result)
    if isinstance(store.plan, Continuation):
        yield from _continuation(store.plan, result)
    yield _checked(store, check)


def same_ends(store: SweepStore) -> bool:
    """Return whether the plain reference confirms all ends of the random sample."""
    return not np.any(_differing(store.finished(CHECK)))


def undecided(store: SweepStore) -> float:
    """Return the share of undecided trajectories."""
    count = store.finished(RESULT)["count"].values
    return float(count[EndState.UNDECIDED] / np.sum(count))


def _uncertainty(result: xr.Dataset) -> Iterator[str]:
    radii = result["largest_radius"][:MOST_DRAWS].values
    radii = radii[np.isfinite(radii)]
    if radii.size:
        values = ", ".join(
            f"{100.0 * part:g} %: {value:.4g} m"
            for part, value in zip(QUANTILES, np.quantile(radii, QUANTILES), strict=True)
        )
        which = "draws" if result.sizes["sample"] <= MOST_DRAWS else f"first {MOST_DRAWS} draws"
        yield f"quantiles of the largest radius of the {which}: {values}"
    for quantity in result["quantity"].values:
        words = "largest radius" if quantity == "largest_radius" else "whirl (yes or no)"
        for name in result["uncertain"].values:
            at = {"quantity": quantity, "uncertain": name}
            first, total, first_error, total_error = (
                float(result[f"sobol_{which}"].sel(at))
                for which in ("first", "total", "first_error", "total_error")
            )
            if np.isfinite(first):
                yield (
                    f"  sensitivity of {words} to {name}: first-order index {first:.3f} ± {first_error:.3f}, "
                    f"total index {total:.3f} ± {total_error:.3f}"
                )
            else:
                yield f"  sensitivity of {words} to {name}: none, because it does not vary"


def _continuation(plan: Continuation, result: xr.Dataset) -> Iterator[str]:
    name, unit = plan.x.name, units(plan.system)[plan.x.name]
    for j, end in enumerate(result["motion_end"].values):
        share, largest = (result[f"motion_{which}"].values[j] for which in ("share", "largest"))
        first, last = np.flatnonzero(np.isfinite(share))[[0, -1]]
        low, high = plan.x.values[[first, last]]
        yield (
            f"  {in_words(end):14} {name} from {low:.4g} to {high:.4g} {unit}: "
            f"largest radius {largest[first]:.4g} to {largest[last]:.4g} m, "
            f"share {100.0 * share[first]:.2f} to {100.0 * share[last]:.2f} %"
        )


def _checked(store: SweepStore, check: xr.Dataset) -> str:
    velocities = COLUMNS[type(store.plan.system)].index(("vx", "m/s"))
    difference = check["difference"].values
    place = np.hypot(difference[:, 0], difference[:, 1])
    speed = np.hypot(difference[:, velocities], difference[:, velocities + 1])
    undecided = int(np.count_nonzero(check["plain_end"].values == EndState.UNDECIDED))
    return (
        f"check of {len(place)} trajectories by the plain reference: "
        f"{np.count_nonzero(_differing(check))} end differently, {undecided} undecided; "
        f"states differ by up to {np.nanmax(place):.1e} m and {np.nanmax(speed):.1e} m/s"
    )


def _differing(check: xr.Dataset) -> np.ndarray:
    found, plain = check["end"].values, check["plain_end"].values
    differing: np.ndarray = (found != plain) & (found != EndState.UNDECIDED) & (plain != EndState.UNDECIDED)
    return differing
