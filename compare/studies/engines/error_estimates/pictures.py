"""Estimates beside true errors, for each kind of motion."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from compare.claims.study import ByEngine, Figures
from compare.output.figures import BLACK, curve, engine_style, engines_in, new_figure, points
from compare.studies.engines.error_estimates.theory import LEAST_COVERAGE, MOST_OVER_ESTIMATE, PROBLEMS

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

SMALLEST, LARGEST = 0.3, 3e3
"""Ratios of estimate and true error that the figure shows; an arrow says that there are others beyond."""

COLUMNS = 3


def draw(data: ByEngine) -> Figures:
    """Draw estimates over true errors, and how far they lie above."""
    return {"error-estimates": _scatter(data), "error-estimates-spread": _spread(data)}


def _scatter(data: ByEngine) -> Figure:
    kinds = list(PROBLEMS)
    rows = -(-len(kinds) // COLUMNS)
    figure, panels = new_figure(ncols=COLUMNS, nrows=rows, width=10.0, height=2.9 * rows)
    for panel, kind in zip(panels, kinds, strict=False):
        panel.set_title(kind)
        seen = []
        for engine in engines_in(data):
            if f"{kind}: errors" in data[engine]:
                errors, estimates = (data[engine][f"{kind}: {what}"] for what in ("errors", "estimates"))
                right = errors > 0.0  # what is right to the last bit has no place here
                seen += [errors[right], estimates[right]]
                look = points(engine, markersize=3.0, markeredgewidth=0.6)
                panel.loglog(errors[right], estimates[right], **look)
        if seen:
            _draw_bounds(panel, np.concatenate(seen))
    for panel in panels[len(kinds) :]:
        panel.axis("off")
    figure.supxlabel("true error, over the largest number", fontsize=11.0)
    figure.supylabel("estimate, over the largest number", fontsize=11.0)
    panels[0].legend(loc="upper left", fontsize=9.0)
    return figure


def _draw_bounds(panel: Axes, seen: np.ndarray) -> None:
    ends = np.array([0.3 * np.min(seen), 3.0 * np.max(seen)])
    panel.plot(ends, ends, **curve("theory", "equal"))
    label = f"{MOST_OVER_ESTIMATE:g} times"
    panel.plot(ends, MOST_OVER_ESTIMATE * ends, **curve("theory", label, linestyle=":"))
    panel.set(xlim=ends, ylim=ends)


def _spread(data: ByEngine) -> Figure:
    figure, (panel,) = new_figure(width=7.0, height=4.4)
    names, kinds = engines_in(data), list(PROBLEMS)
    shares = (1.0 - LEAST_COVERAGE, 0.5, LEAST_COVERAGE)
    for i, engine in enumerate(names):
        shift, colour = 0.5 * ((i + 0.5) / len(names) - 0.5), engine_style(engine).colour
        label = engine
        for row, kind in enumerate(kinds):
            if f"{kind}: ratios" not in data[engine]:
                continue
            low, middle, high = np.quantile(data[engine][f"{kind}: ratios"], shares)
            panel.plot([low, min(high, LARGEST)], 2 * [row + shift], color=colour, linewidth=0.9)
            panel.plot(middle, row + shift, **points(engine, label, markersize=5.0))
            if high > LARGEST:
                panel.plot(LARGEST, row + shift, ">", color=colour, markersize=6.0, clip_on=False)
            label = "_"
    for ratio, linestyle in ((1.0, "-"), (MOST_OVER_ESTIMATE, ":")):
        panel.axvline(ratio, color=BLACK, linewidth=0.8, linestyle=linestyle)
    panel.set(xscale="log", xlim=(SMALLEST, LARGEST), xlabel="estimate / true error")
    panel.set_yticks(range(len(kinds)), kinds)
    panel.invert_yaxis()
    if names:
        panel.legend(loc="lower right")
    return figure
