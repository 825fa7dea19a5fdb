"""The branches of Fig. 6."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from scipy.interpolate import PchipInterpolator

from compare.claims.study import ByEngine, Data, Figures
from compare.output.figures import GREEN, GREY, ORANGE, axis, curve, engines_in, new_figure, points
from compare.studies.pin.fig06.study import WHIRL_LOADS

if TYPE_CHECKING:
    from matplotlib.axes import Axes


def draw(data: ByEngine) -> Figures:
    """Draw the branches over the friction force, and those near the limit (5) enlarged."""
    figure, (whole, near) = new_figure(ncols=2, width=10.0, height=4.2)
    for panel in (whole, near):
        if "theory" in data:
            _draw_theory(panel, data["theory"])
        for engine in engines_in(data):
            found = data[engine]
            panel.plot(found["equilibrium loads"], found["equilibrium radius"], **points(engine))
            panel.plot(found["whirl loads"], found["whirl extents"], **points(engine, ""))
            if "cycle load" in found:
                panel.plot(np.full(2, found["cycle load"]), found["cycle extent"], **points(engine, ""))
        panel.set(xlabel=axis(r"\mu N", "N"))
    whole.set(ylabel=axis(r"\rho", "m"), xlim=(0.0, WHIRL_LOADS[-1]), ylim=(0.0, None))
    near.set(xlim=(0.07, 0.115), ylim=(0.0, 0.4))
    handles, labels = whole.get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=4)
    return {"fig06-branches": figure}


def _draw_theory(panel: Axes, found: Data) -> None:
    panel.plot(
        found["equilibrium load"], found["equilibrium radius"], **curve("theory", "equilibrium, eq. (3)")
    )
    panel.fill_between(
        found["sticking load"],
        found["sticking radius"],
        color=GREY,
        alpha=0.4,
        linewidth=0.0,
        label="sticks, (9)",
    )
    # A smooth curve through the orbits. In a fold a multiplier passes 1, so they are stable where the load falls
    # from the outermost whirl on, unstable where it rises.
    number = np.arange(len(found["branch load"]))
    fine = np.linspace(0.0, number[-1], 20 * number[-1] + 1)
    load = PchipInterpolator(number, found["branch load"])(fine)
    extent = PchipInterpolator(number, found["branch extent"])(fine)
    stable = np.gradient(load) < 0.0
    sticks = found["branch sticks"][np.rint(fine).astype(int)] > 0.5
    kinds = (
        ("whirl, stable", stable & ~sticks, GREEN, "-"),
        ("unstable", ~stable, GREY, (0.0, (3.0, 1.5))),
        ("stick–slip cycle, stable", stable & sticks, ORANGE, "-"),
    )
    for label, mask, colour, dashes in kinds:
        shown = np.where(mask[:, np.newaxis], extent, np.nan)
        panel.plot(load, shown[:, 0], color=colour, linestyle=dashes, linewidth=1.6, label=label)
        panel.plot(load, shown[:, 1], color=colour, linestyle=dashes, linewidth=1.6)
