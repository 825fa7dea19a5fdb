"""What the discs of the plane end in, by the compiled ensemble, and the curves of the stability map."""

from __future__ import annotations

import functools
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from compare.claims.paper_parameters import FIG11
from compare.claims.study import Data
from compare.studies.disc.simulated_map.parameters import (
    DAMPING,
    SHAFT_DAMPING,
    SIDE,
    START,
    TOLERANCE,
    UNTIL,
)
from compare.studies.toolkit.fig11_planes import KINDS, curves_in
from reference_model import whirls
from reference_model.systems import DiscOnDisc

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
