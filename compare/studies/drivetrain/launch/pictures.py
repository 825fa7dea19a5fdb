"""Figures of the launch."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from compare.claims.study import ByEngine, Data, Figures
from compare.output.figures import BLACK, BLUE, GREEN, GREY, ORANGE, axis, curve, new_figure, points
from compare.studies.toolkit.drivetrain_bench import RPM

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def draw(data: ByEngine) -> Figures:
    """Draw the launch over time, and what creep in stick does."""
    found = data.get("exudyn", {})
    if "t" not in found or "epsilon" not in found:
        return {}
    return {"drivetrain-launch": _launch(found), "drivetrain-launch-stick": _stick(found)}


def _launch(found: Data) -> Figure:
    figure, panels = new_figure(ncols=2, nrows=2, width=10.0, height=6.4, sharex=True)
    speeds, torques, energies, radii = panels
    t, (start, end) = found["t"], found["stick"]
    for panel in panels:
        panel.axvspan(start, end, color=GREY, alpha=0.2, linewidth=0.0)
    for name, colour, speed in zip(
        ("engine", "disc", "vehicle"), (BLUE, ORANGE, GREEN), found["speeds"].T, strict=True
    ):
        width = 2.6 if name == "vehicle" else 1.3
        speeds.plot(
            t,
            speed / RPM,
            color=colour,
            linewidth=width,
            label=name,
            zorder=2.0 if name == "vehicle" else 3.0,
        )
    speeds.set(ylabel="speed in rpm", ylim=(0.0, None))
    speeds.annotate("sticks", ((start + end) / 2.0, 2700.0), ha="center")
    speeds.legend(loc="lower right")
    torques.plot(t, found["shaft torque"], color=ORANGE, label="of the shaft")
    torques.plot(
        t, found["capacity"], color=BLACK, linewidth=1.0, linestyle="--", label="capacity of the clutch"
    )
    torques.set(ylabel="torque in N m")
    torques.legend(loc="upper left")
    energies.plot(t, np.gradient(found["heat"], t) / 1e3, color=ORANGE, label="power in kW")
    energies.plot(t, found["heat"] / 1e3, color=BLACK, linestyle="--", label="heat in kJ")
    energies.set(xlabel=axis("t", "s"), ylabel="of the facings, in kW and kJ", ylim=(0.0, None))
    energies.legend(loc="upper left")
    radii.plot(t, 1e3 * np.hypot(*found["centre"].T), color=ORANGE, linewidth=0.8)
    radii.set(xlabel=axis("t", "s"), ylabel="radius of the disc's centre in mm", ylim=(0.0, None))
    return figure


def _stick(found: Data) -> Figure:
    figure, (torques, order) = new_figure(ncols=2, width=10.0, height=3.8)
    torques.plot(found["t held"], found["held"], **curve("theory", "held by Coulomb friction"))
    for epsilon, creep, marker in zip(found["epsilon"], found["creep"], "x+sd", strict=False):
        label = f"from creep, ε = {epsilon:g} m/s"
        torques.plot(found["stuck"], creep, **points("exudyn", label, marker=marker))
    torques.plot(found["stuck"], found["limit"], **points("exudyn", "extrapolated to ε = 0", marker="o"))
    torques.set(xlabel=axis("t", "s"), ylabel="torque in N m", ylim=(0.0, 210.0))
    torques.legend(loc="upper left", ncols=2)
    epsilons, changes = found["epsilon"], found["changes"]
    order.loglog(epsilons, changes, **points("exudyn"))
    order.loglog(epsilons, changes[0] * epsilons / epsilons[0], color=BLACK, linewidth=0.8, label="slope 1")
    order.set(
        xlabel=axis(r"\epsilon", "m/s"), ylabel="change of speeds and heat, over theirs", ylim=(1e-3, 1e-1)
    )
    order.set_xticks(epsilons, [f"{epsilon:g}" for epsilon in epsilons])
    order.minorticks_off()
    order.legend(loc="upper left")
    return figure
