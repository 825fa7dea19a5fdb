"""The boundary between the basins of a pin's self-centred equilibrium and its whirl.

If a saddle orbit with a stick phase lies between the two, the boundary is its stable set: the starts that are
eventually released at the orbit's angle. This angle depends smoothly on the start, so a point of the boundary is a
root, which end states bracket.
"""

from __future__ import annotations

import functools
import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike
from scipy.optimize import brentq

from reference_model.numerics.continuation import Curve
from reference_model.numerics.dividing_curves import dividing_curves
from reference_model.orbits.release_map import JUMP, ROUGH, Release, ReleaseMap, StickSlipOrbit
from reference_model.systems import FloatArray, checked_state, finite_numbers, require_whole, shown

COMPONENTS = ("x", "y", "vx", "vy")

NEAR = 0.3
"""Angle in rad within which a release counts as near the release of the orbit; roots do not depend on it."""

SPARE = 0.1
"""Error of a point as a multiple of the orbit's tolerance."""

DISTINCT = 0.1
"""Smallest relative difference in radius that distinguishes two motions."""


@dataclass(frozen=True)
class Separatrix:
    """The two sides of the stable set of a saddle orbit; ``releases`` is the pin's release map."""

    orbit: StickSlipOrbit
    releases: ReleaseMap

    @classmethod
    def of(cls, orbit: StickSlipOrbit) -> Separatrix:
        """Return the sides of ``orbit``; raise ``ValueError`` if it does not separate two motions."""
        if not isinstance(orbit, StickSlipOrbit):
            raise ValueError(f"orbit = {orbit!r}: it must be a StickSlipOrbit")
        if not orbit.multiplier > 1.0:
            raise ValueError(
                f"orbit has the multiplier {orbit.multiplier:g}: a basin boundary needs one > 1, so that its stable "
                "set has two sides"
            )
        separatrix = cls(orbit, ReleaseMap(orbit.system, orbit.problem.tolerance))
        before, behind = separatrix.ends
        if abs(before - behind) < DISTINCT * max(before, behind):
            raise ValueError(
                f"both sides of the orbit lead to motions of the same radius, {before:g} m and "
                f"{behind:g} m: the orbit does not separate them"
            )
        return separatrix

    @cached_property
    def ends(self) -> tuple[float, float]:
        """Radii in m of the motions after a release before the orbit's angle and after it."""
        before, behind = (
            self.rough.first(self.rough.state(self.orbit.release_angle + shift), lambda _: False)[1]
            for shift in (-NEAR, NEAR)
        )
        return math.hypot(*before[:2]), math.hypot(*behind[:2])

    @cached_property
    def rough(self) -> ReleaseMap:
        """The release map with a loose tolerance, which matters only next to the boundary."""
        return replace(self.releases, tolerance=max(ROUGH, self.releases.tolerance))

    def miss(self, start: ArrayLike) -> float:
        """Return the angular distance from the orbit at the pin's first release near it.

        It is positive for releases after the release of the orbit, and ±NEAR without a near release, by the final
        motion.
        """

        def near(release: Release) -> bool:
            return abs(release.angle - self.orbit.release_angle) < NEAR

        release, last = self.rough.first(start, near)
        if release is not None and self.releases != self.rough:
            release, last = self.releases.first(start, near)
        if release is not None:
            return release.angle - self.orbit.release_angle
        radius = math.hypot(*last[:2])
        before, behind = self.ends
        return NEAR if abs(radius - behind) < abs(radius - before) else -NEAR

    def point_between(self, first: FloatArray, second: FloatArray) -> FloatArray:
        """Like :func:`boundary_point`, for states of shape (4,)."""

        @functools.cache
        def miss(share: float) -> float:
            return self.miss(first + share * (second - first))

        if miss(0.0) * miss(1.0) > 0.0:
            raise ValueError(
                f"{first} and {second} lead to the same motion: they must lie on different sides of the boundary"
            )
        # A smaller tolerance would find zeros of noise.
        share = float(brentq(miss, 0.0, 1.0, xtol=SPARE * self.orbit.problem.tolerance, rtol=1e-14))
        point = first + share * (second - first)
        _require_on_boundary(point, miss(share))
        return np.asarray(point)


