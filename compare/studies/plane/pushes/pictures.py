"""Figures of forces, errors and the limit surface."""

import numpy as np

from compare.claims import ByEngine, Data, Figures
from compare.output.figures import BLACK, BLUE, GREY, ORANGE, Axes, Figure, axis, curve, new_figure
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
    return {"pushes-forces": _forces(), "pushes-errors": _errors(data.get("exudyn", {}))}


def _forces() -> Figure:
    figure, panels = new_figure(ncols=len(SHOWN) + 1, width=13.2, height=4.6)
    for panel, series in zip(panels, SHOWN, strict=False):
        corners = np.array([0.0, LEGS, 1j * LEGS, 0.0])
        panel.plot(corners.real, corners.imag, color=GREY, linewidth=1.0)
        places = np.array(feet(series), dtype=complex)
        panel.plot(places.real, places.imag, "o", color=GREY)
        for push in by_series()[series]:
            for wrench, colour in ((coulomb(push), ORANGE), (measured(push), BLACK)):
                arrow = complex(push.end_x, push.end_y) - LENGTH * wrench.force * np.array([1.0, 0.0])
                panel.plot(arrow.real, arrow.imag, color=colour, linewidth=0.9)
        panel.set(xlabel=axis("x", "mm"), ylabel=axis("y", "mm"), aspect="equal", title=_title(series))
    for place, words, colour in ((0.97, "measured", BLACK), (0.91, "Coulomb's law", ORANGE)):
        for panel in (panels[0], panels[-1]):
            panel.text(0.97, place, words, color=colour, transform=panel.transAxes, ha="right", va="top")
    _limit_surface(panels[-1], SHOWN[0])
    return figure


SURFACES = {"board": BLUE, "wood": ORANGE}
"""Colour of each surface."""

LENGTH = 6.0
"""Length of arrows in mm/N."""


def _limit_surface(panel: Axes, series: str) -> None:
    load = SLIDING_FORCES[surface(series)]
    directions = np.radians(range(150, 301, 30)).tolist()  # θ and 270° − θ have the same curve
    draw_limit_surface(panel, contact_of(series), directions, color=ORANGE, linewidth=0.5)
    for wrench in map(measured, by_series()[series]):
        panel.plot(abs(wrench.force) / load, wrench.moment / load, ".", color=BLACK)
    panel.set(xlim=(0.0, None), title="Limit surface of the feet on the left")


def _errors(positions: Data) -> Figure:
    figure, panels = new_figure(ncols=3 if positions else 2, width=13.2 if positions else 9.6, height=3.8)
    for series, pushes in by_series().items():
        colour, width = SURFACES[surface(series)], 1.0 if feet(series) else 2.4
        panels[0].ecdf(errors(pushes, force_error), color=colour, linewidth=width)
        theory, found = ([abs(law(push).force) for push in pushes] for law in (coulomb, measured))
        panels[1].plot(theory, found, "." if feet(series) else "x", markersize=4.0, color=colour)
    for place, words, colour in (
        ((17.0, 0.36), "on the board", SURFACES["board"]),
        ((17.0, 0.28), "on wood", SURFACES["wood"]),
        ((17.0, 0.12), "thick: whole face\nthin: three feet", BLACK),
    ):
        panels[0].text(*place, words, color=colour)
    panels[1].text(1.2, 1.35, "equal", color=GREY, rotation=28.0)
    panels[0].set(
        xlabel="error of the force's direction in degrees", ylabel="share of the pushes", xlim=(0.0, 45.0)
    )
    panels[1].plot([0.0, 5.0], [0.0, 5.0], color=GREY, linewidth=0.9)
    panels[1].set(xlabel="predicted force in N", ylabel="measured force in N")
    for engine, distances in positions.items():
        panels[2].ecdf(distances, **curve(engine))
        panels[2].set(xlabel="error of the final position in mm", ylabel="share of the pushes")
        panels[2].legend(loc="lower right")
    return figure


def _title(series: str) -> str:
    places = ", ".join(f"({place.real:.0f}, {place.imag:.0f})" for place in feet(series))
    contact = f"feet {places}" if places else "whole face"
    return f"{contact} on {'wood' if surface(series) == 'wood' else 'the board'}"
