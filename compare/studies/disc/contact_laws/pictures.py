"""Figures."""

from typing import Any

import compare.output.figures as plots
from compare.claims import ByEngine, Figures
from compare.output.figures import Figure, axis, curve, engines_in, new_figure, points

RATIO = axis("U/W")

LOOKS = {
    "expansion": ("(23)", plots.PURPLE),
    "points6": ("6 points", plots.GREEN),
    "points12": ("12 points", plots.SKY),
    "points24": ("24 points", plots.BLACK),
}
"""Labels and colours of the laws."""

NEAR = (0.2, 5.0)  # range of U/W with visible errors


def draw(data: ByEngine) -> Figures:
    return {"contact-laws": laws(data), "contact-errors": errors(data)}


def laws(data: ByEngine) -> Figure:
    figure, panels = new_figure(ncols=2, width=11.0, height=3.9)
    for i, panel in enumerate(panels):
        if "theory" in data:
            theory = data["theory"]
            ratio = theory["ratio"]
            low, high = theory["points6"]
            style: Any = {"color": plots.GREEN, "alpha": 0.3, "linewidth": 0.0}
            panel.fill_between(ratio, low[:, i], high[:, i], label="6 points, all angles", **style)
            panel.plot(ratio, theory["annulus"][:, i], color=plots.GREY, linestyle="--", label="annulus")
            panel.plot(ratio, theory["expansion"][:, i], color=plots.PURPLE, label="(23)")
            panel.plot(ratio, theory["ring"][:, i], **curve("theory", "ring", linewidth=1.2))
        for engine in engines_in(data):
            if "ring" in data[engine]:
                style = points(engine, f"ring, {engine}")
                panel.plot(data[engine]["ratio"], data[engine]["ring"][:, i], **style)
        panel.set(xscale="log", xlabel=RATIO)
    force, moment = panels
    force.set(ylabel=axis(r"F/\mu N"), title="Force against the slip")
    moment.set(ylabel=axis(r"M/\mu N R"), title="Moment")
    if force.get_legend_handles_labels()[0]:
        force.legend()
    return figure


def errors(data: ByEngine) -> Figure:
    figure, panels = new_figure(ncols=2, width=11.0, height=3.9)
    for i, panel in enumerate(panels):
        if "theory" in data:
            theory = data["theory"]
            for name, (label, colour) in LOOKS.items():
                place, size = theory[f"{name}_worst"][i]
                error = theory[f"{name}_error"][:, i]
                panel.plot(theory["ratio"], error, color=colour, label=f"{label}: {size:.3f} at {place:.2f}")
                panel.plot([place], [size], color=colour, marker="o", markersize=6.0, linestyle="none")
            panel.legend(title="largest error, at U/W")
        panel.set(xscale="log", xlabel=RATIO, xlim=NEAR, xticks=(0.2, 0.5, 1.0, 2.0, 5.0))
        panel.set_xticks((), minor=True)
        panel.xaxis.set_major_formatter("{x:g}")
    force, moment = panels
    force.set(ylabel=axis(r"|\Delta F|/\mu N"), title="Deviation of the force from the ring")
    moment.set(ylabel=axis(r"|\Delta M|/\mu N R"), title="Deviation of the moment from the ring")
    return figure
