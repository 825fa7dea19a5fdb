"""Figures."""

from collections.abc import Iterator, Sequence
from typing import Any, NamedTuple

import numpy as np

import compare.output.figures as plots
from compare.claims import ByEngine, Data, Figures
from compare.claims.parameters import FIG11
from compare.output.figures import Axes, Figure, axis, engine_style, engines_in, new_figure, points
from compare.studies.disc.stability_map.theory import ENDS
from compare.studies.toolkit.fig11 import PLANES
from reference_model.systems import FloatArray

LETTERS = {"rotation": "R", "whirl": "W", "modulated cycle": "M", "sticking": "S"}
"""Letter of each final motion, the first of its region's name."""

COLOURS = {"ring": plots.GREEN, "(23)": plots.PURPLE}
DASHES: dict[str, Any] = {"ring": "-", "(23)": (0.0, (5.0, 2.0))}
NAMES = {"ring": "ring", "(23)": "eq. (23)"}
SHADE = "#d3ece4"

LABELS = (
    ("inertia", "whirl unstable (ring)", (2.1, 0.0163), plots.GREEN),
    ("inertia", "by (23)", (3.3, 0.0181), plots.PURPLE),
    ("inertia", "rotation unstable below", (2.3, 0.01755), plots.BLACK),
    ("inertia", "sticking possible below", (1.9, 0.0104), plots.GREY),
)
"""Names of the curves in one plane: its name, the words, their position and colour."""

K = FIG11.natural_frequency


class Panel(NamedTuple):
    """Labels and ranges of a plane, and the ``places`` of the names ``REGIONS``.

    ``outward`` is the sign of the change of the second coordinate from the onset to the large whirls. An arrow with
    this ``tip`` leads to a modulated cycle that is too small for its name.
    """

    labels: tuple[str, str]
    x: tuple[float, float]
    y: tuple[float, float]
    outward: float
    places: Sequence[tuple[float, float]]
    tip: tuple[float, float] | None = None


REGIONS = ("rotation about the axis", "modulated cycle", "whirl", "whirl or sticking")

PANELS = {
    "load": Panel(
        (axis(r"\omega", "rad/s"), axis(r"\mu N", "N")),
        (0.95, 1.95),
        (0.0, 0.06),
        1.0,
        ((1.68, 0.012), (1.79, 0.024), (1.76, 0.046), (1.25, 0.05)),
        tip=(1.66, 0.0335),
    ),
    "dampers": Panel(
        (axis(r"\beta", "N s/m"), axis("b", "N m s/rad")),
        (0.2, 2.0),
        (0.004, 0.026),
        -1.0,
        ((1.2, 0.02), (1.4, 0.0089), (0.36, 0.0122), (1.2, 0.0055)),
    ),
    "speeds": Panel(
        (axis(r"\omega", "rad/s"), axis(r"\omega - \Omega", "rad/s")),
        (0.95, 1.95),
        (0.0, 0.5),
        -1.0,
        ((1.25, 0.39), (1.7, 0.21), (1.8, 0.255), (1.55, 0.08)),
        tip=(1.62, 0.278),
    ),
    "inertia": Panel(
        (axis("J", "kg m²"), axis("b", "N m s/rad")),
        (0.0, 4.0),
        (0.0085, 0.0215),
        -1.0,
        ((2.5, 0.0202), (2.5, 0.0142), (0.35, 0.0166), (2.0, 0.0096)),
    ),
}


def draw(data: ByEngine) -> Figures:
    plane = {"stability-map": draw_map(data)} if "theory" in data else {}
    return plane | {"stability-map-load": draw_section(data)} if data else {}


def draw_map(data: ByEngine) -> Figure:
    figure, axes = new_figure(ncols=2, nrows=2, width=10.6, height=8.4)
    for (name, panel), panel_axes in zip(PANELS.items(), axes, strict=True):
        draw_plane(panel_axes, name, panel, data)
    for name, words, place, colour in LABELS:
        axes[list(PANELS).index(name)].text(*place, words, color=colour, fontsize=9.5, va="center")
    return figure


