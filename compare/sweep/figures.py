"""Figures of sweeps, drawn from their stores."""

from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
import xarray as xr

from compare.output.figures import (
    BLACK,
    BLUE,
    GREEN,
    GREY,
    ORANGE,
    PURPLE,
    SKY,
    Axes,
    Figure,
    axis,
    new_figure,
    paper_style,
    saved,
)
from compare.sweep.compute.run import RESULT, theory_of
from compare.sweep.files import Files
from compare.sweep.plan import Basin, Continuation, Map, Plan, RandomBasin, Uncertainty
from compare.sweep.quantities import symbol, units
from compare.sweep.store import SweepStore
from reference_model.ensemble import EndState

COLOURS = {
    EndState.UNDECIDED: "#ffffff",
    EndState.SELF_CENTRED: SKY,
    EndState.WHIRL: ORANGE,
    EndState.MODULATED: PURPLE,
    EndState.STUCK: GREY,
    EndState.STICK_SLIP: GREEN,
}

MOST_PIXELS = 2000
"""Largest number of pixels along each axis of an image; points beyond it are skipped."""

MOST_DOTS = 20_000

MOST_DRAWS = 1 << 20
"""Largest number of draws in the distribution of a radius."""

BINS = 60

ORDERS = {"first": "first-order index", "total": "total index"}

CURVE_DASHES: tuple[Any, ...] = ("-", "--", ":", "-.", (0.0, (6.0, 1.5, 1.0, 1.5)))


def write_figures(store: SweepStore, folder: Files) -> tuple[str, ...]:
    """Draw the results of a finished sweep into ``folder`` as SVG and PNG; return their paths.

    Raises ``ValueError`` if the sweep is not finished.
    """
    result, contents = store.finished(RESULT), {}
    with paper_style():
        drawn = figures(store.plan, result, next(map(store.get, theory_of(store.plan)), None))
    for name, figure in drawn.items():
        for suffix, content in zip((".svg", ".png"), saved(figure), strict=True):
            contents[f"{name}{suffix}"] = content
    folder.write(contents)
    return tuple(folder.below(name) for name in contents)


def figures(plan: Plan, result: xr.Dataset, theory: xr.Dataset | None) -> dict[str, Figure]:
    """Return the figures of a sweep by name; ``theory`` contains results of formulas."""
    draw: dict[type[Plan], Callable[..., Figure]] = {
        Basin: basin,
        RandomBasin: random_basin,
        Map: parameter_map,
        Uncertainty: uncertainty,
        Continuation: continuation,
    }
    drawn = draw[type(plan)](plan, result, *([] if theory is None else [theory]))
    return {plan.kind.removeprefix("random "): drawn}


def basin(plan: Basin, result: xr.Dataset) -> Figure:
    """Draw the end of each start."""
    figure, (axes,) = new_figure(width=7.4, height=5.4)
    draw_ends(axes, plan, result["end"])
    label_plane(axes, plan)
    legend(figure, result)
    return figure


def draw_ends(axes: Axes, plan: Basin | Map, ends: Any) -> None:
    """Draw ends, shape (y, x), in the plane of ``plan``."""
    from matplotlib.colors import ListedColormap

    colours = ListedColormap([COLOURS[end] for end in EndState])
    _image(axes, plan, ends, cmap=colours, vmin=-0.5, vmax=len(EndState) - 0.5)


def label_plane(axes: Axes, plan: Basin | RandomBasin | Map) -> None:
    """Label the axes of a plane and set their limits."""
    labels = [axis(symbol(one.name), units(plan.system)[one.name]) for one in (plan.x, plan.y)]
    axes.set(
        xlabel=labels[0], ylabel=labels[1], xlim=(plan.x.low, plan.x.high), ylim=(plan.y.low, plan.y.high)
    )


