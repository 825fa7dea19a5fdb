"""Friction laws of engines, and the identification of a measured force among them by least squares.

An anisotropic law replaces Coulomb's circle by a polygon: the force points to the corner nearest to the opposite of
the slip. The box is a square with sides across the axes.
"""

import cmath
import functools
import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import least_squares, minimize_scalar

from compare.diagnosis.probes import PLANE, PULLS
from reference_model.systems import FloatArray

Complex = NDArray[np.complex128]

SIDES = (3, 4, 6, 8, 12, 16)
"""Number of sides of the polygons, each tried with a corner and with a side on the x axis."""

FITS = 1e-6  # misfit/μN allowed for any law, because the force varies a little
DISTINCT = 3.0  # smallest ratio of second-best to best misfit, and of a reported deviation to its error

NEAR, FAR = 1e-3, 100.0
"""Largest misfit of a law with a further difference, and smallest ratio of the next misfit."""


@dataclass(frozen=True)
class Shape:
    """Direction of a law's force as x + iy, for a slip that is a unit vector.

    ``sizes`` maps the names of the law to the magnitudes of its force/μN.
    """

    direction: Callable[[complex], complex]
    sizes: Mapping[str, float]


CONE, ELLIPSE, NOTHING = "cone", "ellipse", "no friction"


def _against(slip: complex) -> complex:
    return -slip


def _polygon(sides: int, tilt: float, slip: complex) -> complex:
    """Return the corner nearest to the direction opposite to the slip; the first is at ``tilt`` (rad)."""
    step = 2.0 * math.pi / sides
    return cmath.rect(1.0, tilt + step * round((cmath.phase(-slip) - tilt) / step))


def _shapes() -> tuple[Shape, ...]:
    found = [Shape(_against, {CONE: 1.0})]
    for sides in SIDES:
        outside = 1.0 / math.cos(math.pi / sides)
        for tilt, across in ((0.0, "a corner on"), (math.pi / sides, "a side across")):
            name, end = f"pyramid with {sides} sides", f"with {across} the x axis"
            names = {f"{name} inside the cone, {end}": 1.0, f"{name} around the cone, {end}": outside}
            if sides == 4 and tilt == 0.0:
                names = {"pyramid with 4 sides that acts along the nearest axis": 1.0} | names
            if sides == 4 and tilt > 0.0:
                names = {"box with a separate limit for each axis": outside} | names
            found.append(Shape(functools.partial(_polygon, sides, tilt), names))
    return tuple(found)


SHAPES = _shapes()


@dataclass(frozen=True)
class Friction:
    """Friction law with the best fit."""

    shape: str
    strength: float  # ratio of the fitted to the nominal μ
    angle: float  # rotation of the force from the law's direction, in rad
    error: float  # error of the measured force/μN; also that of ``strength`` and ``angle``
    misfit: float  # largest difference between the forces, divided by μN
    sure: bool  # no other law fits nearly as well
    along: float = math.nan  # μ along the first axis of an ellipse, over the nominal μ
    across: float = math.nan
    axis: float = math.nan  # direction of that axis in rad
    per_step: float = math.nan  # largest impulse of a step, divided by μN, in s, if independent of the step
    load: float = math.nan  # smallest μN of the slides in N

    @property
    def fits(self) -> bool:
        """True if the law explains the forces within their error."""
        return self.misfit <= max(DISTINCT * self.error, FITS)

    @property
    def coulomb(self) -> bool:
        """True if friction is Coulomb's cone with the nominal μ to 10 %."""
        return self.sure and self.shape == CONE and abs(self.strength - 1.0) < 0.1

    def force(self, slips: Complex) -> Complex:
        """Return the force/μN for unit slips, shape (n,)."""
        if self.shape == ELLIPSE:
            return _ellipse(np.array([self.along, self.across, self.axis]), slips)
        shape, size = next((s, s.sizes[self.shape]) for s in SHAPES if self.shape in s.sizes)
        factor = self.strength * size * cmath.rect(1.0, self.angle)
        return factor * np.array([shape.direction(complex(slip)) for slip in slips])