def boundary_point(orbit: StickSlipOrbit, first: ArrayLike, second: ArrayLike) -> FloatArray:
    """Return the crossing of the basin boundary, shape (4,), on the straight line between two starts.

    The boundary is the stable set of the saddle ``orbit``, whose tolerance also applies to the point. Raises
    ``ValueError`` if the orbit does not separate two motions, or both starts lead to the same motion;
    ``RuntimeError`` if something other than this stable set separates them.
    """
    separatrix = Separatrix.of(orbit)
    starts = (("first", first), ("second", second))
    return separatrix.point_between(*(checked_state(orbit.system, state, name) for name, state in starts))


def basin_boundary(
    orbit: StickSlipOrbit,
    *,
    components: tuple[str, str] = ("x", "vx"),
    ranges: Sequence[tuple[float, float]],
    others: ArrayLike = (0.0, 0.0, 0.0, 0.0),
    cells: int = 32,
) -> tuple[Curve, ...]:
    """Return the basin boundary in a rectangle of starts, as curves with points of shape (n, 2).

    The ``ends`` of a curve are 0 and 1 at the lower limits of both components, 2 and 3 at the upper. Raises
    ``ValueError`` if the orbit does not separate two motions, or an argument is invalid; ``RuntimeError`` if a
    boundary is not in the stable set of this orbit, or a curve cannot be followed.

    Parameters
    ----------
    orbit
        The saddle, with the tolerance of the points.
    components
        Components that vary in the rectangle: two of "x", "y", "vx", "vy".
    ranges
        Their ranges in m or m/s.
    others : array-like of shape (4,)
        Supplies the other components.
    cells
        Grid cells in each direction, the largest distance of points on a curve. Curves that no grid edge crosses
        exactly once are missed.

    """
    separatrix = Separatrix.of(orbit)
    places = _checked_places(components)
    low, high = _checked_ranges(components, ranges)
    state = checked_state(orbit.system, others, "others")
    require_whole("cells", cells, least=2, most=1000)

    @functools.cache  # searches repeat their ends, and curves their points
    def miss(*point: float) -> float:
        start = state.copy()
        start[places] = point
        return separatrix.miss(start)

    curves = dividing_curves(
        lambda point: miss(*point.tolist()), low, high, cells, error=SPARE * orbit.problem.tolerance
    )
    for point in (point for curve in curves for point in curve.points):
        _require_on_boundary(point, miss(*point.tolist()))
    return curves


def _require_on_boundary(point: FloatArray, miss: float) -> None:
    if abs(miss) > JUMP:
        raise RuntimeError(
            f"the boundary at {point} is not in the stable set of the orbit: no release is near that of the orbit"
        )


def _checked_places(components: tuple[str, str]) -> list[int]:
    try:
        places = [COMPONENTS.index(name) for name in components]
    except (TypeError, ValueError):
        places = []
    if len(places) != 2 or places[0] == places[1]:
        raise ValueError(f"components = {shown(components)}: they must be two of {', '.join(COMPONENTS)}")
    return places


def _checked_ranges(
    components: tuple[str, str], ranges: Sequence[tuple[float, float]]
) -> tuple[FloatArray, FloatArray]:
    limits = finite_numbers("ranges", ranges)
    if limits.shape != (2, 2):
        raise ValueError(f"ranges = {ranges!r}: they must be two pairs of numbers")
    for name, (first, last) in zip(components, limits.tolist(), strict=True):
        if not first < last:
            raise ValueError(f"range of {name} = {first:g} to {last:g}: it must increase")
    low, high = limits.T
    return low, high