def random_basin(plan: RandomBasin, result: xr.Dataset) -> Figure:
    """Draw a dot for each start in the colour of its end."""
    figure, (axes,) = new_figure(width=7.4, height=5.4)
    x, y, ends = (result[name][:MOST_DOTS].values for name in (plan.x.name, plan.y.name, "end"))
    for end in EndState:
        here = ends == end
        axes.plot(
            x[here], y[here], ".", color=COLOURS[end], markersize=2.0, markeredgewidth=0.0, rasterized=True
        )
    label_plane(axes, plan)
    legend(figure, result)
    return figure


def legend(figure: Figure, result: xr.Dataset) -> None:
    """Draw a legend of the ends that occur, with known shares."""
    from matplotlib.patches import Patch

    handles = []
    for end, label, percent in shares_of(result):
        if percent:
            label += ": {:.3g} % ({:.3g} to {:.3g})".format(*percent)
        handles.append(Patch(facecolor=COLOURS[end], edgecolor=BLACK, linewidth=0.5, label=label))
    figure.legend(handles=handles, loc="outside lower center", ncols=3, fontsize=9.0)


def shares_of(result: xr.Dataset) -> Iterator[tuple[EndState, str, list[float]]]:
    """Yield the ends that occur, in words, with share and bounds in %, if known."""
    names = ("share", "share_low", "share_high")
    there = "share" in result and result["share"].ndim == 1
    for end in EndState:
        if result["count"][end] > 0:
            yield end, in_words(end), [100.0 * float(result[name][end]) for name in names] if there else []


def in_words(end: int) -> str:
    """Return the name of an end state."""
    return EndState(end).name.lower().replace("_", " ")


def parameter_map(plan: Map, result: xr.Dataset, curves: xr.Dataset) -> Figure:
    """Draw ends, largest radius, modulation and slip power with the theory's curves."""
    figure, panels = new_figure(ncols=4, nrows=len(plan.starts), width=18.0, height=4.4 * len(plan.starts))
    shown = (
        ("largest_radius", "largest radius in m"),
        ("modulation", "(largest − least)/(largest + least) radius"),
        ("slip_power", "friction power in W"),
    )
    rows = np.array(panels, dtype=object).reshape(len(plan.starts), 4)
    for i, row in enumerate(rows):
        draw_ends(row[0], plan, result["end"][i])
        start = ", ".join(f"{value:g}" for value in plan.starts[i])
        row[0].set_title(f"end of the motion from ({start})", fontsize=10.0)
        for panel, (name, words) in zip(row[1:], shown, strict=True):
            image = _image(panel, plan, result[name][i], cmap="viridis")
            figure.colorbar(image, ax=panel)
            panel.set_title(words, fontsize=10.0)
        for panel in row:
            draw_curves(panel, plan, curves)
            label_plane(panel, plan)
    handles, _ = rows[0, 0].get_legend_handles_labels()
    legend(figure, result)
    if handles:
        figure.legend(handles=handles, loc="outside upper center", ncols=3, fontsize=9.0)
    return figure


def draw_curves(axes: Axes, plan: Map, curves: xr.Dataset) -> None:
    """Draw the theory's curves with dashes and white outlines."""
    from matplotlib.patheffects import withStroke

    meanings = [str(meaning) for meaning in curves["curve"].values]
    dashes = dict(zip(dict.fromkeys(meanings), CURVE_DASHES, strict=False))
    for i, meaning in enumerate(meanings):
        here = curves["of_curve"].values == i
        axes.plot(
            *(curves[one.name].values[here] for one in (plan.x, plan.y)),
            color=BLACK,
            linestyle=dashes[meaning],
            linewidth=1.4,
            label=meaning if meaning not in meanings[:i] else None,
            path_effects=[withStroke(linewidth=2.6, foreground="white")],
        )


