"""A ring thrown on a table at rest: the limits of its motion, beside the integrals of ``toolkit.free_bodies``.

Near to the ratio 1 of c = 1 the slopes of friction grow like a logarithm: Wδ' = −(2/π)·g·δ·L, L = ln(8/|δ|) − 2, and
W = (2/π)·g·t with the remaining time t, so that L = A/t: |δ| = 8·e^(−2)·exp(−A/t), faster than any power.

There is a δ* for 1/2 < c < 2. For c < 1/2 spinning dies away before sliding, W/U ~ t^(1/(2c) − 1) with the remaining
time t, because F → 1 and G → W/(2U); for c > 2 sliding does, U/W ~ t^(c/2 − 1). At the limits themselves the ratio
goes there too, but more slowly than any power.

Symbols and units are those of ``toolkit.free_bodies``.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike
from scipy.optimize import brentq

from compare.claims.answers import holds
from compare.claims.claim import Claim, ErrorBudget
from compare.claims.parameters import at_each
from compare.claims.study import Findings
from compare.studies.toolkit.free_bodies import LARGEST, NEAR, Slowing
from reference_model.contact.annulus import Annulus
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


EXISTS = "Both speeds end in a finite ratio for mR²/2 < J < 2mR², and for no other J"
PUBLISHED = "The same balance on the whole face of a uniform disc is the published ratio"

INERTIAS = (0.1, 0.3, 0.45, 0.499, 0.501, 0.55, 0.7, 1.3, 1.7, 1.9, 1.99, 2.01, 2.2, 3.0, 10.0)


def theory() -> Findings:
    """See for which J there is a terminal ratio, compute it, and that of a uniform disc."""
    inertias = 0.5 * 4.0 ** np.linspace(0.002, 0.998, 101)
    ratios = [math.exp(Slowing(float(inertia)).terminal) for inertia in inertias]
    return Findings((_existence(), _uniform_disc()), {"inertia": inertias, "ratio": np.array(ratios)})


def _existence() -> Claim:
    def has_ratio(inertia: float) -> bool:
        slowing = Slowing(inertia)
        return slowing.unevenness(-LARGEST) < 0.0 < slowing.unevenness(LARGEST)

    return Claim(
        EXISTS,
        equation="(20)",
        engine="theory",
        **holds([has_ratio(inertia) == (0.5 < inertia < 2.0) for inertia in INERTIAS]),
        parameters={},
        source="assumption: J/(mR²) from 0.1 to 10; limits as Goyal, Ruina and Papadopoulos 1991",
        note=f"Whether the closed form of (20) has a balance of both decelerations, or has none, for "
        f"{at_each('J/mR²', INERTIAS)}.",
    )


def _uniform_disc() -> Claim:
    face = Annulus(0.0, 1.0, rings=16)

    def unevenness(ratio: float) -> float:
        """Return q for J = mR²/2."""
        resistance, moment = face.shares(ratio, 1.0)
        return resistance / ratio - moment / 0.5

    return Claim(
        PUBLISHED,
        equation="(20)",
        engine="theory",
        predicted=0.653,
        measured=brentq(unevenness, 0.1, 0.9, xtol=1e-12),
        # The digits that are published.
        budget=ErrorBudget(1e-10, model=5e-4, resolution=1e-3),
        parameters={},
        source="Farkas, Bartels, Unger and Wolf 2003; Weidman and Malhotra 2007",
        note="Sliding over rim speed in the end, by the mean of the closed form of (20) over all radii; J = mR²/2. "
        "Model error: half of the last digit that is published.",
    )
