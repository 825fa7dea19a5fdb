"""Figure of the gear change: speeds at the clutch, and heat."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from compare.claims.study import ByEngine, Figures
from compare.output.figures import BLUE, GREEN, GREY, ORANGE, axis, engines_in, new_figure
from compare.studies.drivetrain.dual_clutch.parameters import HAND_OVER, TIMES

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def draw(data: ByEngine) -> Figures:
    """Draw what is there."""
    return {"dual-clutch": _draw(data)} if any("found" in found for found in data.values()) else {}


def _draw(data: ByEngine) -> Figure:
    figure, (speeds, heats) = new_figure(ncols=2, width=10.0, height=3.8)
    for panel in (speeds, heats):
        panel.axvspan(*HAND_OVER, color=GREY, alpha=0.2, linewidth=0.0)
        panel.set(xlabel=axis("t", "s"), xlim=(0.0, TIMES[-1]))
    looks: list[tuple[str, str, dict[str, Any]]]
    looks = [("theory", "SciPy", {"linewidth": 1.4})] if "found" in data.get("theory", {}) else []
    marks: dict[str, Any] = {"linestyle": "none", "marker": "x", "markersize": 5.0}
    looks += [(engine, engine, marks) for engine in engines_in(data) if "found" in data[engine]]
    for source, title, look in looks:
        t, found = (np.asarray(data[source][name]) for name in ("t", "found"))
        for column, name, colour in (
            (0, "engine", BLUE),
            (1, "first shaft", ORANGE),
            (2, "second shaft", GREEN),
        ):
            speeds.plot(t, found[:, column], color=colour, label=f"{name}, {title}", **look)
        for column, name, colour in ((4, "first clutch", ORANGE), (5, "second clutch", GREEN)):
            heats.plot(t, found[:, column] / 1e3, color=colour, label=f"{name}, {title}", **look)
    speeds.set(ylabel="speed in rad/s", ylim=(110.0, 310.0))
    heats.set(ylabel="heat in kJ")
    for panel in (speeds, heats):
        panel.legend(fontsize=8.0, loc="center right")
    return figure
