"""Figure of the coupled clutches: speeds, what runs are off by, and how that falls."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from compare.claims.study import ByEngine, Figures
from compare.output.figures import (
    BLUE,
    GREEN,
    GREY,
    ORANGE,
    PURPLE,
    axis,
    engine_style,
    engines_in,
    new_figure,
)
from compare.studies.drivetrain.coupled_clutches.theory import switches
from compare.studies.toolkit.torsional_chain import STUCK

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

EXACT = 1e-7
"""In rad/s: below this the axis of errors ends."""


def draw(data: ByEngine) -> Figures:
    """Draw what is there."""
    return {"coupled-clutches": _draw(data)} if data else {}


def _draw(data: ByEngine) -> Figure:
    figure, (speeds, errors) = new_figure(nrows=2, width=9.0, height=6.4, sharex=True, height_ratios=(3, 2))
    theory = data.get("theory", {})
    if "t" in theory:
        for number, (colour, speed) in enumerate(
            zip((BLUE, ORANGE, GREEN, PURPLE), theory["speeds"].T, strict=True), 1
        ):
            speeds.plot(theory["t"], speed, color=colour, linewidth=1.6, label=f"rotor {number}")
        speeds.legend(loc="upper right")
        _error(errors, theory["published t"], theory["published"], "Modelica, as published", GREY)
    for engine in engines_in(data):
        found = data[engine]
        if "run t" in found:
            _error(errors, found["run t"], found["run off"], engine, engine_style(engine).colour)
    for time, clutch, mode in switches():
        for panel in (speeds, errors):
            panel.axvline(time, color=GREY, linewidth=0.6, linestyle="-" if mode == STUCK else ":")
        words = f"{clutch + 1} {'holds' if mode == STUCK else 'lets go'}"
        speeds.annotate(words, (time, 10.6), rotation=90, ha="right", va="top", fontsize=8.0, color="0.3")
    speeds.set(ylabel="speed in rad/s", ylim=(-0.3, 10.8))
    errors.set(
        xlabel=axis("t", "s"),
        ylabel="largest error of a speed\nin rad/s",
        yscale="log",
        ylim=(EXACT, 0.1),
        xlim=(0.0, 1.5),
    )
    if errors.get_legend_handles_labels()[0]:
        errors.legend(loc="upper left", ncols=3, fontsize=9.0)
    return figure


def _error(panel: Axes, t: np.ndarray, off: np.ndarray, label: str, colour: str) -> None:
    """Draw the largest of what speeds are off by."""
    panel.plot(t, np.maximum(np.max(np.abs(off), axis=1), EXACT), color=colour, linewidth=1.0, label=label)
