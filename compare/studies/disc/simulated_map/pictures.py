"""The ends of a plane of discs, under the curves of the stability map."""

from __future__ import annotations

from typing import Any

import numpy as np

from compare.claims.parameters import FIG11
from compare.claims.study import ByEngine, Figures
from compare.output.figures import BLACK, GREEN, GREY, ORANGE, PURPLE, SKY, axis, new_figure
from compare.studies.disc.simulated_map.study import DAMPING, SHAFT_DAMPING
from reference_model.systems import FloatArray

DARK = "#3d3d3d"

LOOKS = {
    "UNDECIDED": ("undecided", "#ffffff"),
    "SELF_CENTRED": ("rotation about the axis", "#f3ead7"),
    "WHIRL": ("whirl", SKY),
    "MODULATED": ("modulated cycle", ORANGE),
    "STUCK": ("sticks", DARK),
}

CURVES: dict[str, tuple[str, Any]] = {
    "onset": (BLACK, "-"),
    "Hopf": (GREEN, "-"),
    "fold": (PURPLE, (0.0, (5.0, 2.0))),
}


def draw(data: ByEngine) -> Figures:
    """Draw the ends under the curves."""
    if "theory" not in data:
        return {}
    from matplotlib.colors import ListedColormap
    from matplotlib.lines import Line2D
    from matplotlib.patches import Patch

    from reference_model.ensemble import EndState

    found = data["theory"]
    figure, (plane,) = new_figure(width=8.4, height=4.4)
    plane.imshow(
        found["ends"],
        origin="lower",
        extent=_edges(DAMPING) + _edges(SHAFT_DAMPING),
        cmap=ListedColormap([colour for _, colour in LOOKS.values()]),
        vmin=-0.5,
        vmax=len(LOOKS) - 0.5,
        interpolation="nearest",
        aspect="auto",
    )
    for name, points in found.items():
        if name != "ends":
            colour, dashes = CURVES[name.split("/")[0]]
            plane.plot(*points.T, color=colour, linestyle=dashes, linewidth=1.6)
    plane.plot(FIG11.damping, FIG11.shaft_damping, "+", color="white", markersize=10.0, markeredgewidth=1.8)
    plane.set(
        xlabel=axis(r"\beta", "N s/m"),
        ylabel=axis("b", "N m s/rad"),
        xlim=_edges(DAMPING),
        ylim=_edges(SHAFT_DAMPING),
    )
    shown = [
        Patch(facecolor=colour, edgecolor=GREY, label=words)
        for name, (words, colour) in LOOKS.items()
        if np.any(found["ends"] == EndState[name])
    ]
    lines = [
        Line2D([], [], color=colour, linestyle=dashes, label=kind)
        for kind, (colour, dashes) in CURVES.items()
    ]
    plane.legend(handles=[*shown, *lines], loc="center left", bbox_to_anchor=(1.01, 0.5))
    return {"simulated-map": figure}


def _edges(values: FloatArray) -> tuple[float, float]:
    """Return from where to where a picture of ``values`` reaches: half a step beyond both ends."""
    half = 0.5 * (values[1] - values[0])
    return float(values[0] - half), float(values[-1] + half)
