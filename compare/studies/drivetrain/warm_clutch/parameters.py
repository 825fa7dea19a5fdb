"""A clutch that is engaged once, and one that slips on; both warm up, and their friction fades."""

from __future__ import annotations

import numpy as np

INERTIAS = (0.2, 1.5)
"""Of engine and vehicle in kg m², the vehicle as the clutch sees it."""

SLIP = 200.0
"""Between them at the start in rad/s."""

RADIUS, LOAD = 0.1, 3000.0
"""Of the ring in m, and N."""

COEFFICIENT, FADE = 0.33, 2e-3
"""Of friction at the temperature of the surroundings, and the share of it that goes with each K above."""

CAPACITY, SURROUNDINGS = 60.0, 20.0
"""Of the linings in J/K, and °C."""

EPSILON = 1e-2
"""In m/s: 0.1 rad/s."""

ENGAGED = (np.arange(1.0, 18.0) * 0.02).round(2)
"""When the engaged clutch is compared, in s: it slips until then and for a while."""

UNTIL = 0.6
"""When it holds, in s."""

CONDUCTANCE = 20.0
"""Of the clutch that slips on, in W/K; the engaged one keeps its heat until its slip has ended."""

SLOW_SLIP, HEAVY = 20.0, 1e12
"""The slip of the clutch that slips on in rad/s, held by rotors that are as heavy as this in kg m²."""

NEARLY_HOLDS = 1.0
"""Slip in rad/s, ten times that of ε, at which the time of an engagement is taken."""

HELD = np.arange(1.0, 21.0) * 2.0
"""When it is compared, in s."""

TOLERANCE = 1e-10
"""Of Exudyn's explicit steps, in rad, rad/s, K and J."""

LEFT_OUT = 2e-13
"""Of the span of a run, by `solve_dynamic` at each of its breaks."""
