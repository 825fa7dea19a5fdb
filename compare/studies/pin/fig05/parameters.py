"""Starts, lengths and tolerances with which the motions of Fig. 5 are followed."""

from __future__ import annotations

import numpy as np

from compare.claims.error_estimates import WORKING

SOURCE = "Fig. 5 and its printed initial conditions"

UNTIL = 400.0
"""Length of the runs in s; the paper does not print it. The slowest transients are down to 1e-8 by then."""

SAMPLES = 4001

FURTHER_TURNS = 20
"""Of the whirl, after a run; the last one is averaged."""

SLIDING_START = (0.9, 0.0, 0.0, 0.9)
"""A start near to the whirl, from which the pin slides all the time (our choice)."""

SLIDING_TIMES = np.linspace(0.0, 100.0, 101)

CAPTURE = 1e-6
"""How well the critical initial velocity is to be known, in m/s."""

AFTERWARDS = 220.0
"""In s: ``CAPTURE`` grows by a quarter in each turn, and must become of order one."""

SIDES_TOLERANCE = 1e-7

BESIDE = 2e-5
"""How far from that at ``SIDES_TOLERANCE`` the critical initial velocity is looked for at smaller ones, in m/s."""

RUNS_TOLERANCE = 5.0 * WORKING
"""Of the runs of Fig. 5."""

CRITICAL_TOLERANCE = WORKING / 5.0
"""A smoothed law's critical velocity is off by some hundred times as much."""