def fitted(forces: FloatArray, error: float) -> Friction:
    """Return the law that fits ``forces`` best, with their ``error``/μN.

    The columns of ``forces`` are F_x/μN, F_y/μN and the direction of slip, shape (n, 4).
    """
    measured, slips = forces[:, :2] @ PLANE, forces[:, 2:] @ PLANE
    if np.max(np.abs(measured)) <= max(DISTINCT * error, FITS) and error < NEAR:
        return Friction(NOTHING, 0.0, 0.0, error, 0.0, True)
    fits = sorted((_fit(shape, slips, measured) for shape in SHAPES), key=lambda fit: fit[2])
    (shape, factor, misfit), next_best = fits[0], fits[1][2]
    if misfit > max(DISTINCT * error, FITS) and (found := _as_ellipse(slips, measured, error, misfit)):
        return found
    name, size = min(shape.sizes.items(), key=lambda one: abs(math.log(abs(factor) / one[1])))
    fitting = misfit <= max(DISTINCT * error, FITS) or (misfit <= NEAR and next_best > FAR * misfit)
    sure = fitting and next_best > DISTINCT * max(misfit, error)
    return Friction(name, abs(factor) / size, cmath.phase(factor), error, misfit, sure)


def _ellipse(numbers: FloatArray, slips: Complex) -> Complex:
    """Return the force of largest dissipation in an ellipse."""
    turn = np.exp(1j * numbers[2])
    along = slips / turn
    x, y = numbers[0] ** 2 * along.real, numbers[1] ** 2 * along.imag
    size = np.hypot(numbers[0] * along.real, numbers[1] * along.imag)
    return np.asarray(-turn * (x + 1j * y) / size)


def _as_ellipse(slips: Complex, measured: Complex, error: float, misfit: float) -> Friction | None:
    """Return an ellipse if it fits much better than the other laws, with their ``misfit``."""

    def off(numbers: FloatArray) -> FloatArray:
        rest = measured - _ellipse(numbers, slips)
        return np.concatenate((rest.real, rest.imag))

    sizes = np.max(np.abs(measured)), np.min(np.abs(measured))
    starts = [
        least_squares(off, (*sizes, axis), xtol=1e-15, ftol=1e-15, gtol=1e-15) for axis in (0.1, 0.8, 1.5)
    ]
    best = min(starts, key=lambda found: found.cost)
    left = float(np.max(np.abs(measured - _ellipse(best.x, slips))))
    if left > max(DISTINCT * error, FITS, misfit / FAR):
        return None
    along, across, axis = (float(number) for number in best.x)
    return Friction(
        ELLIPSE,
        math.sqrt(abs(along * across)),
        0.0,
        error,
        left,
        True,
        abs(along),
        abs(across),
        axis % math.pi,
    )


def _fit(shape: Shape, slips: Complex, measured: Complex) -> tuple[Shape, complex, float]:
    """Return the best shape, its complex factor, and the largest remaining difference."""
    law = np.array([shape.direction(complex(slip)) for slip in slips])
    factor = complex(np.vdot(law, measured) / np.vdot(law, law)) or 1e-300
    return shape, factor, float(np.max(np.abs(measured - factor * law)))


@dataclass(frozen=True)
class Smoothing:
    """Regularised friction: v/ε for a share of μN, and its inverse, the share of μN at v/ε."""

    name: str
    slip: Callable[[FloatArray], FloatArray]
    share: Callable[[FloatArray], FloatArray]


SMOOTHINGS = (
    Smoothing("min(v/ε, 1)", lambda share: share, lambda slip: np.minimum(slip, 1.0)),
    Smoothing("tanh(v/ε)", np.arctanh, np.tanh),
    Smoothing(
        "v/√(v² + ε²)", lambda share: share / np.sqrt(1.0 - share**2), lambda slip: slip / np.hypot(slip, 1.0)
    ),
    Smoothing(
        "2/π·arctan(v/ε)",
        lambda share: np.tan(np.pi / 2.0 * share),
        lambda slip: 2.0 / np.pi * np.arctan(slip),
    ),
)


SMOOTHING_FITS = 0.2  # largest relative misfit of an identified regularisation


def smoothing_of(creep: FloatArray) -> tuple[str, float]:
    """Return the regularisation that explains the creep under ``PULLS`` and its ε in m/s."""
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
