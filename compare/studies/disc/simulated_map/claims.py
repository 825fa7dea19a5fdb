"""The surroundings of Fig. 11 by simulation: what thousands of discs end in, under the stability map's curves."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from compare.claims.answers import holds
from compare.claims.claim import Claim
from compare.claims.paper_parameters import FIG11
from compare.claims.parameters import parameters_of
from compare.claims.study import Data, Findings, Study
from compare.engines import Engine
from compare.figures import BLACK, GREEN, GREY, ORANGE, PURPLE, SKY, axis, new_figure
from compare.studies.disc.stability_map.theory import FINE, KINDS, LAWS, PLANES
from reference_model import onset_load, whirls
from reference_model.steady.bifurcation_curves import boundaries
from reference_model.systems import DiscOnDisc, FloatArray

if TYPE_CHECKING:
    from matplotlib.figure import Figure

SIDE = 80
"""Discs along each side of the plane."""

DAMPING, SHAFT_DAMPING = np.linspace(0.2, 2.0, SIDE), np.linspace(0.004, 0.026, SIDE)
"""In N s/m and N m s/rad."""

START = (1e-3, 0.0, 0.0, 0.0, 1e-3, 1.41)
"""Beside the axis: x, y, angle, vx, vy, spin."""

UNTIL, TOLERANCE = 12000.0, 1e-8
"""When the slowest have settled, in s."""

MARGIN = 0.05
"""Of the load beside the onset, relative: nearer to it deviations neither grow nor die out in this time."""

EVERY = 5
"""Each fifth disc in both directions is asked for the eigenvalues of its whirl."""

GROWN = 15.0
"""Re λ times the duration from which on a whirl that is unstable is left: deviations have grown by exp(15)."""

UNDECIDED_IS_OPEN = 2.0
"""Error of a truth value, which is 1 or −1 as a margin, where the ensemble does not know the end."""

LEAVES = (
    "Motions that begin beside the axis come back to it where the load is below the onset, and leave it above"
)
NO_WHIRL = (
    "No motion ends as a steady whirl where an eigenvalue of the whirl has grown a deviation by exp(15)"
)

LOOKS = {
    "UNDECIDED": ("undecided", "#ffffff"),
    "SELF_CENTRED": ("rotation about the axis", "#f3ead7"),
    "WHIRL": ("whirl", SKY),
    "MODULATED": ("modulated cycle", ORANGE),
    "STUCK": ("sticks", GREY),
}

CURVES: dict[str, tuple[str, Any]] = {
    "onset": (BLACK, "-"),
    "Hopf": (GREEN, "-"),
    "fold": (PURPLE, (0.0, (5.0, 2.0))),
}


def discs() -> list[DiscOnDisc]:
    """Return the discs, row by row of one shaft damping."""
    return [
        replace(FIG11, damping=beta, shaft_damping=b)
        for b in SHAFT_DAMPING.tolist()
        for beta in DAMPING.tolist()
    ]


def simulated() -> NDArray[np.uint8]:
    """Return what the discs end in, shape (SIDE, SIDE)."""
    from reference_model.ensemble import simulate_ensemble

    beta, b = np.meshgrid(DAMPING, SHAFT_DAMPING)
    found = simulate_ensemble(
        FIG11,
        START,
        duration=UNTIL,
        tolerance=TOLERANCE,
        parameters={"damping": beta.ravel(), "shaft_damping": b.ravel()},
    )
    return found.end.reshape(SIDE, SIDE)


def measure(engine: Engine) -> Findings:
    """Measure nothing: the plane is simulated by the ensemble of the reference only."""
    return Findings()


def theory() -> Findings:
    """Simulate the plane, and compare with onset and eigenvalues."""
    ends = simulated()
    curves: Data = {
        f"{kind}/{i}": boundary.parameters
        for kind in KINDS
        for i, boundary in enumerate(boundaries(PLANES["dampers"], kind, LAWS["ring"], step=FINE))
    }
    return Findings((onset_claim(ends), whirl_claim(ends)), curves | {"ends": ends.astype(float)})


def onset_claim(ends: NDArray[np.uint8]) -> Claim:
    """Count the motions that stay at the axis where they should leave it, and the other way round."""
    from reference_model.ensemble import EndState

    ratio = np.array([disc.friction_force / onset_load(disc) for disc in discs()]).reshape(ends.shape)
    asked = (np.abs(ratio - 1.0) > MARGIN) & (ends != EndState.STUCK)
    right = (ratio < 1.0) == (ends == EndState.SELF_CENTRED)
    return Claim(
        LEAVES,
        equation="(19)–(21)",
        engine="theory",
        **holds(
            right[asked],
            UNDECIDED_IS_OPEN * (ends[asked] == EndState.UNDECIDED),
            may_be_open=int(np.count_nonzero(asked)) // 1000,
        ),
        parameters=parameters_of(FIG11, without=("damping", "shaft_damping")),
        source=f"Fig. 11 with X0 = 0; β, b and the start {START} are ours",
        note=f"{np.count_nonzero(asked)} of {ends.size} discs, those within {MARGIN:g} of the onset's load and those "
        f"that stick left out. By the compiled ensemble to t = {UNTIL:g} s, which may leave one in a thousand "
        "undecided.",
        basis="reference",
    )


def whirl_claim(ends: NDArray[np.uint8]) -> Claim:
    """Count the motions that end as a whirl that is unstable."""
    from reference_model.ensemble import EndState

    rows = slice(EVERY // 2, None, EVERY)
    growth = np.array(
        [
            [_growth(replace(FIG11, damping=beta, shaft_damping=b)) for beta in DAMPING[rows].tolist()]
            for b in SHAFT_DAMPING[rows].tolist()
        ]
    )
    unstable, left = growth * UNTIL > GROWN, ends[rows, rows]
    return Claim(
        NO_WHIRL,
        equation="(19)–(21)",
        engine="theory",
        **holds(
            (left != EndState.WHIRL)[unstable], UNDECIDED_IS_OPEN * (left == EndState.UNDECIDED)[unstable]
        ),
        parameters=parameters_of(FIG11, without=("damping", "shaft_damping")),
        source=f"Fig. 11 with X0 = 0; β, b and the start {START} are ours",
        note=f"So it is of {np.count_nonzero(unstable)} of {growth.size} discs, each fifth in both directions: "
        "they have no other whirl.",
        basis="reference",
    )


def _growth(disc: DiscOnDisc) -> float:
    """Return the least growth rate in 1/s among the whirls of a disc; −inf without any."""
    found = whirls(disc)
    return min((max(value.real for value in each.eigenvalues) for each in found), default=-np.inf)


def draw(data: Mapping[str, Data]) -> dict[str, Figure]:
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
    plane.plot(FIG11.damping, FIG11.shaft_damping, "+", color=BLACK, markersize=9.0)
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


STUDY = Study(
    name="simulated-map",
    title="The surroundings of Fig. 11 by simulation",
    paper="Not in the paper. The stability map says by eigenvalues where rotation, whirl and modulated cycle are "
    "stable; here discs of a whole plane are simulated, from a start beside the axis, until their end is certain.",
    by_hand=measure,
    draw=draw,
    theory=theory,
    figures={
        "simulated-map": f"Ends of {SIDE} × {SIDE} discs that start beside the axis, and the curves of the stability "
        "map, which are not drawn from them. Cross: Fig. 11. Where a curve is crossed and the ends do not "
        "change, two kinds of motion exist side by side."
    },
    section="The friction disc",
    only=("theory",),
    seconds=15.0,
)
