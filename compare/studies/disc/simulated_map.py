"""Final motions of thousands of discs around Fig. 11, under the curves of the stability map."""

import functools
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np

from compare.claims import WORKING, ByEngine, Data, Figures, Measured, Study, answers_of
from compare.claims.parameters import FIG11
from compare.claims.shares import Ends
from compare.output.figures import BLACK, GREEN, GREY, ORANGE, PURPLE, SKY, axis, new_figure
from compare.studies.toolkit.fig11 import KINDS, curves_in
from reference_model import onset_load, whirls
from reference_model.ensemble import EndState, simulate_ensemble
from reference_model.systems import DiscOnDisc, FloatArray

SIDE = 60  # discs along each side

DAMPING, SHAFT_DAMPING = np.linspace(0.2, 2.0, SIDE), np.linspace(0.004, 0.026, SIDE)
"""β in N s/m and b in N m s/rad."""

START = (1e-3, 0.0, 0.0, 0.0, 1e-3, 1.41)  # x, y, angle, vx, vy, spin, close to the axis
UNTIL = 12000.0  # duration in s until the slowest motions settle
TOLERANCE = 10.0 * WORKING  # sufficient for the kind of final motion

MARGIN = 0.05
"""Relative distance of μN from the onset within which deviations neither grow nor decay in this time."""

EVERY, GROWN = 5, 15.0
"""Stride of the discs for eigenvalues of whirls, and growth exponent that lets motions leave an unstable whirl."""

UNDECIDED_IS_OPEN = 2.0
"""Error of an undecided motion, larger than the margins ±1 of the answers."""


def on_plane(quantity: Callable[[DiscOnDisc], float], stride: slice = slice(None)) -> FloatArray:
    """Return a quantity of every disc; each row has one shaft damping."""
    return np.array(
        [
            [quantity(replace(FIG11, damping=beta, shaft_damping=b)) for beta in DAMPING[stride].tolist()]
            for b in SHAFT_DAMPING[stride].tolist()
        ]
    )


@functools.cache
def simulated() -> Ends:
    """Return the ``EndState`` of each disc, shape (SIDE, SIDE)."""
    beta, b = np.meshgrid(DAMPING, SHAFT_DAMPING)
    parameters = {"damping": beta.ravel(), "shaft_damping": b.ravel()}
    found = simulate_ensemble(FIG11, START, duration=UNTIL, tolerance=TOLERANCE, parameters=parameters)
    return found.end.reshape(SIDE, SIDE)


def growth(disc: DiscOnDisc) -> float:
    """Return the smallest growth rate (1/s) among the whirls of a disc, −inf if it has none."""
    found = whirls(disc)
    return min((max(value.real for value in each.eigenvalues) for each in found), default=-np.inf)


def curves() -> Data:
    found = {"ends": simulated().astype(float)}
    for kind in KINDS:
        for i, boundary in enumerate(curves_in("dampers", kind, "ring")):
            found[f"{kind}/{i}"] = boundary.parameters
    return found


STUDY = Study.beside(
    __file__,
    "simulated-map",
    source=f"Fig. 11 with X0 = 0; β, b and the start {START} are our choice",
    system=FIG11,
    only=("theory",),  # only the reference has an ensemble
    seconds=2.0,
    words={"side": f"{SIDE}"},
)


@STUDY.claim(
    "Motions that start near the axis return to it if μN is below the onset, and leave it above",
    equation="(19)–(21)",
    note=f"Without motions within {MARGIN:g} of the onset's μN, and without motions that stick. By the compiled "
    f"ensemble until t = {UNTIL:g} s, which may leave one disc in a thousand undecided.",
    basis="reference",
    swept=("damping", "shaft_damping"),
)
def leaves_axis(ends: Ends | None = None) -> Measured:
    ends = simulated() if ends is None else ends
    ratio = on_plane(lambda disc: disc.friction_force / onset_load(disc))
    asked = (np.abs(ratio - 1.0) > MARGIN) & (ends != EndState.STUCK)
    right = (ratio < 1.0) == (ends == EndState.SELF_CENTRED)
    return answers_of(
        right[asked],
        UNDECIDED_IS_OPEN * (ends[asked] == EndState.UNDECIDED),
        may_be_open=int(np.count_nonzero(asked)) // 1000,
        note=f"{np.count_nonzero(asked)} of {ends.size} discs.",
    )


@STUDY.claim(
    "No motion ends on a steady whirl whose deviations had time to grow by exp(15)",
    equation="(19)–(21)",
    basis="reference",
    swept=("damping", "shaft_damping"),
)
def no_unstable_whirl(ends: Ends | None = None) -> Measured:
    ends = simulated() if ends is None else ends
    rows = slice(EVERY // 2, None, EVERY)
    rates = on_plane(growth, rows)
    unstable, left = rates * UNTIL > GROWN, ends[rows, rows]
    return answers_of(
        (left != EndState.WHIRL)[unstable],
        UNDECIDED_IS_OPEN * (left == EndState.UNDECIDED)[unstable],
        note=f"This applies to {np.count_nonzero(unstable)} of {rates.size} discs, every fifth in both directions; "
        "they have no other whirl.",
    )


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
    if "theory" not in data:
        return {}
    from matplotlib.colors import ListedColormap
    from matplotlib.lines import Line2D
    from matplotlib.patches import Patch

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
    plane.set(xlabel=axis(r"\beta", "N s/m"), xlim=_edges(DAMPING))
    plane.set(ylabel=axis("b", "N m s/rad"), ylim=_edges(SHAFT_DAMPING))
    shown = [
        Patch(facecolor=colour, edgecolor=GREY, label=words)
        for name, (words, colour) in LOOKS.items()
        if np.any(found["ends"] == EndState[name])
    ]
    lines = [Line2D([], [], color=one, linestyle=dash, label=kind) for kind, (one, dash) in CURVES.items()]
    plane.legend(handles=[*shown, *lines], loc="center left", bbox_to_anchor=(1.01, 0.5))
    return {"simulated-map": figure}


def _edges(values: FloatArray) -> tuple[float, float]:
    half = 0.5 * (values[1] - values[0])
    return float(values[0] - half), float(values[-1] + half)


STUDY.provides(figures=draw, curves=curves)
