"""The way to rest at both scales."""

from __future__ import annotations

import numpy as np

from compare.claims.parameters import FIG5
from compare.claims.study import ByEngine, Figures
from compare.output.figures import BLACK, PURPLE, axis, engines_in, new_figure, points
from compare.studies.engines.clutch_scale.study import CLUTCH, SAMPLES, UNTIL


def draw(data: ByEngine) -> Figures:
    """Draw the way to rest at both scales, and how far they are apart over time."""
    figure, (plane, history) = new_figure(ncols=2, width=11.0)
    exact = data.get("theory", {})
    micrometres = 1e6 * CLUTCH.length
    milliseconds = 1e3 * CLUTCH.time
    times = milliseconds * np.linspace(0.0, UNTIL, SAMPLES)
    if exact:
        x, y = micrometres * exact["path"].T
        plane.plot(x, y, color=BLACK, linewidth=0.8, label="Fig. 5, its lengths times 1e-3")
        plane.plot(
            *(micrometres * exact["rest"]), marker="*", markersize=12.0, color=PURPLE, label="rest by (3)"
        )
        for start, end in milliseconds * exact["sticks"].reshape(-1, 2):
            history.axvspan(start, end, color=PURPLE, alpha=0.15, linewidth=0.0)
    for engine in engines_in(data):
        found = data[engine]["states"]
        plane.plot(*(micrometres * found[::8, :2].T), **points(engine, markersize=3.0))
        if exact:
            apart = np.hypot(*(found - exact["states"])[:, :2].T) / FIG5.offset
            history.semilogy(times[1::4], np.maximum(apart[1::4], 1e-16), **points(engine, linestyle=":"))
    plane.set(xlabel=axis("x", "µm"), ylabel=axis("y", "µm"), aspect="equal")
    if plane.lines:
        plane.legend(loc="center left", bbox_to_anchor=(1.02, 0.5))
    history.set(xlabel=axis("t", "ms"), ylabel="distance from the line over X0")
    if history.lines:
        history.legend(loc="upper right")
    return {"clutch-scale": figure}
