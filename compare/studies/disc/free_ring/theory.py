"""A ring thrown on a table at rest: the limits of its motion, beside the integrals of ``toolkit.free_bodies``.

Near to the ratio 1 of c = 1 the slopes of friction grow like a logarithm: Wδ' = −(2/π)·g·δ·L, L = ln(8/|δ|) − 2, and
W = (2/π)·g·t with the remaining time t, so that L = A/t: |δ| = 8·e^(−2)·exp(−A/t), faster than any power.

There is a δ* for 1/2 < c < 2. For c < 1/2 spinning dies away before sliding, W/U ~ t^(1/(2c) − 1) with the remaining
time t, because F → 1 and G → W/(2U); for c > 2 sliding does, U/W ~ t^(c/2 − 1). At the limits themselves the ratio
goes there too, but more slowly than any power.

Symbols and units are those of ``toolkit.free_bodies``.
"""

from __future__ import annotations

import functools
import math

import numpy as np
from numpy.typing import ArrayLike

from compare.claims.study import Data
from compare.studies.disc.free_ring.parameters import DECELERATION, Throw
from compare.studies.toolkit.free_bodies import NEAR, Slowing
from reference_model.systems import FloatArray


def nearness(delta: ArrayLike) -> FloatArray:
    """Return L = ln(8/|δ|) − 2, how near δ has come to zero."""
    with np.errstate(divide="ignore"):  # an engine may reach zero to rounding
        return np.asarray(math.log(8.0) - 2.0 - np.log(np.abs(delta)))


def deviation(nearness: ArrayLike) -> FloatArray:
    """Return |δ| of a ``nearness``."""
    return np.asarray(8.0 * np.exp(-2.0 - np.asarray(nearness)))


def approach_constant(sliding: float, rim: float, near: float = NEAR) -> float:
    """Return A in s of the approach to the ratio 1 for c = 1, from U > 0 and W > 0 in m/s; taken at |δ| = near."""
    return float(Slowing(1.0).stop(sliding, rim, near).left * nearness(near))


@functools.cache
def expected_approach(throw: Throw, near: float = NEAR) -> float:
    """Return A in s."""
    return approach_constant(throw.sliding, abs(throw.rim), near) / DECELERATION


def curves() -> Data:
    """Return the terminal ratio over J/(mR²), between the limits."""
    inertias = 0.5 * 4.0 ** np.linspace(0.002, 0.998, 101)
    ratios = [math.exp(Slowing(float(inertia)).terminal) for inertia in inertias]
    return {"inertia": inertias, "ratio": np.array(ratios)}
