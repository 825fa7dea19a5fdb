"""Figures."""

import math
import textwrap

import numpy as np

from compare.claims import TRUTH, ByEngine, Figures
from compare.output.figures import GREY, axis, curve, engine_style, engines_in, new_figure
from compare.studies.engines.trajectories.theory import MOTIONS

COLUMNS = 4


def draw(data: ByEngine) -> Figures:
    rows = math.ceil(len(MOTIONS) / COLUMNS)
    figure, panels = new_figure(
        ncols=COLUMNS, nrows=rows, width=11.0, height=2.6 * rows, sharex=True, sharey=True
    )
    for panel, name in zip(panels, MOTIONS, strict=False):
        panel.set_title(textwrap.fill(name, 30), fontsize=9.5)
        panel.axhspan(0.1 * TRUTH, TRUTH, color=GREY, alpha=0.25, linewidth=0.0)
        for engine in engines_in(data):
            found = data[engine]
            if f"{name}: times" in found:
                so_far = np.maximum.accumulate(np.maximum(found[f"{name}: difference"], 0.1 * TRUTH))
                panel.semilogy(found[f"{name}: times"], so_far, **curve(engine))
                colour = engine_style(engine).colour
                panel.axhline(float(found[f"{name}: error bar"]), color=colour, linewidth=0.9, linestyle="--")
    panels[0].plot([], [], color=GREY, linewidth=0.9, linestyle="--", label="error bar")
    spare = panels[len(MOTIONS) :]
    for panel in spare:
        panel.axis("off")
    for panel in panels[max(0, len(MOTIONS) - COLUMNS) : len(MOTIONS)]:
        panel.set_xlabel(axis("t", "s"))
        panel.tick_params(labelbottom=True)
    panels[0].set_ylim(0.1 * TRUTH, None)
    figure.supylabel("largest deviation of the state so far", fontsize=11.0)
    named = {
        label: line for one in panels for line, label in zip(*one.get_legend_handles_labels(), strict=True)
    }
    (spare[0] if len(spare) else panels[0]).legend(named.values(), named.keys(), loc="center")
    return {"trajectories": figure}
