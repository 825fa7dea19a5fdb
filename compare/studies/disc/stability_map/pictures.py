"""Figures."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np

from compare.claims import ByEngine, Data, Figures
from compare.claims.parameters import FIG11
from compare.output.figures import (
    BLACK,
    GREEN,
    GREY,
    PURPLE,
    SKY,
    Axes,
    Figure,
    axis,
    beside,
    engine_style,
    engines_in,
    new_figure,
    points,
)
from compare.studies.disc.stability_map.theory import ENDS
from compare.studies.toolkit.fig11 import PLANES
from reference_model.systems import FloatArray

ENDS_AS = dict(zip((f"ends as {end}" for end in ENDS), ("P", "o", "D", "s"), strict=True))
SIDES = {"small deviations from the whirl grow": "^", "small deviations from the whirl decay": "v"}
SHRINKING = "v"

COLOURS = {"ring": GREEN, "(23)": PURPLE}
DASHES: dict[str, Any] = {"ring": "-", "(23)": (0.0, (5.0, 2.0))}
NAMES = {"ring": "ring", "(23)": "eq. (23)"}
SHADE = "#d3ece4"

K = FIG11.natural_frequency


class Region(NamedTuple):
    """Name of a region and its position; ``at`` is the tip of an arrow from names outside the region."""

    across: float
    up: float
    words: str
    at: tuple[float, float] | None = None


class Panel(NamedTuple):
    """Labels, ranges and regions of a plane.

    ``outward`` is the sign of the change of the second coordinate from the onset to the large whirls.
    """

    labels: tuple[str, str]
    x: tuple[float, float]
    y: tuple[float, float]
    outward: float
    regions: tuple[Region, ...]


PANELS = {
    "load": Panel(
        (axis(r"\omega", "rad/s"), axis(r"\mu N", "N")),
        (0.95, 1.95),
        (0.0, 0.06),
        1.0,
        (
            Region(1.68, 0.012, "rotation about the axis"),
            Region(1.79, 0.024, "modulated cycle", (1.66, 0.0335)),
            Region(1.76, 0.046, "whirl"),
            Region(1.25, 0.05, "whirl or sticking"),
        ),
    ),
    "dampers": Panel(
        (axis(r"\beta", "N s/m"), axis("b", "N m s/rad")),
        (0.2, 2.0),
        (0.004, 0.026),
        -1.0,
        (
            Region(1.2, 0.02, "rotation about the axis"),
            Region(1.4, 0.0089, "modulated cycle"),
            Region(0.36, 0.0122, "whirl"),
            Region(1.2, 0.0055, "whirl or sticking"),
        ),
    ),
    "speeds": Panel(
        (axis(r"\omega", "rad/s"), axis(r"\omega - \Omega", "rad/s")),
        (0.95, 1.95),
        (0.0, 0.5),
        -1.0,
        (
            Region(1.25, 0.39, "rotation about the axis"),
            Region(1.7, 0.21, "modulated cycle", (1.62, 0.278)),
            Region(1.8, 0.255, "whirl"),
            Region(1.55, 0.08, "whirl or sticking"),
        ),
    ),
    "inertia": Panel(
        (axis("J", "kg m²"), axis("b", "N m s/rad")),
        (0.0, 4.0),
        (0.0085, 0.0215),
        -1.0,
        (
            Region(2.5, 0.0202, "rotation about the axis"),
            Region(2.5, 0.0142, "modulated cycle"),
            Region(0.35, 0.0166, "whirl"),
            Region(2.0, 0.0096, "whirl or sticking"),
        ),
    ),
}


def draw(data: ByEngine) -> Figures:
    figures = {}
    if "theory" in data:
        figures["stability-map"] = draw_map(data)
    if data:
        figures["stability-map-load"] = draw_section(data)
    return figures


def draw_map(data: ByEngine) -> Figure:
    from matplotlib.lines import Line2D

    figure, axes = new_figure(ncols=2, nrows=2, width=10.6, height=8.8)
    for (name, panel), panel_axes in zip(PANELS.items(), axes, strict=True):
        draw_plane(panel_axes, name, panel, data)
    handles, _ = axes[0].get_legend_handles_labels()
    marks: dict[str, Any] = {"color": GREY, "linestyle": "none", "markerfacecolor": "none"}
    if engines_in(data):
        handles += [
            Line2D([], [], marker=mark, label=words, **marks) for words, mark in (SIDES | ENDS_AS).items()
        ]
    handles += [
        Line2D([], [], color=engine_style(engine).colour, linewidth=4.0, label=f"simulated: {engine}")
        for engine in engines_in(data)
    ]
    figure.legend(handles=handles, loc="outside lower center", ncols=3, fontsize=9.5)
    return figure


def draw_plane(axes: Axes, name: str, panel: Panel, data: ByEngine) -> None:
    theory = data["theory"]
    x = np.linspace(*panel.x, 800)
    small, large = (hopf_curve(theory, name, x, side) for side in (1.0, -1.0))
    axes.fill_between(
        x, small, large, where=panel.outward * (large - small) > 0.0, color=SHADE, linewidth=0.0
    )
    for law, colour in COLOURS.items():
        for kind, width, dashes, words in (
            ("Hopf", 2.0, DASHES[law], "whirl loses its stability (Hopf)"),
            ("fold", 1.3, ":", "two whirls meet (fold)"),
        ):
            found = [shown(name, curve) for curve in curves(theory, name, law, kind)]
            for i, (first, second) in enumerate(found):
                label = f"{NAMES[law]}: {words}" if i == 0 else None
                axes.plot(
                    first, second, color=colour, linestyle=dashes, linewidth=width, zorder=3.0, label=label
                )
    for i, curve in enumerate(curves(theory, name, "ring", "onset")):
        label = "both: rotation loses its stability (onset)" if i == 0 else None
        axes.plot(*shown(name, curve), color=BLACK, linewidth=1.1, zorder=2.5, label=label)
    axes.plot(
        *sticking(name, x),
        color=GREY,
        linestyle="-.",
        linewidth=1.2,
        label="largest shaft moment at which the disc sticks",
    )
    if PLANES[name].names[0] == "disc_speed":
        axes.axvline(K, color=SKY, linewidth=1.4)
        axes.annotate(
            r"$\omega = k$", (K, 0.97), (5, 0), xycoords=("data", "axes fraction"), textcoords="offset points"
        )
    here = np.array([[getattr(FIG11, parameter) for parameter in PLANES[name].names]])
    axes.plot(
        *shown(name, here), "*", color=BLACK, markersize=8.0, linestyle="none", zorder=4.0, label="Fig. 11"
    )
    for rank, engine in enumerate(engines_in(data)):
        draw_dots(axes, name, engine, data[engine], rank)
    box = {"boxstyle": "round", "facecolor": "white", "edgecolor": "none", "alpha": 0.7, "pad": 0.15}
    for region in panel.regions:
        axes.annotate(
            region.words,
            region.at or (region.across, region.up),
            (region.across, region.up),
            ha="center",
            va="center",
            style="italic",
            bbox=box if region.at else None,
            arrowprops={"arrowstyle": "-", "linewidth": 0.7} if region.at else None,
            zorder=6.0,
        )
    axes.set(xlabel=panel.labels[0], ylabel=panel.labels[1], xlim=panel.x, ylim=panel.y)


def draw_dots(axes: Axes, name: str, engine: str, found: Data, rank: int) -> None:
    """Draw growth of deviations on the left of their points and ends on the right, after ``rank`` other engines."""
    none = np.empty((0, 3))
    sides, ends = found.get(f"sides/{name}", none), found.get(f"ends/{name}", none)
    groups = [
        *zip((sides[sides[:, 2] > 0.0], sides[sides[:, 2] <= 0.0]), SIDES.values(), strict=True),
        *((ends[ends[:, 2] == code], mark) for code, mark in enumerate(ENDS_AS.values())),
    ]
    style: dict[str, Any] = {"linestyle": "none", "markerfacecolor": "none", "zorder": 5.0}
    style |= {"color": engine_style(engine).colour, "markersize": 5.0}
    for chosen, mark in groups:
        place = 1.0 + rank if mark in ENDS_AS.values() else -1.0 - 2.0 * rank - (mark == SHRINKING)
        axes.plot(*shown(name, chosen), marker=mark, transform=beside(axes, place), **style)


def curves(theory: Data, plane: str, law: str, kind: str) -> Iterator[FloatArray]:
    """Yield the points and α of the curves of one kind, shape (n, 3) each."""
    for name, found in theory.items():
        if name.startswith(f"{plane}/{law}/{kind}/"):
            yield found


def shown(plane: str, points: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the coordinates of ``points``, shape (n, 2 or more), in the figure, which shows ω − Ω instead of Ω."""
    first, second = points[:, 0], points[:, 1]
    return (first, first - second) if plane == "speeds" else (first, second)


