"""The smallest shock that throws a pin from its self-centred equilibrium into the whirl.

A shock changes only the velocity. The smallest shock is the nearest point of the basin boundary in the plane of
velocities through the equilibrium. End states of many starts show its approximate direction.
"""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize_scalar

from reference_model.ensemble import EndState, simulate_ensemble
from reference_model.orbits.basin_boundary import Separatrix
from reference_model.orbits.release_map import stick_slip_orbits
from reference_model.steady.steady_states import self_centred_equilibria, why_no_equilibrium
from reference_model.systems import FloatArray, PinOnDisc, require_kind

DIRECTIONS = 64
"""Number of directions tried first."""

SIZES = np.geomspace(1e-4, 1.0, 96)
"""Sizes of the shocks tried first, as shares of the speed of the disc at the whirl or at the offset."""

PERIODS = 500.0
"""Longest time to an end state, in free periods, unless the start lies on the boundary."""

COARSE, FINE = 1e-2, 1e-7
"""Relative widths of bisection: for the direction, and to check the result."""

ANGLE = 1e-4
"""Tolerance of the direction in rad; the smallest size depends on its square."""


@dataclass(frozen=True)
class Shock:
    """A sudden change ``vx``, ``vy`` in m/s of the velocity of a pin that rests at its self-centred equilibrium."""

    pin: PinOnDisc
    vx: float
    vy: float

    @property
    def speed(self) -> float:
        """Magnitude in m/s."""
        return math.hypot(self.vx, self.vy)

    @property
    def impulse(self) -> float:
        """Impulse in N s."""
        return self.pin.mass * self.speed

    @property
    def direction(self) -> float:
        """Angle to the x axis in rad, from −π to π."""
        return math.atan2(self.vy, self.vx)


def smallest_shock(pin: PinOnDisc, *, tolerance: float = 1e-9) -> Shock:
    """Return the smallest shock that throws ``pin`` from its equilibrium into the whirl.

    Raises ``ValueError`` if there is no equilibrium, no tried shock leads to the whirl, or no saddle orbit with a
    stick phase lies between the two; ``RuntimeError`` if the boundary is not in the stable set of that orbit.
    """
    require_kind("pin", pin, PinOnDisc)
    rest = _rest(pin)
    saddles = [orbit for orbit in stick_slip_orbits(pin, tolerance=tolerance) if not orbit.stable]
    if len(saddles) != 1:
        found = (
            f"{len(saddles)} saddle-type stick-slip orbits" if saddles else "no saddle-type stick-slip orbit"
        )
        raise ValueError(f"{found} at these parameters, so the smallest shock cannot be computed")
    separatrix = Separatrix.of(saddles[0])
    angles = np.linspace(0.0, 2.0 * math.pi, DIRECTIONS, endpoint=False)
    low, high = _first_crossings(pin, rest, angles)
    sizes = _bisected(pin, rest, angles, low, high, COARSE)
    nearest = int(np.argmin(sizes))

    def point(angle: float) -> FloatArray:
        inside, outside = (rest + part * sizes[nearest] * _shocks(angle)[0] for part in (0.5, 1.5))
        return separatrix.point_between(inside, outside) - rest

    apart = float(angles[1])
    best = minimize_scalar(
        lambda angle: float(np.linalg.norm(point(angle))),
        bounds=(angles[nearest] - apart, angles[nearest] + apart),
        method="bounded",
        options={"xatol": ANGLE},
    )
    _, _, vx, vy = point(float(best.x)).tolist()
    return Shock(pin, vx, vy)


def by_bisection(shock: Shock) -> float:
    """Return the smallest shock in m/s in the same direction that leads to the whirl, by bisection of end states.

    The relative error is ``FINE``. Raises ``ValueError`` if the end state does not change between 0.9 and 1.15 times
    the size of ``shock``.
    """
    pin, rest, angle = shock.pin, _rest(shock.pin), np.array([shock.direction])
    # Asymmetric, so no midpoint is the shock itself.
    low, high = (np.array([factor * shock.speed]) for factor in (0.9, 1.15))
    before, behind = (bool(_whirls(pin, rest, angle, sizes)[0]) for sizes in (low, high))
    if before or not behind:
        raise ValueError(
            f"from 0.9 to 1.15 times {shock.speed:g} m/s the end state does not change to the whirl"
        )
    return float(_bisected(pin, rest, angle, low, high, FINE)[0])


def _rest(pin: PinOnDisc) -> FloatArray:
    found = self_centred_equilibria(pin)
    if not found:
        raise ValueError(why_no_equilibrium(pin))
    return np.array([found[0].x, found[0].y, 0.0, 0.0])


def _shocks(angles: float | FloatArray) -> FloatArray:
    angles = np.atleast_1d(angles)
    zero = np.zeros_like(angles)
    return np.column_stack((zero, zero, np.cos(angles), np.sin(angles)))


def _whirls(pin: PinOnDisc, rest: FloatArray, angles: FloatArray, sizes: FloatArray) -> NDArray[np.bool_]:
    """Return which shocks, each with an angle and a size, lead to the whirl."""
    starts = rest + sizes[:, np.newaxis] * _shocks(angles)
    duration = PERIODS * 2.0 * math.pi / pin.natural_frequency
    return np.asarray(simulate_ensemble(pin, starts, duration=duration).end == EndState.WHIRL)


def _first_crossings(pin: PinOnDisc, rest: FloatArray, angles: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return for each angle two sizes that bracket the onset of the whirl, or inf."""
    reach = abs(pin.disc_speed) * max(
        abs(pin.offset), pin.friction_force / (pin.damping * pin.natural_frequency)
    )
    sizes = reach * SIZES
    grid = np.meshgrid(angles, sizes, indexing="ij")
    found = _whirls(pin, rest, *(part.ravel() for part in grid)).reshape(grid[0].shape)
    some, first = np.any(found, axis=1), np.argmax(found, axis=1)
    if not np.any(some):
        raise ValueError(f"no shock up to {reach:g} m/s leads to the whirl")
    low = np.where(first > 0, sizes[first - 1], 0.0)
    return np.where(some, low, math.inf), np.where(some, sizes[first], math.inf)


def _bisected(
    pin: PinOnDisc, rest: FloatArray, angles: FloatArray, low: FloatArray, high: FloatArray, width: float
) -> FloatArray:
    sizes = np.full(len(angles), math.inf)
    there = np.flatnonzero(np.isfinite(high))
    low, high, angles = low[there].copy(), high[there].copy(), angles[there]
    while np.any(high - low > width * high):
        middle = 0.5 * (low + high)
        whirls = _whirls(pin, rest, angles, middle)
        low, high = np.where(whirls, low, middle), np.where(whirls, middle, high)
    sizes[there] = 0.5 * (low + high)
    return sizes
