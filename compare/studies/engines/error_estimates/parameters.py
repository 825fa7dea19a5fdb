"""How many motions are drawn, from what, and what error bars must reach."""

from __future__ import annotations

import numpy as np

from compare.claims.error_estimates import TRUTH

MOTIONS = 360
"""Random motions for an engine, as many of every kind of problem that it can simulate."""

TOLERANCES = (1e-7, 1e-5)
"""Between these the tolerance of a motion is drawn."""

SEED = 20

LEAST_COVERAGE, MOST_OVER_ESTIMATE = 0.99, 30.0
"""What error bars must reach to mean something, in each kind of motion."""

SOURCE = (
    f"assumption: parameters, starts, times and tolerances (from {TOLERANCES[0]:g} to {TOLERANCES[1]:g}) "
    "are random"
)

KNOWN = 4.0 * np.finfo(float).eps
"""To this fraction of its largest number an exact motion is known: a sine, a root and a product are rounded as much.

A smaller true error is a coincidence of two roundings, and a ratio to it says nothing about an estimate.
"""

EXACT = 100.0 * TRUTH
"""Tolerance of the reference where there is no closed form: a thousandth of the smallest that is asked about."""

SMALL_OFFSET = 1e-7
"""X0/ρ_c of the response. What is of second order in it is as small beside it; errors are ~ tolerance/X0."""

SAMPLES = 16
"""Of a turn of the whirl, for its mean: exact for the two harmonics that there are."""

THROWS = ((0.7, 20.0), (0.8, 60.0), (1.3, 50.0), (1.5, 15.0))
"""J/(mR²) of the thrown rings and atan(W/U) in degrees at the start.

Not 1, where the end is in the integrals like exp(−A/t): they are good to 1e-11 there, and to 1e-13 elsewhere.
"""
