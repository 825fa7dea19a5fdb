"""Figures of judder and of a clutch that warms up."""

from __future__ import annotations

from typing import TYPE_CHECKING

from compare.claims.study import ByEngine, Figures
from compare.output.figures import GREY, axis, curve, engines_in, new_figure, points

if TYPE_CHECKING:
    from matplotlib.axes import Axes


def draw(data: ByEngine) -> Figures:
    """Draw growth over the fall of friction, and slip and temperature over time."""
    if not data:
        return {}
    judder, (growth,) = new_figure(width=5.5, height=3.6)
    growth.axhline(0.0, color=GREY, linewidth=0.6)
    _both(growth, data, ("falls", "growth"), ("measured falls", "measured growth"))
    growth.set(xlabel="fall of μ with the slip, over that of onset", ylabel="growth in 1/s")
    growth.legend(loc="upper left")

    heat, (slips, temperatures) = new_figure(ncols=2, width=10.0, height=3.6)
    theory = data.get("theory", {})
    if "cold t" in theory:
        slips.plot(theory["cold t"], theory["slips"], color=GREY, linestyle="--", label="cold friction")
    _both(slips, data, ("t", "slips"), ("engaged t", "engaged slip"))
    _both(temperatures, data, ("held t", "held"), ("measured t", "measured temperature"))
    slips.set(xlabel=axis("t", "s"), ylabel="slip in rad/s", title="engagement", ylim=(0.0, None))
    temperatures.set(xlabel=axis("t", "s"), ylabel="temperature in °C", title="held slip")
    slips.legend(fontsize=8.5)
    return {"clutch-parts-judder": judder, "clutch-parts-heat": heat}


def _both(panel: Axes, data: ByEngine, closed_form: tuple[str, str], measured: tuple[str, str]) -> None:
    """Draw the closed form and the results of the engines, by the names of their abscissa and ordinate."""
    for name in ("theory", *engines_in(data)):
        x, y = closed_form if name == "theory" else measured
        found = data.get(name, {})
        if y in found:
            style = curve(name, "closed form") if name == "theory" else points(name)
            panel.plot(found[x], found[y], **style)
