"""Friction of an annulus, such as a clutch facing, as a sum of rings."""

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from reference_model.contact.contact_law import IsotropicContact, Shares, Slopes
from reference_model.contact.elliptic import mean_curvatures, mean_directions
from reference_model.systems import finite_number, require_callable, require_whole

CLUSTERING = 3
"""Exponent q of the substitution r = r₀ + (r₁ − r₀)·t^q on either side of the kink r₀.

It turns x·ln x into t^(2q−1)·ln t. Gauss's rule converges like n^(−2a − 2) on t^a·ln t.
"""

ORDER = 4 * CLUSTERING
"""Order of convergence of force and moment in ``rings``, if r₀ lies in or near the annulus."""

SLOPE_ORDER = 2 * CLUSTERING
"""Order of convergence of the slopes of force and moment."""


@dataclass(frozen=True)
class Annulus(IsotropicContact):
    """Contact between two circles, under a pressure that depends only on the radius.

    Friction is that of a :class:`reference_model.contact.contact_law.Ring`, averaged over the load by Gauss's rule,
    split at the radius r₀ = U/|S| of a point at rest. With n rings the error falls like n^(−12), to about 1e-12 for n
    = 16, and the error of the slopes like n^(−6), to about 1e-7.

    Parameters
    ----------
    inner_radius, outer_radius
        Radii in m, 0 <= inner < outer.
    rings
        Number n >= 1 on either side of r₀.
    pressure
        Pressure in any unit as a smooth function of the radius in m, such as ``lambda r: 1 / r`` for a worn-in
        facing. None: uniform.

    Raises
    ------
    ValueError
        If a radius or ``rings`` is out of range, or the pressure is not a function, negative, or zero everywhere.

    """

    inner_radius: float
    outer_radius: float
    rings: int = 16
    pressure: Callable[[float], float] | None = None

    def __post_init__(self) -> None:
        inner = finite_number("inner_radius", self.inner_radius)
        outer = finite_number("outer_radius", self.outer_radius)
        object.__setattr__(self, "inner_radius", inner)
        object.__setattr__(self, "outer_radius", outer)
        if inner < 0.0:
            raise ValueError(f"inner_radius = {inner:g} m: it must be >= 0")
        if outer <= inner:
            raise ValueError(f"outer_radius = {outer:g} m: it must be > inner_radius = {inner:g} m")
        require_whole("rings", self.rings, least=1, most=1000)
        if self.pressure is not None:
            require_callable("pressure", self.pressure, "radius")
        self._loads(inner)

    def shares(self, slip_speed: float, relative_spin: float) -> Shares:
        resistance = moment = 0.0
        for radius, share in self._loads(self._resting_radius(slip_speed, relative_spin)):
            along_slip, along_rim = mean_directions(slip_speed, radius * abs(relative_spin))
            resistance += share * along_slip
            moment += share * radius * along_rim
        return Shares(resistance, math.copysign(moment, relative_spin))

    def slopes(self, slip_speed: float, relative_spin: float) -> Slopes:
        by_slip = mixed = by_spin = 0.0
        for radius, share in self._loads(self._resting_radius(slip_speed, relative_spin)):
            rim = radius * abs(relative_spin)
            if rim == slip_speed:
                continue  # rounding at r₀: a logarithm times a load of 1e-16
            curvatures = mean_curvatures(slip_speed, rim)
            by_slip += share * curvatures[0]
            mixed += share * radius * curvatures[1]
            by_spin += share * radius**2 * curvatures[2]
        mixed *= math.copysign(1.0, relative_spin)
        return Slopes(by_slip, mixed, mixed, by_spin)

    def _resting_radius(self, slip_speed: float, relative_spin: float) -> float:
        spin = abs(relative_spin)
        if slip_speed == 0.0 and spin == 0.0:
            raise ValueError("slip = 0 m/s and relative spin = 0 rad/s: the disc is at rest")
        if slip_speed >= self.outer_radius * spin:
            return self.outer_radius
        return max(slip_speed / spin, self.inner_radius)

    def _loads(self, centre: float) -> list[tuple[float, float]]:
        loads = list(self._rings(centre))
        total = math.fsum(load for _, load in loads)
        if total == 0.0:
            raise ValueError("pressure = 0 everywhere: it must be positive for some radius")
        return [(radius, load / total) for radius, load in loads]

    def _rings(self, centre: float) -> Iterator[tuple[float, float]]:
        for end in (self.inner_radius, self.outer_radius):
            for way, weight in self._rule:
                radius = centre + (end - centre) * way
                load = weight * abs(end - centre) * radius
                if load > 0.0:
                    yield radius, load * self._pressure_at(radius)

    @cached_property
    def _rule(self) -> tuple[tuple[float, float], ...]:
        """t^q at the points of Gauss's rule on (0, 1), and its weights times the derivative of t^q."""
        points, weights = np.polynomial.legendre.leggauss(self.rings)
        t = (1.0 + points) / 2.0
        slopes = CLUSTERING * t ** (CLUSTERING - 1)
        return tuple(zip((t**CLUSTERING).tolist(), (weights / 2.0 * slopes).tolist(), strict=True))

    def _pressure_at(self, radius: float) -> float:
        if self.pressure is None:
            return 1.0
        pressure = finite_number(f"pressure({radius:g} m)", self.pressure(radius))
        if pressure < 0.0:
            raise ValueError(f"pressure({radius:g} m) = {pressure:g}: it must be >= 0")
        return pressure
