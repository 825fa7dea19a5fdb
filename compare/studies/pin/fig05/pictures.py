"""Figures."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

import compare.output.figures as plots
from compare.claims import ByEngine, Data, Figures
from compare.claims.parameters import FIG5
from compare.output.figures import Axes, axis, engine_style, engines_in, new_figure, points
from reference_model.systems import FloatArray

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.lines import Line2D

LOOKS: dict[str, dict[str, Any]] = {
    "equilibrium": {"color": plots.BLACK},
    "whirl": {"color": plots.GREEN, "linestyle": (0.0, (5.0, 1.5))},
}
"""As in the paper."""

SERIES: dict[str, dict[str, Any]] = {
    "equilibrium": {"linestyle": ":", "marker": "s", "markersize": 5.0},
    "whirl": {"linestyle": ":", "marker": "o", "markersize": 6.0, "markerfacecolor": "none"},
}
BARS: dict[str, dict[str, Any]] = {
    "equilibrium": {"linestyle": "--", "linewidth": 0.9},
    "whirl": {"linestyle": "-.", "linewidth": 0.9},
}
"""Styles of the errors of event times, and of their error bars."""

STUCK = plots.PURPLE


def draw(data: ByEngine) -> Figures:
    from matplotlib.ticker import MaxNLocator

    figure, (plane, near, history, errors) = new_figure(ncols=2, nrows=2, width=9.6, height=8.0)
    for rank, engine in enumerate(engines_in(data)):
        for name, look in LOOKS.items():
            planes = (plane, near) if name == "equilibrium" else (plane,)
            if rank == 0:
                _draw_lines(planes, history, data[engine], name, f"{name}, {engine}", look)
            else:
                times, states, radius = (values[::37] for values in _motion(data[engine], name))
                for panel in planes:
                    panel.plot(states[:, 0], states[:, 1], **points(engine, "", markersize=3.0))
                label = engine if name == "equilibrium" else ""
                history.plot(times, radius, **points(engine, label, markersize=3.0))
            _draw_errors(errors, data[engine], name, engine)
    for panel in (plane, near):
        panel.set(xlabel=axis("x", "m"), ylabel=axis("y", "m"), aspect="equal")
        panel.plot(0.0, 0.0, marker="+", color=plots.BLACK, markersize=8.0)
    plane.set_title("Both motions")
    near.set_title("Approach to the equilibrium")
    history.plot([], [], color=STUCK, linewidth=4.0, label="stick phases")
    history.set(xlabel=axis("t", "s"), ylabel=axis(r"\rho", "m"), xlim=(0.0, 150.0), ylim=(0.0, None))
    history.legend(loc="upper left")
    errors.set(xlabel="stick, release, stick, ... (number of the event)", ylabel="error of the time in s")
    errors.xaxis.set_major_locator(MaxNLocator(integer=True))
    errors.set_ylim(1e-18, None)  # room for the legend
    labels = {line.get_label() for line in errors.lines}
    drawn = tuple(engine for engine in engines_in(data) if engine in labels)
    if errors.lines:
        errors.legend(handles=_legend_of_errors(drawn), loc="lower right", ncols=2, fontsize=9.0)
    return {"fig05-motions": figure}


def _draw_lines(
    planes: tuple[Axes, ...], history: Axes, found: Data, name: str, label: str, look: dict[str, Any]
) -> None:
    times, states, radius = _motion(found, name)
    for panel in planes:
        panel.plot(states[:, 0], states[:, 1], linewidth=0.8, **look)
    history.plot(times, radius, label=label, linewidth=1.1, **look)
    for start, end in found[f"{name}: sticks"].reshape(-1, 2):
        inside = (times >= start) & (times <= end)
        history.plot(times[inside], radius[inside], color=STUCK, linewidth=4.0)


def _motion(found: Data, name: str) -> tuple[FloatArray, FloatArray, FloatArray]:
    states = found[f"{name}: states"]
    return found[f"{name}: times"], states, np.hypot(states[:, 0], states[:, 1])


def _draw_errors(errors: Axes, found: Data, name: str, engine: str) -> None:
    events, exact = found[f"{name}: sticks"], found[f"{name}: reference sticks"]
    if len(events) != len(exact):
        return
    gap = np.maximum(np.abs(events - exact), 1e-14)
    colour, label = engine_style(engine).colour, engine if name == "whirl" else ""
    errors.semilogy(np.arange(1, len(gap) + 1), gap, color=colour, label=label, **SERIES[name])
    errors.axhline(float(found[f"{name}: error bar of sticks"]), color=colour, **BARS[name])


def _legend_of_errors(engines: tuple[str, ...]) -> list[Line2D]:
    from matplotlib.lines import Line2D

    styles: dict[str, dict[str, Any]] = {
        engine: {"color": engine_style(engine).colour, "linewidth": 4.0} for engine in engines
    }
    black = {"color": plots.BLACK}
    styles |= {f"to the {name}": black | look for name, look in SERIES.items()}
    styles |= {f"error bar, {name}": black | look for name, look in BARS.items()}
    return [Line2D([], [], label=label, **style) for label, style in styles.items()]


def animate(data: ByEngine, until: float = 80.0) -> dict[str, bytes]:
    """Show the first ``until`` s of both motions on the turning disc."""
    from compare.report.animation import gif

    if not engines_in(data):
        return {}
    found = data[engines_in(data)[0]]
    figure, panels = new_figure(ncols=2, width=7.2, height=3.9)
    views = [_View(panel, name, found) for panel, name in zip(panels, LOOKS, strict=True)]
    panels[0].set_ylabel(axis("y", "m"))
    shown = np.flatnonzero(found["whirl: times"] <= until)[::4]

    def frame(i: int) -> None:
        for view in views:
            view.show(int(shown[i]))

    moving = [one for view in views for one in view.moving]
    return {"fig05-animation": gif(figure, frame, len(shown), moving=moving)}


class _View:
    TRAIL = 120  # samples

    def __init__(self, panel: Axes, name: str, found: Data) -> None:
        self.name = name
        self.title = panel.set_title("")
        self.times = found[f"{name}: times"]
        self.states = found[f"{name}: states"]
        self.sticks: FloatArray = found[f"{name}: sticks"].reshape(-1, 2)
        panel.set(xlim=(-1.15, 1.15), ylim=(-1.15, 1.15), aspect="equal", xlabel=axis("x", "m"))
        panel.grid(False)
        self.spokes = [panel.plot([], [], color="#cccccc", linewidth=1.0)[0] for _ in range(6)]
        (self.trail,) = panel.plot([], [], color=engine_style("reference").colour, linewidth=1.0)
        (self.pin,) = panel.plot([], [], marker="o", color=plots.BLACK, markersize=7.0)

    @property
    def moving(self) -> tuple[Artist, ...]:
        return (*self.spokes, self.trail, self.pin, self.title)

    def show(self, sample: int) -> None:
        t = float(self.times[sample])
        for i, spoke in enumerate(self.spokes):
            angle = FIG5.disc_speed * t + i * math.pi / 3.0
            spoke.set_data([0.0, 1.1 * math.cos(angle)], [0.0, 1.1 * math.sin(angle)])
        past = self.states[max(sample - self.TRAIL, 0) : sample + 1]
        self.trail.set_data(past[:, 0], past[:, 1])
        self.pin.set_data(past[-1:, 0], past[-1:, 1])
        stuck = bool(np.any((self.sticks[:, 0] <= t) & (t <= self.sticks[:, 1])))
        self.pin.set_color(STUCK if stuck else plots.BLACK)
        self.title.set_text(f"to the {self.name}, t = {t:5.1f} s, {'sticks' if stuck else 'slides'}")