def hopf_curve(theory: Data, plane: str, x: FloatArray, side: float) -> FloatArray:
    """Return the second coordinate over ``x`` of the ring's Hopf curve, NaN outside its range.

    ``side`` is +1 for small whirls, whose rim slips faster than the centre, and -1 for large ones.
    """
    result = np.full_like(x, np.nan)
    for curve in curves(theory, plane, "ring", "Hopf"):
        first, second = shown(plane, curve)
        if np.mean(second) > 0.0 and np.all(side * (curve[:, 2] - np.pi / 4.0) > 0.0):
            order = np.argsort(first)
            inside = (x >= np.min(first)) & (x <= np.max(first))
            result[inside] = np.interp(x[inside], first[order], second[order])
    return result


def sticking(plane: str, x: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the line b|ω − Ω| = μN·R."""
    torque = FIG11.friction_force * FIG11.contact_radius
    if plane == "load":
        return x, FIG11.shaft_damping * np.abs(x - FIG11.shaft_speed) / FIG11.contact_radius
    if plane == "speeds":
        return x, np.full_like(x, torque / FIG11.shaft_damping)
    return x, np.full_like(x, torque / (FIG11.disc_speed - FIG11.shaft_speed))


def draw_section(data: ByEngine) -> Figure:
    figure, (axes,) = new_figure(width=8.4, height=4.6)
    if "theory" in data:
        for law, colour in COLOURS.items():
            load, radius, growth = data["theory"][f"section/{law}"].T
            for stable, dashes, words in ((True, "-", "stable"), (False, ":", "unstable")):
                axes.plot(
                    load,
                    np.where((growth < 0.0) == stable, radius, np.nan),
                    color=colour,
                    linestyle=dashes,
                    linewidth=2.2,
                    label=f"whirl, {NAMES[law]}: {words}",
                )
    for engine in engines_in(data):
        load, low, high = data[engine]["section"].T
        label = f"{engine}: smallest and largest"
        axes.plot(np.repeat(load, 2), np.column_stack((low, high)).ravel(), **points(engine, label))
    axes.axvline(FIG11.friction_force, color=GREY, linewidth=1.0, linestyle="--", label="Fig. 11")
    axes.set(
        xlabel=axis(r"\mu N", "N"), ylabel=axis(r"\rho", "m"), xlim=(0.0192, 0.0285), ylim=(-0.001, 0.05)
    )
    axes.legend(loc="lower right")
    return figure
