"""Figures."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from compare.claims import ByEngine, Data, Figures
from compare.output.figures import BLUE, GREEN, ORANGE, PURPLE, axis, curve, engines_in, new_figure, points
from compare.studies.engines.engine_convergence.theory import SOLVERS

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


def draw(data: ByEngine) -> Figures:
    orders = {"engine-convergence-orders": _draw_orders(data["exudyn"])} if "exudyn" in data else {}
    return orders | {"engine-convergence-tolerance": _draw_tolerance(data)}


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
        h, errors = found[f"{solver.name}: steps"], found[f"{solver.name}: sliding"]
        steps.loglog(h, errors, **_marked(solver.look, solver.name))
        if solver.name != "TrapezoidalIndex2":  # its errors equal the errors of generalised-α to 2 %
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
            panel.loglog(tolerances, errors, **points(engine, markersize=4.5))
            middle = len(errors) // 2
            _power(panel, tolerances[[0, -1]], (tolerances[middle], errors[middle]), 1, "")
        panel.plot([], [], **curve("theory", "proportional"))
        panel.set(xlabel="tolerance", ylabel=f"error in {unit}", title=title)
    figure.legend(*panels[0].get_legend_handles_labels(), loc="outside lower center", ncols=3)
    return figure
