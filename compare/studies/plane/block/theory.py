"""Closed forms of a block on a plane at rest, from Newton's law and friction μN against the slip.

Lengths are in m, speeds in m/s, times in s; s is the way along a line, and v = ds/dt.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike
from scipy.special import lambertw

from compare.claims.study import Data
from compare.studies.plane.block.parameters import (
    ACROSS,
    DECELERATION,
    FRICTION,
    RELEASED,
    SPEED,
    SWINGING,
    SWINGS,
)
from reference_model.systems import FloatArray, PinOnDisc

STOPPING_TIME = SPEED / DECELERATION
STOPPING_DISTANCE = 0.5 * SPEED**2 / DECELERATION


def thrown(times: ArrayLike) -> FloatArray:
    """Return s and v of a block that only friction acts on, shape (n, 2): s = v₀t − gt²/2 until it rests."""
    t = np.minimum(times, STOPPING_TIME)
    return np.column_stack((SPEED * t - 0.5 * DECELERATION * t**2, SPEED - DECELERATION * t))


def half_swings(pin: PinOnDisc, start: float, times: ArrayLike) -> FloatArray:
    """Return s and v, shape (n, 2), of a block that is let go at rest at s = ``start`` > 0, s = 0 without a pull.

    It does not rest there: start > f = μN/C. In half swing n (from 0) it moves as cos kt about (−1)^n·f, with the
    amplitude start − (2n + 1)·f; it rests where the next amplitude would not be > 0.
    """
    k, f = pin.natural_frequency, pin.friction_force / pin.stiffness
    last = math.ceil(0.5 * (start / f - 1.0))
    t = np.minimum(times, last * math.pi / k)
    n = np.minimum(np.floor(k * t / math.pi), last - 1)
    amplitude = start - (2.0 * n + 1.0) * f
    return np.column_stack(((-1.0) ** n * f + amplitude * np.cos(k * t), -amplitude * k * np.sin(k * t)))


def pulled(pin: PinOnDisc, speed: float, stretch: float, times: ArrayLike) -> FloatArray:
    """Return s and v, shape (n, 2), of a block that slides towards the end of a spring stretched by ``stretch``.

    s = a·(1 − cos kt) + (v₀/k)·sin kt with a = stretch − μN/C, as long as it slides on.
    """
    k, t = pin.natural_frequency, np.asarray(times, dtype=float)
    a = stretch - pin.friction_force / pin.stiffness
    way = 2.0 * a * np.sin(0.5 * k * t) ** 2 + speed / k * np.sin(k * t)
    return np.column_stack((way, a * k * np.sin(k * t) + speed * np.cos(k * t)))


def across(times: ArrayLike) -> FloatArray:
    """Return the velocity along and across a constant pull μN, of a block thrown across it, shape (n, 2).

    Speed and velocity along the pull have a constant sum v₀, since friction takes from the one what the pull gives to
    the other. With the angle θ between both velocities and w = tan²(θ/2) they are v₀(1 ± w)/2, across there is
    v₀√w, and Newton's law for θ becomes w + ln w = 1 − 4gt/v₀.
    """
    w = lambertw(np.exp(1.0 - 4.0 * DECELERATION * np.asarray(times, dtype=float) / SPEED)).real
    return np.column_stack((0.5 * SPEED * (1.0 - w), SPEED * np.sqrt(w)))


def bend_by_spring(times: FloatArray) -> float:
    """Return how far in m/s the velocity of ``across`` can be off, since the spring's pull changes on the way.

    The pull changes by C·r, r being the way in space. Friction brings two motions no farther apart, since it grows
    against a larger slip, or turns with it: the difference of their velocities grows by no more than C·r/m, and r by
    no more than v₀.
    """
    return float(0.5 * ACROSS.stiffness / ACROSS.mass * SPEED * times[-1] ** 2)


def curves() -> Data:
    """Return swings in units of μN/C over kt/π, and velocities across a pull over time."""
    k, length = SWINGING.natural_frequency, FRICTION / SWINGING.stiffness
    swings, times = np.linspace(0.0, SWINGS + 1.0, 401), np.linspace(0.0, 2.0, 201)
    return {
        "half swings": swings,
        "way": half_swings(SWINGING, RELEASED * length, swings * math.pi / k)[:, 0] / length,
        "t": times,
        "velocity": across(times),
    }
