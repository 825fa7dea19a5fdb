"""Figure of the warm clutch: slip that ends later, and temperatures."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from compare.claims.study import ByEngine, Figures
from compare.output.figures import GREY, axis, curve, engines_in, new_figure, points
from compare.studies.drivetrain.warm_clutch.parameters import HELD, SLIP
from compare.studies.drivetrain.warm_clutch.theory import cold_slipping_time

if TYPE_CHECKING:
    from matplotlib.figure import Figure

CURVES = ("t", "slip"), ("t", "warmed"), ("later", "held")
POINTS = ("engaged t", "engaged slip"), ("engaged t", "engaged temperature"), ("held t", "held temperature")


def draw(data: ByEngine) -> Figures:
    """Draw what is there."""
    return {"warm-clutch": _draw(data)} if data else {}


def _draw(data: ByEngine) -> Figure:
    figure, panels = new_figure(ncols=3, width=11.0, height=3.4)
    panels[0].plot(
        [0.0, cold_slipping_time(0.0)],
        [SLIP, 0.0],
        color=GREY,
        linestyle="--",
        label="friction that stays cold",
    )
    for names, look, engines in ((CURVES, curve, ["theory"]), (POINTS, points, engines_in(data))):
        for engine in engines:
            found = data.get(engine, {})
            for panel, (t, shown) in zip(panels, names, strict=True):
                if shown in found:
                    style = look(engine, "closed form") if engine == "theory" else look(engine)
                    panel.plot(np.asarray(found[t]), np.asarray(found[shown]), **style)
    panels[0].set(ylabel="slip in rad/s", title="engagement")
    panels[1].set(ylabel="temperature in °C", title="engagement")
    panels[2].set(ylabel="temperature in °C", title="held slip", xlim=(0.0, HELD[-1]))
    for panel in panels:
        panel.set_xlabel(axis("t", "s"))
    panels[0].legend(fontsize=8.5)
    return figure
