"""The surroundings of Fig. 11 by simulation: what thousands of discs end in, under the stability map's curves."""

from __future__ import annotations

import functools
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from compare.claims.error_estimates import WORKING
from compare.claims.measured import Measured, answers_of
from compare.claims.parameters import FIG11
from compare.claims.study import Data, Study
from compare.studies.toolkit.fig11_planes import KINDS, curves_in
from reference_model import onset_load, whirls
from reference_model.systems import DiscOnDisc

# --- The plane of discs that are simulated, and when their end is asked for.

SIDE = 60
"""Discs along each side of the plane."""

DAMPING, SHAFT_DAMPING = np.linspace(0.2, 2.0, SIDE), np.linspace(0.004, 0.026, SIDE)
"""In N s/m and N m s/rad."""

START = (1e-3, 0.0, 0.0, 0.0, 1e-3, 1.41)
"""Beside the axis: x, y, angle, vx, vy, spin."""

UNTIL = 12000.0
"""When the slowest have settled, in s."""

TOLERANCE = 10.0 * WORKING
"""Only where a motion ends is asked."""

MARGIN = 0.05
"""Of the friction force beside the onset, relative: nearer to it deviations neither grow nor die out in this time."""

EVERY = 5
"""Each fifth disc in both directions is asked for the eigenvalues of its whirl."""

GROWN = 15.0
"""Re λ times the duration from which on a whirl that is unstable is left: deviations have grown by exp(15)."""

UNDECIDED_IS_OPEN = 2.0
"""Error of a truth value, which is 1 or −1 as a margin, where the ensemble does not know the end."""


# --- What the discs of the plane end in, by the compiled ensemble, and the curves of the stability map.

Ends = NDArray[np.uint8]


def discs() -> list[DiscOnDisc]:
    """Return the discs, row by row of one shaft damping."""
    return [
        replace(FIG11, damping=beta, shaft_damping=b)
        for b in SHAFT_DAMPING.tolist()
        for beta in DAMPING.tolist()
    ]


@functools.cache
def simulated() -> Ends:
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


def growth(disc: DiscOnDisc) -> float:
    """Return the least growth rate in 1/s among the whirls of a disc; −inf without any."""
    found = whirls(disc)
    return min((max(value.real for value in each.eigenvalues) for each in found), default=-np.inf)


def curves() -> Data:
    """Return the ends, and the curves by kind."""
    return {
        f"{kind}/{i}": boundary.parameters
        for kind in KINDS
        for i, boundary in enumerate(curves_in("dampers", kind, "ring"))
    } | {"ends": simulated().astype(float)}


STUDY = Study.beside(
    __file__,
    "simulated-map",
    source=f"Fig. 11 with X0 = 0; β, b and the start {START} are ours",
    system=FIG11,
    only=("theory",),  # the plane is simulated by the ensemble of the reference alone
    seconds=2.0,
    words={"side": f"{SIDE}"},
)
STUDY.provides(curves=curves)


@STUDY.claim(
    "Motions that begin beside the axis come back to it where μN is below the onset, and leave it above",
    equation="(19)–(21)",
    note=f"Those within {MARGIN:g} of the onset's μN and those that stick are left out. By the compiled ensemble "
    f"to t = {UNTIL:g} s, which may leave one in a thousand undecided.",
    basis="reference",
    swept=("damping", "shaft_damping"),
)
def leaves_axis(ends: Ends | None = None) -> Measured:
    """Count the motions that stay at the axis where they should leave it, and the other way round."""
    from reference_model.ensemble import EndState

    ends = simulated() if ends is None else ends
    ratio = np.array([disc.friction_force / onset_load(disc) for disc in discs()]).reshape(ends.shape)
    asked = (np.abs(ratio - 1.0) > MARGIN) & (ends != EndState.STUCK)
    right = (ratio < 1.0) == (ends == EndState.SELF_CENTRED)
    return answers_of(
        right[asked],
        UNDECIDED_IS_OPEN * (ends[asked] == EndState.UNDECIDED),
        may_be_open=int(np.count_nonzero(asked)) // 1000,
        note=f"{np.count_nonzero(asked)} of {ends.size} discs.",
    )


@STUDY.claim(
    "No motion ends as a steady whirl that has had time to amplify a deviation by exp(15)",
    equation="(19)–(21)",
    basis="reference",
    swept=("damping", "shaft_damping"),
)
def no_unstable_whirl(ends: Ends | None = None) -> Measured:
    """Count the motions that end as a whirl that is unstable."""
    from reference_model.ensemble import EndState

    ends = simulated() if ends is None else ends
    rows = slice(EVERY // 2, None, EVERY)
    rates = np.array(
        [
            [growth(replace(FIG11, damping=beta, shaft_damping=b)) for beta in DAMPING[rows].tolist()]
            for b in SHAFT_DAMPING[rows].tolist()
        ]
    )
    unstable, left = rates * UNTIL > GROWN, ends[rows, rows]
    return answers_of(
        (left != EndState.WHIRL)[unstable],
        UNDECIDED_IS_OPEN * (left == EndState.UNDECIDED)[unstable],
        note=f"So it is of {np.count_nonzero(unstable)} of {rates.size} discs, each fifth in both directions: they "
        "have no other whirl.",
    )
