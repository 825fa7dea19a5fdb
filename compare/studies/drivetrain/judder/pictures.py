"""Figure of judder: growth over the fall of friction, and judder that has grown."""

from __future__ import annotations

from typing import TYPE_CHECKING

from compare.claims.study import ByEngine, Figures
from compare.output.figures import BLACK, GREY, axis, curve, engine_style, engines_in, new_figure, points
from compare.studies.drivetrain.judder.parameters import GROWN_UNTIL, ONSET, SPEED

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def draw(data: ByEngine) -> Figures:
    """Draw what is there."""
    return {"judder": _draw(data)} if data else {}


def _draw(data: ByEngine) -> Figure:
    figure, (growth, speed) = new_figure(ncols=2, width=10.0, height=3.6)
    growth.axhline(0.0, color=GREY, linewidth=0.6)
    if "theory" in data:
        found = data["theory"]
        growth.plot(found["gradients"] / ONSET, found["growth"], **curve("theory", "closed form"))
    for engine in engines_in(data):
        found = data[engine]
        if "measured" in found:
            growth.plot(found["at"] / ONSET, found["measured"], **points(engine))
        if "grown t" in found:
            colour = engine_style(engine).colour
            speed.plot(found["grown t"], found["grown speed"], color=colour, linewidth=0.8, label="disc")
    speed.axhline(SPEED, color=BLACK, linewidth=0.8, linestyle="--", label="drive")
    growth.set(xlabel="fall of μ with the slip, over that of onset", ylabel="growth in 1/s")
    speed.set(xlabel=axis("t", "s"), ylabel="speed in rad/s", xlim=(0.0, GROWN_UNTIL), ylim=(-90.0, 60.0))
    if growth.get_legend_handles_labels()[0]:
        growth.legend(loc="upper left")
    speed.legend(loc="lower left", ncols=2)
    return figure