def draw_plane(axes: Axes, name: str, panel: Panel, data: ByEngine) -> None:
    theory = data["theory"]
    x = np.linspace(*panel.x, 800)
    small, large = (hopf_curve(theory, name, x, side) for side in (1.0, -1.0))
    axes.fill_between(
        x, small, large, where=panel.outward * (large - small) > 0.0, color=SHADE, linewidth=0.0
    )
    for law, colour in COLOURS.items():
        hopf: Any = {"color": colour, "linestyle": DASHES[law], "linewidth": 2.0, "zorder": 3.0}
        draw_curves(axes, name, law, "Hopf", data, **hopf)
        draw_curves(axes, name, law, "fold", data, **hopf | {"linestyle": ":", "linewidth": 1.3})
    onset: Any = {"color": plots.BLACK, "linewidth": 1.1, "zorder": 2.5}
    draw_curves(axes, name, "ring", "onset", data, **onset)
    style: dict[str, Any] = {"color": plots.GREY, "linestyle": "-.", "linewidth": 1.2}
    axes.plot(*sticking(name, x), **style)
    if PLANES[name].names[0] == "disc_speed":
        axes.axvline(K, color=plots.SKY, linewidth=1.4)
        style = {"xycoords": ("data", "axes fraction"), "textcoords": "offset points"}
        axes.annotate(r"$\omega = k$", (K, 0.97), (5, 0), **style)
    here = np.array([[getattr(FIG11, parameter) for parameter in PLANES[name].names]])
    place: Any = {"color": plots.BLACK, "markersize": 19.0, "markerfacecolor": "none", "zorder": 4.0}
    axes.plot(*shown(name, here), "o", **place)
    (x_here,), (y_here,) = shown(name, here)
    axes.annotate("Fig. 11", (x_here, y_here), (8, -11), textcoords="offset points", va="center")
    for rank, engine in enumerate(engines_in(data)):
        draw_dots(axes, name, engine, data[engine], rank)
    box = {"boxstyle": "round", "facecolor": "white", "edgecolor": "none", "alpha": 0.7, "pad": 0.15}
    for words, place in zip(REGIONS, panel.places, strict=True):
        style = {"ha": "center", "va": "center", "style": "italic", "zorder": 6.0}
        tip = panel.tip if words == "modulated cycle" else None
        if tip is not None:
            style |= {"bbox": box, "arrowprops": {"arrowstyle": "-", "linewidth": 0.7}}
        axes.annotate(words, tip or place, place, **style)
    axes.set(xlabel=panel.labels[0], ylabel=panel.labels[1], xlim=panel.x, ylim=panel.y)


def draw_curves(axes: Axes, name: str, law: str, kind: str, data: ByEngine, **style: Any) -> None:
    for curve in curves(data["theory"], name, law, kind):
        axes.plot(*shown(name, curve), **style)


def draw_dots(axes: Axes, name: str, engine: str, found: Data, rank: int) -> None:
    """Draw the growth (+) or decay (−) of deviations, and the letters of ends; later engines are larger."""
    none = np.empty((0, 3))
    sides, ends = found.get(f"sides/{name}", none), found.get(f"ends/{name}", none)
    groups = [(sides[sides[:, 2] > 0.0], "$+$"), (sides[sides[:, 2] <= 0.0], "$-$")]
    groups += [(ends[ends[:, 2] == code], f"${LETTERS[end]}$") for code, end in enumerate(ENDS)]
    style: dict[str, Any] = {"linestyle": "none", "zorder": 5.0 - rank, "markeredgewidth": 0.6}
    style |= {"color": engine_style(engine).colour, "markersize": 7.0 + 5.0 * rank}
    for chosen, mark in groups:
        axes.plot(*shown(name, chosen), marker=mark, **style)


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
    """Return the second coordinate of the ring's Hopf curve at ``x``, NaN outside its range.

    ``side`` is +1 for small whirls, whose rim slips faster than the centre, and -1 for large whirls.
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
            for words, dashes, shown in (("stable", "-", growth < 0.0), ("unstable", ":", ~(growth < 0.0))):
                label, part = f"whirl, {NAMES[law]}: {words}", np.where(shown, radius, np.nan)
                axes.plot(load, part, color=colour, linestyle=dashes, linewidth=2.2, label=label)
    for engine in engines_in(data):
        load, low, high = data[engine]["section"].T
        label = f"{engine}: smallest and largest"
        axes.plot(np.repeat(load, 2), np.column_stack((low, high)).ravel(), **points(engine, label))
    axes.axvline(FIG11.friction_force, color=plots.GREY, linewidth=1.0, linestyle="--", label="Fig. 11")
    axes.set(xlabel=axis(r"\mu N", "N"), xlim=(0.0192, 0.0285))
    axes.set(ylabel=axis(r"\rho", "m"), ylim=(-0.001, 0.05))
    axes.legend(loc="lower right")
    return figure