def uncertainty(plan: Uncertainty, result: xr.Dataset) -> Figure:
    """Draw the distribution of the largest radius by end, and the sensitivities."""
    figure, (left, right) = new_figure(ncols=2, width=11.5, height=4.6)
    radii, ends = (result[name][:MOST_DRAWS].values for name in ("largest_radius", "end"))
    finite = np.isfinite(radii)
    there = [end for end in EndState if np.any(ends[finite] == end)]
    if there:
        left.hist(
            [radii[finite & (ends == end)] for end in there],
            bins=BINS,
            stacked=True,
            color=[COLOURS[end] for end in there],
            edgecolor=BLACK,
            linewidth=0.3,
        )
    which = "" if result.sizes["sample"] <= MOST_DRAWS else f" among the first {MOST_DRAWS}"
    left.set(xlabel="largest radius of the end state in m", ylabel=f"number of draws{which}")
    places = np.arange(len(plan.varied))
    bars = (
        ("first", "largest_radius", BLUE),
        ("total", "largest_radius", SKY),
        ("first", "whirl", ORANGE),
        ("total", "whirl", GREEN),
    )
    for i, (order, quantity, colour) in enumerate(bars):
        values = result[f"sobol_{order}"].sel(quantity=quantity).values
        errors = result[f"sobol_{order}_error"].sel(quantity=quantity).values
        words = "largest radius" if quantity == "largest_radius" else "whirl (yes or no)"
        right.bar(
            places + 0.2 * (i - 1.5),
            values,
            0.18,
            yerr=errors,
            color=colour,
            label=f"{words}, {ORDERS[order]}",
        )
    right.set_xticks(places, [f"${symbol(uncertain.name)}$" for uncertain in plan.varied])
    right.set(ylabel="Sobol index")
    right.legend(fontsize=8.5)
    legend(figure, result)
    return figure


def continuation(plan: Continuation, result: xr.Dataset, branches: xr.Dataset) -> Figure:
    """Draw the shares and radii of the motions, measured and predicted."""
    figure, (left, right) = new_figure(ncols=2, width=12.5, height=4.8)
    values = plan.x.values
    for j, end in enumerate(result["motion_end"].values):
        colour = COLOURS[EndState(end)] if end != EndState.UNDECIDED else BLACK
        share, low, high = (result[f"motion_share{which}"].values[j] for which in ("", "_low", "_high"))
        left.fill_between(values, low, high, color=colour, alpha=0.4, linewidth=0.0)
        left.plot(values, share, color=colour, marker=".")
        for which in ("least", "largest"):
            right.plot(values, result[f"motion_{which}"].values[j], ".", color=colour, markersize=7.0)
    for j, meaning in enumerate(branches["theory"].values):
        stable = branches["theory_stable"].values[j]
        for which in ("least", "largest"):
            radius = branches[f"theory_{which}"].values[j]
            for kind, dashes in ((1.0, "-"), (0.0, "--")):
                right.plot(
                    values,
                    np.where(stable == kind, radius, np.nan),
                    color=BLACK,
                    linestyle=dashes,
                    linewidth=1.0,
                )
        there = np.flatnonzero(np.isfinite(radius))
        right.annotate(
            str(meaning), (values[there[-1]], radius[there[-1]]), fontsize=8.5, ha="right", va="bottom"
        )
    name = axis(symbol(plan.x.name), units(plan.system)[plan.x.name])
    left.set(xlabel=name, ylabel="share of the starts", ylim=(0.0, 1.0))
    right.set(xlabel=name, ylabel="least and largest radius in m")
    legend(figure, result)
    return figure


def _image(axes: Axes, plan: Basin | Map, values: Any, **look: Any) -> Any:
    every = tuple(slice(None, None, -(-points // MOST_PIXELS)) for points in values.shape)
    x, y = plan.x.values[every[1]], plan.y.values[every[0]]
    half_x, half_y = 0.5 * (x[1] - x[0]), 0.5 * (y[1] - y[0])
    axes.grid(False)
    return axes.imshow(
        values[every].values,
        origin="lower",
        aspect="auto",
        interpolation="nearest",
        extent=(x[0] - half_x, x[-1] + half_x, y[0] - half_y, y[-1] + half_y),
        **look,
    )
