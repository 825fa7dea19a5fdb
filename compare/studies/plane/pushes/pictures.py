"""Figures of forces, errors and the limit surface."""

from __future__ import annotations

import numpy as np

from compare.claims import ByEngine, Figures
from compare.output.figures import BLACK, GREY, Axes, Figure, axis, new_figure
from compare.output.limit_surface import draw_limit_surface
from compare.studies.plane.pushes.theory import (
    LEGS,
    SLIDING_FORCES,
    by_series,
    contact_of,
    coulomb,
    errors,
    feet,
    force_error,
    measured,
    surface,
)

SHOWN = ("10_130_10_10_10_130", "patch")
"""Series of the first figure."""


def draw(data: ByEngine) -> Figures:
    return {"pushes-forces": _forces(), "pushes-errors": _errors()}


def _forces() -> Figure:
    figure, panels = new_figure(ncols=len(SHOWN) + 1, width=13.2, height=4.6)
    for panel, series in zip(panels, SHOWN, strict=False):
        corners = np.array([0.0, LEGS, 1j * LEGS, 0.0])
        panel.plot(corners.real, corners.imag, color=GREY, linewidth=1.0)
        panel.plot(
            *np.array([[foot.real, foot.imag] for foot in feet(series)] or np.empty((0, 2))).T,
            "o",
            color=GREY,
        )
        for push in by_series()[series]:
            theory = coulomb(push).force
            for force, colour in ((theory, "tab:orange"), (measured(push).force, BLACK)):
                way = LENGTH * force
                panel.plot(
                    [push.end_x - way.real, push.end_x],
                    [push.end_y - way.imag, push.end_y],
                    color=colour,
                    linewidth=0.9,
                )
        panel.set(xlabel=axis("x", "mm"), ylabel=axis("y", "mm"), aspect="equal", title=_title(series))
    panels[0].plot([], [], color=BLACK, label="measured")
    panels[0].plot([], [], color="tab:orange", label="Coulomb's law")
    panels[0].legend(loc="upper right")
    _limit_surface(panels[-1], SHOWN[0])
    return figure


LENGTH = 6.0
"""Length of arrows in mm/N."""


def _limit_surface(panel: Axes, series: str) -> None:
    load = SLIDING_FORCES[surface(series)]
    directions = np.linspace(0.0, 2.0 * np.pi, 12, endpoint=False).tolist()
    draw_limit_surface(panel, contact_of(series), directions, color="tab:orange", linewidth=0.5)
    for push in by_series()[series]:
        wrench = measured(push)
        panel.plot(abs(wrench.force) / load, wrench.moment / load, ".", color=BLACK)
    panel.set(xlim=(0.0, None), title="Limit surface of the feet on the left")


def _errors() -> Figure:
    figure, panels = new_figure(ncols=2, width=9.6, height=3.8)
    for series, pushes in by_series().items():
        dashes = "--" if surface(series) == "wood" else "-"
        sizes = np.sort(errors(pushes, force_error))
        panels[0].step(
            sizes,
            (np.arange(len(sizes)) + 1.0) / len(sizes),
            where="post",
            label=_title(series),
            linestyle=dashes,
        )
        theory = [abs(coulomb(push).force) for push in pushes]
        found = [abs(measured(push).force) for push in pushes]
        panels[1].plot(
            theory, found, "." if surface(series) == "board" else "x", markersize=4, label=_title(series)
        )
    panels[0].set(
        xlabel="error of the force's direction in degrees", ylabel="share of the pushes", xlim=(0.0, 45.0)
    )
    panels[1].plot([0.0, 5.0], [0.0, 5.0], color=GREY, linewidth=0.9)
    panels[1].set(xlabel="predicted force in N", ylabel="measured force in N")
    panels[0].legend(loc="lower right", fontsize="x-small")
    return figure


def _title(series: str) -> str:
    contact = (
        "whole face"
        if not feet(series)
        else "feet " + ", ".join(f"({p.real:.0f}, {p.imag:.0f})" for p in feet(series))
    )
    return f"{contact} on {'wood' if surface(series) == 'wood' else 'the board'}"
