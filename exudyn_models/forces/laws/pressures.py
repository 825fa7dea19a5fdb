"""How an annulus is pressed together over its radius, as compiled code knows it.

The share of the load on the ring from r to r + dr is d(r)·dr, d ∝ p·r. It is a polynomial of s, from 0 at the inner
to 1 at the outer radius, and of such a degree that the rule over the radius in ``slip_potential`` integrates it to
all digits.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import cache
from typing import Literal

import numpy as np

from exudyn_models.forces.jit import compiled
from exudyn_models.forces.laws.calls import number_at
from reference_model.systems import FloatArray, finite_number

Pressure = Literal["uniform", "wear"] | Callable[[float], float]
"""Alike everywhere; ∝ 1/r, as linings come to be that wear evenly; or a function of r in m, of whatever unit."""

DEGREE = 7
"""With the cubes of ``slip_potential`` 3·7 + 2 = 23, which is what Gauss's rule of 12 points integrates."""

DEVIATION = 1e-6
"""Of the largest share, by which the polynomial may miss a function."""


def density_of(pressure: Pressure, inner: float, outer: float) -> int:
    """Return what stands for ``pressure`` in a ``Contact``: 0 if it is uniform, else minus an address.

    Raises ``ValueError`` if it is none, or no smooth one.
    """
    if isinstance(pressure, str) and pressure == "uniform":
        return 0
    if isinstance(pressure, str) and pressure == "wear":
        return -_kept((0.0,) * DEGREE + (1.0 / (outer - inner),)).ctypes.data
    if not callable(pressure):
        raise ValueError(
            f"pressure = {pressure!r}: it must be 'uniform', 'wear' or a function of the radius in m"
        )
    radii = np.linspace(inner, outer, 65)
    shares = np.array([_checked(pressure, float(radius)) for radius in radii]) * radii
    places = (radii - inner) / (outer - inner)
    found = np.polynomial.Chebyshev.fit(places, shares, DEGREE, domain=[0.0, 1.0])
    deviation = float(np.abs(found(places) - shares).max() / shares.max()) if shares.any() else math.inf
    if deviation > DEVIATION:
        raise ValueError(
            f"pressure: a polynomial of degree {DEGREE} in the radius misses it by {deviation:.1g} of its largest "
            "share; it must be a smooth function, > 0 somewhere; for one with a step add a contact on either side"
        )
    power = found.convert(kind=np.polynomial.Polynomial, domain=[0.0, 1.0], window=[0.0, 1.0])
    coefficients = np.zeros(DEGREE + 1)
    coefficients[: len(power.coef)] = power.coef
    total = float(power.integ()(1.0) - power.integ()(0.0)) * (outer - inner)
    return -_kept(tuple((coefficients[::-1] / total).tolist())).ctypes.data


def mean_radius_of(density: int, inner: float, outer: float) -> float:
    """Return ∫ r·d(r) dr in m."""
    coefficients = next(known for known in _KNOWN if known.ctypes.data == -density)
    share = np.polynomial.Polynomial(coefficients[::-1])
    lever = share * np.polynomial.Polynomial([inner, outer - inner])
    return float(lever.integ()(1.0) - lever.integ()(0.0)) * (outer - inner)


@compiled
def share_of_ring(density: int, radius: float, inner: float, outer: float) -> float:
    """Return d in 1/m at a radius in m."""
    place = (radius - inner) / (outer - inner)
    address = float(-density)
    share = number_at(address, 0)
    for i in range(1, DEGREE + 1):
        share = share * place + number_at(address, i)
    return float(share)


_KNOWN: list[FloatArray] = []
"""Coefficients from the highest power down, which stay where they are."""


@cache
def _kept(coefficients: tuple[float, ...]) -> FloatArray:
    _KNOWN.append(np.array(coefficients))
    return _KNOWN[-1]


def _checked(pressure: Callable[[float], float], radius: float) -> float:
    value = finite_number(f"pressure({radius:.6g} m)", pressure(radius))
    if value < 0.0:
        raise ValueError(f"pressure({radius:.6g} m) = {value:g}: it must be >= 0")
    return value
