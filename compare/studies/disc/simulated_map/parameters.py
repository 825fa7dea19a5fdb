"""The plane of discs that are simulated, and when their end is asked for."""

from __future__ import annotations

import numpy as np

from compare.claims.error_estimates import WORKING

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
