"""The disc whose surroundings are mapped, what is simulated there, and how closely the curves are looked at."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from compare.claims.error_estimates import WORKING
from compare.claims.paper_parameters import FIG11
from reference_model.systems import DiscOnDisc

DISC = FIG11
K = DISC.natural_frequency

SOURCE = "Fig. 11 with X0 = 0; the ranges of the map are ours"
ONE_AT_A_TIME = "Fig. 11 with X0 = 0; one parameter at a time"

BOTH_LAWS = "(19), (20), (23)"
"""Equations of what is claimed of the ring and of (23)."""

LINES = (
    ("load", "disc_speed", 1.5),
    ("dampers", "damping", 0.8),
    ("speeds", "disc_speed", 1.3),
    ("inertia", "polar_inertia", 0.4),
)
"""Lines in planes on which both sides of the Hopf curves of the ring are simulated."""

ASIDE = 0.01
"""How far from the curves, relative."""

DEVIATION = 0.02
"""Of the whirl at the start, in units of the distance to where a point of the ring rests."""

FLOW_TOLERANCE = 100 * WORKING
"""Of the simulations that are subtracted from each other: their differences are small."""

STUCK = 60.0
"""In s, for which a disc that sticks on the axis is watched: nothing changes there, but for an engine's creep."""

OUTSIDE, BEYOND = 0.003, 0.02
"""How far from the Hopf curves, relative, the modulated cycle is beside the whirl, and is gone."""

BESIDE = (1.002, 1.0, 1.0, 1.0, 1.002, 1.0)
"""Factors on x, y, angle, vx, vy, spin of a whirl that lead a little off it."""

ON_CYCLE = (0.035, 0.0, 0.0, 0.0, 0.035, 1.385)
"""State x, y, angle, vx, vy, spin near to where the radius of the modulated cycle is largest."""

LOADS = (
    *(0.0195, 0.0208, 0.0211, 0.0214, 0.0217, 0.0221, 0.0225),
    *(0.0232, 0.024, 0.0247, 0.0251, 0.0255, 0.028),
)
"""In N, of the bifurcation diagram."""

SLOW_LOADS = (0.0208, 0.0211)
"""Those at which the whirl is stable, but disturbances of it fall slowly."""

FAR_FROM_KINK = 0.02
"""Of |U/W − 1|: nearer to where a point of the ring rests, the expansion about the whirl says nothing."""

ONSET_SPEEDS = (1.05, 1.2, 1.4, 1.5, 2.0, 3.0)
"""ω in rad/s at which the onset is found by its eigenvalues."""

NEAR = 1e-3
"""Relative distance from a border at which stability is that of either side."""

STATE_ROUNDING = 4.0 * np.finfo(float).eps
"""Relative, of the spin of a whirl that is given by its α."""

UNSTABLE_LOADS = (0.3, 0.7)
"""Friction forces between the fold and the Hopf point of (23), as fractions."""

BESIDE_LARGEST = ((1.1, 1.0, 1.0, 1.0, 1.1, 1.0), (1.5, 1.0, 1.0, 1.0, 1.5, 1.0))
"""Factors on the state of the larger whirl there."""


def at(**changes: Any) -> DiscOnDisc:
    """Return the disc of Fig. 11 with some other parameters."""
    return replace(DISC, **changes)
