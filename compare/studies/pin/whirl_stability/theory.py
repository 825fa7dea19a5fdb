"""Eq. 12 to 16 over speed and damping, and a deviation according to (12)."""

from __future__ import annotations

import functools
from dataclasses import replace

import numpy as np
from scipy.linalg import expm

from compare.claims import WORKING, Data
from compare.claims.linearised_flow import eigenvalues_with_rounding, real_and_imaginary
from compare.claims.parameters import CENTRED
from reference_model.formulas.pin import variational_matrix
from reference_model.steady.stability import whirl_eigenvalues
from reference_model.systems import FloatArray, PinOnDisc

# --- The pin of Fig. 4 without its offset, and parameters of the measurements

PIN = CENTRED
SOURCE = "Fig. 4 with X0 = 0, as (11)–(16) assume; the values of ω are our choice"
K = PIN.natural_frequency

SPEEDS = (1.1, 1.5, 4.0)
"""ω in rad/s of the long simulations."""

DISPLACED = 1.1
"""Radius at their start, relative to (11)."""

DURATION = 460.0
"""Duration in s; the slowest deviation falls to 1e-10 of its initial value."""

DELAY = 40.0
"""Final part of a run in s, which yields the estimate of the remaining transient."""

TOLERANCE = WORKING / 5
"""Tolerance of the claims on radius and frequency of the circle (11), whose resolution is 1e-9."""

STARTS = (0.5, 0.8, 0.9, 1.2, 1.5, 3.0)
"""ω in rad/s of the starts on the circle (11), below and above k."""

INTERVAL = 0.01
"""Interval in s between the states for the change of the angular momentum."""

FORWARD = np.array([-25.0, 48.0, -36.0, 16.0, -3.0]) / 12.0
"""Weights of the one-sided difference of fourth order."""

CAUGHT = 18.0
"""Duration in s; at its end, a pin that left the circle below k sticks to the disc."""

CAUGHT_TOLERANCE = 1e-7

POINTS = (
    *((speed, PIN.damping) for speed in (1.05, 1.1, 1.5, 2.5, 5.0)),
    *((1.5, damping) for damping in (0.5, 2.0)),
)
"""ω in rad/s and β in N s/m for the eigenvalues."""

FLOW_DURATION = 0.5
"""Duration in s of the simulations for eigenvalues."""

DEVIATION = 1e-3
"""Amplitude of the decaying deviation, relative to the radius (11)."""

DEVIATION_TIMES = np.linspace(0.0, 60.0, 301)

RATIOS = np.asarray((np.arange(225) + 0.5) / 75.0, dtype=float)
DAMPINGS = np.geomspace(0.03, 10.0, 121)
"""ω/k and β/(mk) of the grid for the comparison of (14) to (16) with eigenvalues, including ω < k."""


def pin_at(speed: float, damping: float = PIN.damping) -> PinOnDisc:
    """Return the pin of this study at another disc speed in rad/s and damping in N s/m."""
    return replace(PIN, disc_speed=speed, damping=damping)


def on_circle(pin: PinOnDisc, scale: float = 1.0) -> FloatArray:
    """Return the state on the circle (11), enlarged by ``scale``. For ω < k, the circle is not a motion."""
    radius = scale * pin.friction_force / (pin.damping * K)
    return np.array([radius, 0.0, 0.0, K * radius])


def curves() -> Data:
    speeds = K * (1.0 + np.geomspace(0.01, 6.0, 240))
    return {
        "speed": speeds,
        "eigenvalue": real_and_imaginary([whirl_eigenvalues(pin_at(speed))[1:] for speed in speeds]),
        "ratio": RATIOS,
        "damping": DAMPINGS,
        "largest": largest_real_parts()[0].reshape(len(DAMPINGS), len(RATIOS)) / K,
        "deviation_time": DEVIATION_TIMES,
        "deviation": linear_deviation(DEVIATION_TIMES),
    }


def linear_deviation(times: FloatArray) -> FloatArray:
    """Return ξ/a by (12), shape (n,), from the start ξ = a, ξ̇ = ka, η = 0."""
    start = np.array([1.0, K, 0.0])
    step = expm(variational_matrix(PIN) * (times[1] - times[0]))
    states = [start]
    for _ in times[1:]:
        states.append(step @ states[-1])
    return np.array(states)[:, 0]


@functools.cache
def grid() -> tuple[PinOnDisc, ...]:
    return tuple(pin_at(K * ratio, PIN.mass * K * damping) for damping in DAMPINGS for ratio in RATIOS)


@functools.cache
def largest_real_parts() -> tuple[FloatArray, FloatArray]:
    """Return the largest real part in 1/s of the roots of (13) at each point of the grid, and its rounding error."""
    values, rounding = eigenvalues_with_rounding([variational_matrix(pin) for pin in grid()])
    worst = np.argmax(values.real, axis=1)[:, np.newaxis]
    largest, error = (np.take_along_axis(each, worst, axis=1)[:, 0] for each in (values.real, rounding))
    return largest, error
