"""Modelica.Mechanics.Rotational.Examples.CoupledClutches, as its sources have it, and how finely it is run."""

from __future__ import annotations

import math

import numpy as np

INERTIAS = (1.0, 1.0, 1.0, 1.0)
"""In kg m²."""

SPEED = 10.0
"""Of the first rotor at the start in rad/s; the others rest."""

TORQUE, FREQUENCY = 10.0, 5.0
"""Amplitude in N m and frequency in Hz of what acts on the first rotor."""

RADIUS, COEFFICIENT, STATIC_RATIO, LOAD = 1.0, 0.5, 1.1, 20.0
"""The clutches' cgeo in m, their coefficient of sliding friction, their peak, and the largest load in N."""

OPENS = 0.2
"""Frequency in Hz of the cosine by which the load of the first clutch falls, and is 0 from its first root on."""

OPEN_FROM = 0.25 / OPENS
ENGAGED_FROM = (0.4, 0.9)
"""In s, of the second and the third clutch, with the whole load at once."""

BREAKS = (*ENGAGED_FROM, OPEN_FROM)
UNTIL = 1.5
"""In s."""

SHOWN = np.array([0.05 * i for i in range(1, 30) if i != 20]).round(2)
"""When speeds are compared, in s: not at 1 s, 0.3 ms before a clutch lets go, but 5 ms from any event or more."""

EPSILONS = 2.5e-4 * np.array([1.0, 2.0, 4.0, 8.0])
"""In m/s, at the radius of 1 m: rad/s."""

TOLERANCE = 1e-9
"""Of explicit steps, in rad/s: a millionth of what the smallest ε changes."""

SMALL_EPSILON = 1e-5
"""In m/s, of implicit steps: it changes a tenth of what the shortest of ``STEPS`` does, or less."""

STEPS = 1.25e-4 * np.array([1.0, 2.0, 4.0, 8.0])
"""Of implicit runs, in s."""

ALL_SLIP_UNTIL = 0.7
"""In s: a time of ``SHOWN`` up to which all clutches that are closed slip."""

LETS_GO_FROM = 0.82
"""In s, after the second clutch holds and the first one does, and before that lets go."""

NUMERICAL_DAMPING = 0.8
"""The spectral radius of generalised-α: below 1, so that what a jump of friction excites dies away."""

BRISTLES = ((5e-5, 6.25e6), (1e-4, 1.5625e6), (2e-4, 3.90625e5))
"""Step in s and bristle stiffness in N m/rad of Exudyn's own connector: all errors double from one to the next.

The bristle's damping in N m s/rad is twice the root of its stiffness, the critical one of a rotor of 1 kg m².
"""

DECAY = 1e-4
"""In rad/s: over which slip static friction of that connector falls to the sliding one."""

PUBLISHED_TOLERANCE = 1e-6
"""Relative, with which the published result was integrated, by DASSL."""

ACCUMULATED = 10.0
"""By how much larger than the tolerance, which is that of a step, the error of the whole motion is taken to be."""


def first_load(time: float) -> float:
    """Return the load of the first clutch in N."""
    return LOAD * max(0.0, math.cos(2.0 * math.pi * OPENS * time)) if time < OPEN_FROM else 0.0


def second_load(time: float) -> float:
    """Return the load of the second clutch in N."""
    return LOAD if time >= ENGAGED_FROM[0] else 0.0


def third_load(time: float) -> float:
    """Return the load of the third clutch in N."""
    return LOAD if time >= ENGAGED_FROM[1] else 0.0


LOADS = (first_load, second_load, third_load)


def torque(time: float) -> float:
    """Return the torque on the first rotor in N m."""
    return TORQUE * math.sin(2.0 * math.pi * FREQUENCY * time)
