"""Figures of the paths and of the spin of sliding cubes."""

import numpy as np

import compare.studies.plane.tosses.study as study
from compare.claims import ByEngine, Figures
from compare.output.figures import (
    BLACK,
    BLUE,
    GREEN,
    GREY,
    ORANGE,
    Axes,
    axis,
    engines_in,
    new_figure,
    points,
)
from compare.studies.plane.tosses.theory import SPEEDS, Slides, box_turn, measured

LINES = {"four corners": BLUE, "rim": GREEN, "even pressure": ORANGE}
"""Colours of the loads on the flat face."""


def draw(data: ByEngine) -> Figures:
    figures = {
        "tosses-path": new_figure(width=5.2, height=3.9),
        "tosses-spin": new_figure(ncols=2, width=9.6),
    }
    (path,), (loads, engines) = (panels for _, panels in figures.values())
    slides = measured()
    heading = np.degrees(slides["slip"]) % 90.0
    for name, turned, colour in (("box", 0.0, ORANGE), ("pyramid", 0.25 * np.pi, GREEN)):
        path.plot(
            heading, box_turn(slides, turned), ".", color=colour, markersize=3.0, label=f"{name}, predicted"
        )
    path.axhline(0.0, color=GREY, label="cone, predicted without spin")
    path.plot(heading, slides["turn_deg"], ".", color=BLACK, markersize=4.0, label="measured")
    path.set(
        xlabel="heading of the path in the record in degrees",
        ylabel="turn of the path in degrees",
        xlim=(0.0, 90.0),
    )
    path.set_ylim(-42.0, 65.0)
    path.legend(loc="upper center", fontsize="small", ncols=2)
    for name, shares in study.loads_on_the_face().items():
        loads.plot(SPEEDS, shares, color=LINES[name], label=f"{name}, predicted")
    for panel, shown, title in (
        (loads, slides, f"All {len(heading)} slides"),
        (engines, study.fastest(), f"The {study.FEWER} slides with the fastest spin"),
    ):
        _measured(panel, shown)
        panel.set(xlabel=axis("v", "m/s"), ylim=(0.0, 1.0), title=title)
    for engine in [engine for engine in engines_in(data) if "spins left" in data[engine]]:
        engines.plot(SPEEDS, data[engine]["spins left"], **points(engine, f"{engine}, four corners"))
    loads.set_ylabel("share of the spin that is left")
    for panel in (loads, engines):
        panel.invert_xaxis()
        panel.legend(loc="lower left")
    return {name: figure for name, (figure, _) in figures.items()}


def _measured(panel: Axes, slides: Slides) -> None:
    share, error = study.spins_left(slides["spins"], slides["spin_first"])
    panel.errorbar(SPEEDS, share, 2.0 * error, fmt="o", color=BLACK, capsize=3.0, label="measured")
