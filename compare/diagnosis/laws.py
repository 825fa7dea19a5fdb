"""Laws of friction that engines have, and which of them a measured force is: fitted by least squares.

A law that knows directions of the world has a polygon in place of Coulomb's circle: it acts along the corner that is
nearest to against the slip. A square on its side is the box, in which each axis has friction of its own.
"""

from __future__ import annotations

import cmath
import functools
import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize_scalar

from compare.diagnosis.probes import PULLS
from reference_model.systems import FloatArray

Complex = NDArray[np.complex128]

SIDES = (3, 4, 6, 8, 12, 16)
"""Of the polygons that are tried, with a corner on the x axis and with a side across it."""

PLANE = np.array([1.0, 1j])

FITS = 1e-6
"""Misfit over μN that any law may have: what slides for a moment is retarded by next to a constant force."""

DISTINCT = 3.0
"""How many times worse the next best law must fit, and how many times its error a deviation must be, to be named."""


@dataclass(frozen=True)
class Shape:
    """A law's force over μN, along x + iy, against a slip that is a unit vector.

    ``sizes`` are the names that the law has if its force has the sizes beside them.
    """

    direction: Callable[[complex], complex]
    sizes: Mapping[str, float]


CONE = "cone"


def _against(slip: complex) -> complex:
    return -slip


def _polygon(sides: int, tilt: float, slip: complex) -> complex:
    """Return the corner, the first one at ``tilt`` in rad, that is nearest to against the slip."""
    step = 2.0 * math.pi / sides
    return cmath.rect(1.0, tilt + step * round((cmath.phase(-slip) - tilt) / step))


def _shapes() -> tuple[Shape, ...]:
    found = [Shape(_against, {CONE: 1.0})]
    for sides in SIDES:
        outside = 1.0 / math.cos(math.pi / sides)
        for tilt, across in ((0.0, "a corner on"), (math.pi / sides, "a side across")):
            name = f"pyramid of {sides} sides with {across} the x axis"
            names = {f"{name}, inside of the cone": 1.0, f"{name}, around the cone": outside}
            if sides == 4 and tilt == 0.0:
                names = {"pyramid of 4 sides: it acts along the nearest axis": 1.0} | names
            if sides == 4 and tilt > 0.0:
                names = {"box: each axis has its own": outside} | names
            found.append(Shape(functools.partial(_polygon, sides, tilt), names))
    return tuple(found)


SHAPES = _shapes()


@dataclass(frozen=True)
class Friction:
    """The law that fits a force best.

    Parameters
    ----------
    shape : str
        Which it is, by the name that ``SHAPES`` have for it.
    strength : float
        μ over what it should be.
    angle : float
        In rad, by which the force is turned against the law's, counterclockwise.
    error : float
        What the force measured may be off by, over μN: that of ``strength`` and ``angle`` too.
    misfit : float
        Largest difference of the force, over μN.
    sure : bool
        Whether no other law fits nearly as well, and this one within three times the error.

    """

    shape: str
    strength: float
    angle: float
    error: float
    misfit: float
    sure: bool


def fitted(forces: FloatArray, error: float) -> Friction:
    """Return the law of ``forces`` as ``probes.forces`` gives them, which are known to ``error``."""
    measured, slips = forces[:, :2] @ PLANE, forces[:, 2:] @ PLANE
    fits = sorted((_fit(shape, slips, measured) for shape in SHAPES), key=lambda fit: fit[2])
    (shape, factor, misfit), next_best = fits[0], fits[1][2]
    name, size = min(shape.sizes.items(), key=lambda one: abs(math.log(abs(factor) / one[1])))
    sure = misfit <= max(DISTINCT * error, FITS) and next_best > DISTINCT * max(misfit, error)
    return Friction(name, abs(factor) / size, cmath.phase(factor), error, misfit, sure)


def _fit(shape: Shape, slips: Complex, measured: Complex) -> tuple[Shape, complex, float]:
    """Return a shape, the complex factor that fits best, and the largest difference that it leaves."""
    law = np.array([shape.direction(complex(slip)) for slip in slips])
    factor = complex(np.vdot(law, measured) / np.vdot(law, law)) or 1e-300
    return shape, factor, float(np.max(np.abs(measured - factor * law)))


@dataclass(frozen=True)
class Smoothing:
    """How friction falls at slow slip: its share of μN as a formula, and the slip over ε at which it is a share."""

    name: str
    slip: Callable[[FloatArray], FloatArray]


SMOOTHINGS = (
    Smoothing("min(v/ε, 1)", lambda share: share),
    Smoothing("tanh(v/ε)", np.arctanh),
    Smoothing("v/√(v² + ε²)", lambda share: share / np.sqrt(1.0 - share**2)),
    Smoothing("2/π·arctan(v/ε)", lambda share: np.tan(np.pi / 2.0 * share)),
)


SMOOTHING_FITS = 0.2
"""Largest relative misfit of a smoothing that is named."""


def smoothing_of(creep: FloatArray) -> tuple[str, float]:
    """Return which smoothing makes a block creep so under ``PULLS``, and its ε in m/s; "" and NaN if none does."""
    if not np.all(creep > 0.0):
        return "", math.nan
    pulls = np.array(PULLS)

    def misfit(logarithm: float, smoothing: Smoothing) -> float:
        return float(np.max(np.abs(creep / (math.exp(logarithm) * smoothing.slip(pulls)) - 1.0)))

    found = []
    for smoothing in SMOOTHINGS:
        guess = math.log(float(np.mean(creep / smoothing.slip(pulls))))
        best = minimize_scalar(misfit, bounds=(guess - 1.0, guess + 1.0), args=(smoothing,))
        found.append((float(best.fun), smoothing.name, math.exp(float(best.x))))
    least, name, epsilon = min(found)
    return (name, epsilon) if least < SMOOTHING_FITS else ("", math.nan)
