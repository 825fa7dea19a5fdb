"""The radius (9) and the turn until release (7) over the disc speed, and the speed of the largest radius."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from compare.claims import Data
from compare.claims.parameters import FIG4
from compare.studies.toolkit.pins import safest_angle
from reference_model.formulas.pin import resonant_disc_speed, sticking_radius, turn_until_release
from reference_model.systems import FloatArray, PinOnDisc

# --- The pin of Fig. 4, and starts of stick and of release

PIN = FIG4
SOURCE = "Fig. 4, whose friction force is above C·X0; the values of ω are our choice"
RESONANCE = resonant_disc_speed(PIN)

SPEEDS = (0.4, 0.7, RESONANCE, 1.4, 2.5)
"""ω in rad/s of the starts inside and outside the radius (9)."""

INSIDE = 0.98
OUTSIDE = (1.02, 1.5)
"""Radii of the starts, relative to (9)."""

CREEP = 1e-2
"""Relative displacement of a stuck pin above which it is uncertain whether it sticks."""

CREEP_AT_EDGE = 0.05 * (OUTSIDE[0] - 1.0)
"""The same for a pin just outside: creep by this fraction of its distance to the edge may hold it for too long."""

LATEST = 1.1
"""Duration for a pin outside, relative to the time that (7) predicts."""

REVOLUTIONS = 2.0
"""Duration for a pin inside; the holding force has the period of one revolution."""

SEARCHED = (0.9, 1.0, 1.1, 0.4, 2.0)
"""ω in rad/s for the search of the largest sticking radius; the first three are near the resonance."""

BRACKET = (0.03, 4.0)
"""Initial bracket of the search, relative to X0. It does not use (9), so it cannot favour it."""

PRECISION = 6e-5
"""Relative accuracy of this search."""

SEARCH_TOLERANCE = 1e-7

TOLERANCE = 3e-8
"""Moderate, because the cost of stick rises as a regularised law approaches Coulomb's."""

DAMPINGS = np.geomspace(0.01, 1.3, 15)
"""β in N s/m for the search of the largest radius (9)."""

FAST = (10.0, 30.0, 100.0)
"""ω in rad/s far above the resonance."""


def pin_at(speed: float) -> PinOnDisc:
    """Return the pin of this study at another disc speed in rad/s."""
    return replace(PIN, disc_speed=speed)


def curves() -> Data:
    """Return the radius (9) in m, and the turns in rad until release, over ω in rad/s."""
    speeds = np.unique(np.concatenate((np.linspace(0.15, 2.6, 200), RESONANCE + np.linspace(-0.2, 0.2, 81))))
    return {
        "speed": speeds,
        "radius": np.array([sticking_radius(pin_at(speed)) for speed in speeds]),
        "turn": predicted_turns(speeds),
    }


def predicted_turns(speeds: ArrayLike) -> FloatArray:
    """Return the turns in rad that (7) predicts, shape (n, 2), for ``speeds`` in rad/s, shape (n,)."""
    return np.array(
        [
            [turn_until_release(pin, share * sticking_radius(pin), safest_angle(pin)) for share in OUTSIDE]
            for pin in map(pin_at, np.asarray(speeds, dtype=float).tolist())
        ]
    )


def vertex(s: FloatArray, values: FloatArray, relative_error: FloatArray) -> tuple[float, float]:
    """Return the square root of the vertex of the parabola through three points 1/A² over s = ω², and its error.

    ``relative_error`` is the error of the radii A. If a radius is missing, the vertex is missing; it is open if the
    errors of all missing radii are infinite.
    """

    def found(values: FloatArray) -> float:
        square, linear, _ = np.polyfit(s, values, 2)
        return math.sqrt(max(-linear / (2.0 * square), 0.0))

    missing = ~np.isfinite(values)
    if np.any(missing):
        return math.nan, math.inf if np.all(np.isinf(relative_error[missing])) else 0.0
    middle = found(values)
    if not np.all(np.isfinite(relative_error)):
        return middle, math.inf
    shifts = [
        abs(found(values * (1.0 + 2.0 * relative_error * (np.arange(3) == i))) - middle) for i in range(3)
    ]
    return middle, sum(shifts)


def top(pin: PinOnDisc, speed: float, width: float) -> float:
    """Return ω in rad/s at the vertex of the parabola through the radius (9) at three speeds around ``speed``."""
    step = width * speed
    # The nodes are not symmetric, so the result does not contain its own prediction.
    nodes = speed + step * np.array([-0.6, 0.4, 1.4])
    low, middle, high = (sticking_radius(replace(pin, disc_speed=node)) for node in nodes)
    return float(nodes[1] + 0.5 * step * (low - high) / (low - 2.0 * middle + high))
