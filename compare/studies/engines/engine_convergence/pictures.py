"""Figures."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from compare.claims import ByEngine, Data, Figures
from compare.output.figures import BLUE, GREEN, ORANGE, PURPLE, axis, curve, engines_in, new_figure
from compare.studies.engines.engine_convergence.theory import SOLVERS

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


def draw(data: ByEngine) -> Figures:
    figures = {
        "engine-convergence-tolerance": _draw_tolerance(data),
        "engine-convergence-work": _draw_work(data),
    }
    if "exudyn" in data:
        figures = {"engine-convergence-orders": _draw_orders(data["exudyn"])} | figures
    return figures


def _power(panel: Axes, x: ArrayLike, through: tuple[float, float], power: int, label: str) -> None:
    x = np.asarray(x, dtype=float)
    y = through[1] * (x / through[0]) ** power
    panel.plot(x, y, **curve("theory", ""))
    i = int(np.argmax(x))
    panel.annotate(label, (x[i], y[i]), xytext=(5, -2), textcoords="offset points", va="center")


def _marked(look: Mapping[str, Any], label: str, **changes: Any) -> dict[str, Any]:
    return (
        {"linestyle": "none", "markerfacecolor": "none", "label": label, "zorder": 5.0} | dict(look) | changes
    )


def _draw_orders(found: Data) -> Figure:
    figure, (steps, smoothing) = new_figure(ncols=2, width=9.6, height=4.4)
    for solver in SOLVERS:
        h, errors = found[f"{solver.name}: steps"], found[f"{solver.name}: sliding"][:, 0]
        steps.loglog(h, errors, **_marked(solver.look, solver.name))
        if solver.name != "TrapezoidalIndex2":  # its errors equal those of generalised-α to 2 %
            _power(steps, h[[0, -1]], (h[-1], errors[-1]), solver.order, f"$h^{solver.order}$")
    steps.set(xlabel=axis("h", "s"), ylabel="error in m, m/s", xlim=(None, 1.3))
    steps.legend(loc="upper center", bbox_to_anchor=(0.5, -0.17), ncols=2)

    epsilon, first = found["first regularisations"], found["first stick"]
    smoothing.loglog(
        epsilon, first, **_marked({"color": BLUE, "marker": "s", "markersize": 5.0}, "first stick")
    )
    _power(smoothing, epsilon[[0, -1]], (epsilon[6], first[6]), 2, r"$\varepsilon^2$")
    epsilon, later = found["regularisations"], found["later events and state"]
    looks = (("release", ORANGE, "o"), ("stick", GREEN, "^"))
    for i, errors in enumerate(later[:, :-1].T):
        kind, colour, marker = looks[i % 2]
        label = f"later {kind} times" if i >= len(later.T) - 3 else ""
        smoothing.loglog(
            epsilon, errors, **_marked({"color": colour, "marker": marker, "markersize": 5.5}, label)
        )
    state = {"color": PURPLE, "marker": "x", "markersize": 5.0}
    smoothing.loglog(epsilon, later[:, -1], **_marked(state, "state at 20 s (m, m/s)"))
    for column in (0, 3):
        middle = len(epsilon) // 2
        _power(smoothing, epsilon[[0, -1]], (epsilon[middle], later[middle, column]), 1, r"$\varepsilon$")
    smoothing.set(xlabel=axis(r"\varepsilon", "m/s"), ylabel="error in s", xlim=(None, 3e-3))
    smoothing.legend(loc="upper center", bbox_to_anchor=(0.5, -0.17), ncols=2)
    return figure


def _draw_tolerance(data: ByEngine) -> Figure:
    figure, panels = new_figure(ncols=2, width=9.6, height=4.0)
    for panel, kind, title, unit in zip(
        panels,
        ("sliding", "sticking"),
        ("Sliding pin", "First stick and release"),
        ("m, m/s", "s"),
        strict=True,
    ):
        for engine in engines_in(data):
            tolerances, errors = data[engine][f"{kind}: tolerances"], data[engine][f"{kind}: errors"]
            panel.loglog(tolerances, errors, **_marks(engine))
            middle = len(errors) // 2
            _power(panel, tolerances[[0, -1]], (tolerances[middle], errors[middle]), 1, "")
        panel.plot([], [], **curve("theory", "proportional"))
        panel.set(xlabel="tolerance", ylabel=f"error in {unit}", title=title)
    _legend_below(figure, panels)
    return figure


def _draw_work(data: ByEngine) -> Figure:
    from matplotlib.ticker import LogLocator, NullFormatter, StrMethodFormatter

    figure, panels = new_figure(ncols=2, nrows=2, width=9.6, height=7.0, sharey="col")
    for row, (column, scale, label) in enumerate(((1, 1.0, "evaluations"), (2, 1e3, "processor time in ms"))):
        for panel, kind, title in zip(
            panels[2 * row : 2 * row + 2],
            ("sliding", "stick-slip"),
            ("Sliding pin, 2 × 20 s", "Nine stick phases, 60 s"),
            strict=True,
        ):
            for engine in engines_in(data):
                rows = data[engine][f"work: {kind}"]
                panel.loglog(scale * rows[:, column], rows[:, 0], **_marks(engine, line=True))
            for solver in SOLVERS:
                name = f"{solver.name}: {kind}"
                if "exudyn" in data and name in data["exudyn"]:
                    rows = data["exudyn"][name]
                    style = _marked(
                        solver.look, f"Exudyn {solver.name}, fixed step", linestyle=":", linewidth=0.9
                    )
                    panel.loglog(scale * rows[:, column], rows[:, 0], **style)
            panel.set(xlabel=label, ylabel="error in m, m/s", title=title if row == 0 else "")
            panel.xaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
            panel.xaxis.set_major_formatter(StrMethodFormatter("{x:g}"))
            panel.xaxis.set_minor_formatter(NullFormatter())
    _legend_below(figure, panels)
    return figure


def _marks(engine: str, *, line: bool = False) -> dict[str, Any]:
    style = curve(engine, marker="o" if engine == "reference" else "x", markersize=4.5, linewidth=1.4)
    return style if line else style | {"linestyle": "none", "markerfacecolor": "none"}


def _legend_below(figure: Figure, panels: tuple[Axes, ...]) -> None:
    found: dict[str, Any] = {}
    for panel in panels:
        handles, labels = panel.get_legend_handles_labels()
        found = dict(zip(labels, handles, strict=True)) | found
    figure.legend(found.values(), found.keys(), loc="outside lower center", ncols=3)
