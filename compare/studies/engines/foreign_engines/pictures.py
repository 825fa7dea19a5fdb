"""Figures of the study of foreign engines."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from compare.claims.study import ByEngine, Data, Figures
from compare.output.figures import BLACK, GREY, PURPLE, SKY, engine_style, new_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

COLOURS = {
    "MuJoCo": PURPLE,
    "Bullet": GREY,
    "Drake": SKY,
    "DART": BLACK,
    "Chipmunk": "#8c564b",
    "Box2D": "#b5a400",
    "Rapier": "#c2185b",
    "Jolt": "#5e35b1",
}

MARKERS = "os^Dv"
"""Of an engine's settings; our force, the last one of each, has a dotted line and a cross."""


def draw(data: ByEngine) -> Figures:
    """Draw error over time for the pin, sliding and sticking, and for the disc."""
    if "theory" not in data:
        return {}
    ladders = data["theory"]
    pin, (slides, sticks) = new_figure(ncols=2, width=9.6, height=6.2)
    _draw(slides, ladders, "slip", "it slides")
    _draw(sticks, ladders, "stick-slip", "it sticks nine times")
    disc, (panel,) = new_figure(width=9.6, height=6.2)
    _draw(panel, ladders, "disc", "six points")
    for figure, first in ((pin, slides), (disc, panel)):
        _legend(figure, first)
    return {"foreign-engines-pin": pin, "foreign-engines-disc": disc}


def _legend(figure: Figure, panel: Axes) -> None:
    """Put a legend below all panels, with engines one after the other in as many columns as the longest allows."""
    from matplotlib.lines import Line2D

    engines: dict[str, list[Any]] = {}
    for line in panel.get_lines():
        engine, _, setting = str(line.get_label()).partition(", ")
        engines.setdefault(engine if setting else "", []).append(line)
    rows = max(map(len, engines.values()))
    columns: list[list[Any]] = [[]]
    for settings in engines.values():
        if len(columns[-1]) + len(settings) > rows:
            columns.append([])
        columns[-1] += settings
    nothing = Line2D([], [], linestyle="none", label=" ")
    lines = [line for column in columns for line in column + [nothing] * (rows - len(column))]
    figure.legend(
        handles=lines, loc="outside lower center", ncols=len(columns), fontsize=9.0, columnspacing=1.2
    )


def _draw(panel: Axes, ladders: Data, case: str, title: str) -> None:
    for name, look in _looks([key.removesuffix(f": {case}") for key in ladders if key.endswith(f": {case}")]):
        seconds, errors = ladders[f"{name}: {case}"].T
        panel.loglog(seconds, errors, label=name, **look)
    panel.set(xlabel="time of one core in s", ylabel="largest error in m", title=title)


def _looks(names: list[str]) -> list[tuple[str, dict[str, Any]]]:
    """Return each name with its look: a colour for an engine, a marker for a setting, our own engines broad."""
    looks: list[tuple[str, dict[str, Any]]] = []
    settings: dict[str, int] = {}
    for name in names:
        engine, _, setting = name.partition(", ")
        if not setting:
            style = engine_style(name)
            look: dict[str, Any] = {
                "color": style.colour,
                "marker": style.marker,
                "linewidth": 2.4,
                "zorder": 4.0,
            }
        elif setting == "our force":
            look = {
                "color": COLOURS[engine],
                "marker": "x",
                "linestyle": ":",
                "linewidth": 1.2,
                "zorder": 3.0,
            }
        else:
            marker = MARKERS[settings.setdefault(engine, 0)]
            settings[engine] += 1
            look = {"color": COLOURS[engine], "marker": marker, "linewidth": 1.0, "markerfacecolor": "none"}
        looks.append((name, {"markersize": 4.5} | look))
    return looks
