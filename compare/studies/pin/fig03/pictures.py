"""The semicircle of Fig. 3, and the eigenvalues of the positions on it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from compare.claims.study import ByEngine, Figures
from compare.output.figures import GREY, axis, curve, engines_in, new_figure, points
from compare.studies.pin.fig03.study import LOADS, PIN, positions, with_load
from reference_model.formulas.pin import equilibrium_position

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


def draw(data: ByEngine) -> Figures:
    """Draw the semicircle with the errors beside it, and the eigenvalues over the friction force."""
    figures = {"fig03-semicircle": draw_semicircle(data)}
    if "theory" in data:
        figures["fig03-eigenvalues"] = draw_eigenvalues(data)
    return figures


def draw_semicircle(data: ByEngine) -> Figure:
    """Draw the positions of rest on the semicircle, and their distance from (3) over μN."""
    figure, (plane, distance) = new_figure(ncols=2, width=9.6, height=3.9)
    if "theory" in data:
        plane.plot(*data["theory"]["position"].T, **curve("theory", "eq. (3)"))
    for engine in engines_in(data):
        found = data[engine]
        plane.plot(*found["position"].T, **points(engine))
        away = np.hypot(*(found["position"] - positions(found["load"])).T)
        floor = np.finfo(float).eps * PIN.offset
        distance.semilogy(found["load"], np.maximum(away, floor), **points(engine))
        budget = curve(engine, f"{engine}: error budget", linewidth=1.0, linestyle="--")
        distance.semilogy(found["load"], found["position_error"], **budget)
    _label(plane)
    if data:
        plane.legend(loc="center", bbox_to_anchor=(0.5, 0.42))
    distance.axhline(1e-9 * PIN.offset, color=GREY, linewidth=0.9, linestyle=":", label=r"$10^{-9}\,X_0$")
    distance.set(
        xlabel=axis(r"\mu N", "N"), ylabel="distance in m", ylim=(1e-16, 1e-8), title="Distance from (3)"
    )
    distance.legend(loc="upper left", ncols=2, fontsize=9.0)
    return figure


def _label(plane: Axes) -> None:
    """Mark axis and relaxed point, and write the friction forces beside the positions of rest."""
    X0 = PIN.offset
    small: dict[str, Any] = {"textcoords": "offset points", "fontsize": 9.5}
    plane.plot([0.0, X0], [0.0, 0.0], color="black", marker="+", linestyle="none", markersize=9.0)
    plane.annotate("axis of the disc", (0.0, 0.0), (2, -13), **small)
    plane.annotate("springs relaxed", (X0, 0.0), (-2, -13), ha="right", **small)
    for load in LOADS:
        x, y = equilibrium_position(with_load(load))
        outwards = np.array([x - X0 / 2.0, y]) / (X0 / 2.0)
        plane.annotate(
            f"{load:g}",
            (x, y),
            tuple(9.0 * outwards),
            ha="left" if outwards[0] > 0.3 else "right" if outwards[0] < -0.3 else "center",
            va="bottom" if outwards[1] > 0.3 else "center",
            **small,
        )
    plane.set(
        xlabel=axis("x", "m"),
        ylabel=axis("y", "m"),
        xlim=(-0.018, 0.121),
        ylim=(-0.012, 0.066),
        aspect="equal",
        title=r"Positions of rest, labelled with $\mu N$ in N",
    )


def draw_eigenvalues(data: ByEngine) -> Figure:
    """Draw real and imaginary parts of the eigenvalues over the friction force."""
    figure, (decay, oscillation) = new_figure(ncols=2, sharex=True)
    theory = data["theory"]
    for panel, part, sign in ((decay, 0, -1.0), (oscillation, 1, 1.0)):
        for which in range(4):
            line = curve("theory", "linearised (1)" if which == 0 else "_")
            panel.plot(theory["eigenvalue_load"], sign * theory["eigenvalue"][:, which, part], **line)
        for engine in engines_in(data):
            load = np.repeat(data[engine]["load"], 4)
            panel.plot(load, sign * data[engine]["eigenvalue"][..., part].ravel(), **points(engine))
        panel.set(xlabel=axis(r"\mu N", "N"))
    decay.set(yscale="log", ylabel=axis(r"-\mathrm{Re}\,\lambda", "1/s"), title="Decay", ylim=(0.02, 100.0))
    decay.annotate("across the circumference", (0.004, 0.55), fontsize=9.5)
    decay.annotate("along the circumference", (0.004, 0.031), fontsize=9.5)
    decay.legend(loc="upper left")
    oscillation.set(ylabel=axis(r"\mathrm{Im}\,\lambda", "1/s"), title="Oscillation")
    return figure
