"""Pressure of an annulus as a function of the radius, for compiled code.

The share of the load on the ring from r to r + dr is d(r)·dr, d ∝ p·r. It is a polynomial in s, 0 at the inner and 1
at the outer radius, that the quadrature in ``slip_potential`` integrates exactly.
"""

import math
from collections.abc import Callable
from typing import Literal

import numpy as np

from exudyn_models.forces.jit import compiled
from exudyn_models.forces.laws.tables import kept, kept_at, number_at
from reference_model.systems import finite_number, require_callable, shown

Pressure = Literal["uniform", "wear"] | Callable[[float], float]
""""uniform"; "wear", ∝ 1/r as in evenly worn linings; or a function of r in m, in any unit."""

DEGREE = 7
"""Degree of the polynomial: with the cubes of ``slip_potential`` 3·7 + 2 = 23, exact for a 12-point Gauss rule."""

DEVIATION = 1e-6
"""Largest deviation of the polynomial from a function, relative to its largest value."""


def density_of(pressure: Pressure, inner: float, outer: float) -> int:
    """Return the code of ``pressure`` in a ``Contact``: 0 if uniform, else minus an address.

    Raises ``ValueError`` if it is not a smooth pressure.
    """
    if isinstance(pressure, str) and pressure == "uniform":
        return 0
    if isinstance(pressure, str) and pressure == "wear":
        return -int(kept((0.0,) * DEGREE + (1.0 / (outer - inner),)))
    if not callable(pressure):
        raise ValueError(
            f"pressure = {shown(pressure)}: it must be 'uniform', 'wear' or a function of the radius in m"
        )
    require_callable("pressure", pressure, "radius")
    radii = np.linspace(inner, outer, 65)
    shares = np.array([_checked(pressure, float(radius)) for radius in radii]) * radii
    places = (radii - inner) / (outer - inner)
    found = np.polynomial.Chebyshev.fit(places, shares, DEGREE, domain=[0.0, 1.0])
    deviation = float(np.abs(found(places) - shares).max() / shares.max()) if shares.any() else math.inf
    if deviation > DEVIATION:
        raise ValueError(
            f"pressure: a polynomial of degree {DEGREE} in the radius deviates by {deviation:.1g} of its largest "
            "share; it must be a smooth function, > 0 somewhere; for a step use two contacts"
        )
    power = found.convert(kind=np.polynomial.Polynomial, domain=[0.0, 1.0], window=[0.0, 1.0])
    coefficients = np.zeros(DEGREE + 1)
    coefficients[: len(power.coef)] = power.coef
    total = float(power.integ()(1.0) - power.integ()(0.0)) * (outer - inner)
    return -int(kept(tuple((coefficients[::-1] / total).tolist())))


def mean_radius_of(density: int, inner: float, outer: float) -> float:
    """Return ∫ r·d(r) dr in m."""
    share = np.polynomial.Polynomial(kept_at(-density)[::-1])
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


def _checked(pressure: Callable[[float], float], radius: float) -> float:
    value = finite_number(f"pressure({radius:.6g} m)", pressure(radius))
    if value < 0.0:
        raise ValueError(f"pressure({radius:.6g} m) = {value:g}: it must be >= 0")
    return value
