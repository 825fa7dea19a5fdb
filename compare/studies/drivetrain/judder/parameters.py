"""A clutch that slips at a constant speed, its disc on a torsional spring, and how friction falls with the slip."""

from __future__ import annotations

import math

import numpy as np

INERTIA, STIFFNESS, DAMPING = 0.02, 300.0, 0.1
"""Of the disc in kg m², of its shaft in N m/rad and N m s/rad: 19 Hz, with 2 % of critical damping."""

SPEED = 50.0
"""Of the driving side in rad/s, that nothing slows."""

DRIVE_INERTIA = 1e12
"""Its inertia in kg m²: the moment of friction takes 1e-11 rad/s² off it."""

RADIUS, LOAD, COEFFICIENT = 0.1, 1000.0, 0.5
"""Of the contact in m, in N, and the coefficient at the slip of the steady state."""

STEADY_SLIP = RADIUS * SPEED
"""In m/s: the shaft is wound up and at rest."""

ONSET = DAMPING / (RADIUS**2 * LOAD)
"""In s/m: by how much the coefficient falls with the slip where friction feeds what the damper takes."""

GRADIENTS = ONSET * np.array([-1.0, 0.0, 0.5, 0.9, 1.1, 2.0, 4.0])
"""In s/m: the fall of the coefficient with the slip; it rises with it where negative."""

EPSILON = 1e-4
"""In m/s: a fifty-thousandth of the steady slip. Where there is no stick it changes nothing."""

PERTURBED = 0.1
"""Speed of the disc at the start in rad/s, added to a rest under 50 N m."""

PERIODS = 10
PERIOD = 2.0 * math.pi * math.sqrt(INERTIA / STIFFNESS)
"""In s, without damping."""

TIMES = np.linspace(0.0, PERIODS * PERIOD, 41)

GROWN, PUSHED = 2.0 * ONSET, 40.0
"""Gradient in s/m, and speed of the disc at the start in rad/s, with which judder soon ends in stick.

Growth is so slow that the disc, when it is as fast as the drive, is still within what friction can hold; six times
beyond the onset the spring throws it forward, past the drive.
"""

GROWN_UNTIL = 0.6
"""In s: eleven periods."""

TOLERANCE = 1e-10
"""Of explicit steps, in rad and rad/s."""

STICKING_TOLERANCE = 1e-8
"""The same where the disc sticks: less is beyond what the steps resolve there."""
