"""Stability and existence boundaries of a disc's whirl, as curves in a plane of two parameters.

For X0 = 0 and any isotropic friction law the ratio of the slip speeds of centre and rim determines a whirl up to its
torsional balance. With two parameters of the disc these are three unknowns for two equations, the balance and one of

- *Hopf*: the Hurwitz determinant is zero, so a pair of eigenvalues ±iν is imaginary;
- *fold*: the constant coefficient is zero, so two whirls meet and an eigenvalue is zero;
- *onset*: the whirl has zero radius, where the centred rotation about the axis becomes unstable.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, fields
from functools import cached_property, lru_cache
from typing import Any, Literal, get_args

import numpy as np
from scipy.optimize import brentq

from reference_model.contact.contact_law import IsotropicContact, isotropic_contact_of
from reference_model.formulas.characteristic_polynomial import Coefficients, characteristic_coefficients
from reference_model.formulas.disc import pin_of, whirl_arm
from reference_model.formulas.pin import whirl_radius
from reference_model.numerics.continuation import follow
from reference_model.support import require_linear_support
from reference_model.systems import DiscOnDisc, FloatArray

Kind = Literal["Hopf", "fold", "onset"]

FAST, SLOW = 1, -1
"""Sides of U = W, where a ring's friction has an infinite slope: the centre (FAST) or the rim slips faster."""

NEAREST = 8.0
"""Largest ln(U/|U − W|) of the curves.

The derivatives of a ring's friction grow like this number, so curves are smooth with it as an unknown.
"""

FARTHEST = 2e-3
"""Smallest ln(U/|U − W|), approximately the smallest U : W or W : U."""

SCALE = 3.0
"""Change of ln(U/|U − W|) that counts as much as the range of a parameter."""

INERTIA = "polar_inertia"

SLOWEST = 3e-3
"""Smallest frequency ν on a Hopf curve, as a fraction of k; below it the pair soon becomes real."""

NODES = 41

SAME = 3e-3
"""Distance from a known curve, in units of the scales, below which a start lies on it."""

LINES = 9
"""Number of starting lines in each direction of the plane."""

INSET = 1e-6
"""Distance of the outermost lines from the borders, so that all starts lie inside."""


@dataclass(frozen=True)
class ParameterPlane:
    """A rectangle in two parameters of a disc; ``disc`` contains all other parameters.

    ``names`` are two parameters except contact, offset and nonlinear support, with ranges from ``lower`` to
    ``upper``. Raises ``ValueError`` if a name is not allowed, a range is empty or includes parameters without a whirl
    at any load, or there is an offset or a nonlinear support.
    """

    disc: DiscOnDisc
    names: tuple[str, str]
    lower: tuple[float, float]
    upper: tuple[float, float]

    def __post_init__(self) -> None:
        if self.disc.offset != 0.0:
            raise ValueError(
                f"offset = {self.disc.offset:g} m: boundaries are defined for whirls without offset; set it to 0"
            )
        require_linear_support(self.disc)
        # A contact passed as an argument has its own radius.
        fixed = ("offset", "hardening", "stop_gap", "stop_stiffness", "contact_radius", "contact_points")
        allowed = [field.name for field in fields(self.disc) if field.name not in fixed]
        if len(set(self.names)) != 2 or not set(self.names) <= set(allowed):
            raise ValueError(f"names = {self.names}: they must be two of {', '.join(allowed)}")
        for name, low, high in zip(self.names, self.lower, self.upper, strict=True):
            if not low < high:
                raise ValueError(f"{name} from {low:g} to {high:g}: the range must not be empty")
            if name == "disc_speed" and low < 0.0 < high:
                raise ValueError(
                    f"disc_speed from {low:g} to {high:g} rad/s: it must exclude 0, there is no whirl at rest"
                )
        for corner in itertools.product(*zip(self.lower, self.upper, strict=True)):
            whirl_radius(pin_of(self.at(corner)))

    def at(self, values: Iterable[float]) -> DiscOnDisc:
        """Return the disc with these values of the two parameters."""
        changes: dict[str, Any] = dict(zip(self.names, map(float, values), strict=True))
        return DiscOnDisc(**vars(self.disc) | changes)  # twice as fast as replace()

    def lines(self, which: int) -> FloatArray:
        """Return the values of one parameter on the starting lines, shape (LINES,)."""
        inset = INSET * self.size[which]
        return np.linspace(self.lower[which] + inset, self.upper[which] - inset, LINES)

    @property
    def size(self) -> FloatArray:
        """Length of both ranges, shape (2,)."""
        return np.subtract(self.upper, self.lower)


@dataclass(frozen=True, eq=False)
class Boundary:
    """A curve in a plane.

    ``parameters``, shape (n, 2), are points, and ``alpha``, shape (n,), the angle of (24) of the whirl in rad, tan α
    = R|ω − φ̇|/U, π/2 at zero radius. The last point of a ``closed`` curve equals the first one.
    """

    kind: Kind
    parameters: FloatArray
    alpha: FloatArray
    closed: bool


def boundaries(
    plane: ParameterPlane, kind: Kind, contact: IsotropicContact | None = None, *, step: float = 0.03
) -> tuple[Boundary, ...]:
    """Return all curves of a ``kind``, "Hopf", "fold" or "onset", in ``plane``.

    The search misses only closed curves between its ``LINES`` lines in each direction. ``step`` is the largest
    distance of neighbouring points, in units of the ranges; ``contact`` None means the law of the parameters. Raises
    ``ValueError`` if the kind is unknown, or the disc rests on single points.
    """
    return tuple(
        boundary for condition in _conditions(plane, kind, contact) for boundary in _traced(condition, step)
    )


def crossings(
    plane: ParameterPlane, kind: Kind, name: str, value: float, contact: IsotropicContact | None = None
) -> tuple[float, ...]:
    """Return where a line in ``plane`` crosses the curves of a kind: increasing values of the other parameter.

    The parameter ``name`` is ``value`` along the line. Raises ``ValueError`` like :func:`boundaries`, or if ``name``
    or ``value`` is not in the plane.
    """
    if name not in plane.names:
        raise ValueError(f"name = {name!r}: it must be one of {' and '.join(plane.names)}")
    across = plane.names.index(name)
    low, high = plane.lower[across], plane.upper[across]
    if not low <= value <= high:
        raise ValueError(f"{name} = {value:g}: it must lie between {low:g} and {high:g}, as in the plane")
    return tuple(
        sorted(
            float(point[1 - across])
            for condition in _conditions(plane, kind, contact)
            for point in condition.crossings(across, value)
        )
    )


def _conditions(plane: ParameterPlane, kind: Kind, contact: IsotropicContact | None) -> Iterator[_Condition]:
    if kind not in get_args(Kind):
        raise ValueError(f"kind = {kind!r}: it must be one of {', '.join(get_args(Kind))}")
    law = isotropic_contact_of(plane.disc, contact, "the boundaries")
    for side in (SLOW, FAST) if kind != "onset" else (SLOW,):
        for sense in (1.0, -1.0):
            yield _Condition(plane, kind, law, side, sense)


@dataclass(frozen=True, eq=False)
class _Condition:
    """The equations of a boundary. Unknowns are two parameters and, except at the onset, ln(U/|U − W|).

    They hold on one side of U = W and for one sign of ω − Ω.
    """

    plane: ParameterPlane
    kind: Kind
    law: IsotropicContact
    side: int
    sense: float

    def ratio(self, unknowns: FloatArray) -> tuple[float, float]:
        """Return slip and rim speed, scaled so that the larger one is 1."""
        if self.kind == "onset":
            return 0.0, 1.0
        smaller = -math.expm1(-float(unknowns[2]))
        return (1.0, smaller) if self.side == FAST else (smaller, 1.0)

    def alpha(self, unknowns: FloatArray) -> float:
        slip, rim = self.ratio(unknowns)
        return math.atan2(rim, slip)

    @cached_property
    def at(self) -> Callable[[float, float], tuple[DiscOnDisc, Callable[[float, float], float]]]:
        """Function from two parameters to the disc and its :func:`whirl_arm`."""

        @lru_cache(maxsize=16)  # Newton's method uses the same parameters at several ratios
        def found(first: float, second: float) -> tuple[DiscOnDisc, Callable[[float, float], float]]:
            disc = self.plane.at((first, second))
            return disc, whirl_arm(disc, self.law)

        return found

    def disc(self, unknowns: FloatArray) -> DiscOnDisc:
        return self.at(*unknowns[:2].tolist())[0]

    def balance(self, unknowns: FloatArray) -> float:
        disc, arm = self.at(*unknowns[:2].tolist())
        torque = disc.shaft_damping * self.sense * (disc.disc_speed - disc.shaft_speed)
        return disc.friction_force * arm(*self.ratio(unknowns)) - torque

    def coefficients(self, unknowns: FloatArray) -> Coefficients:
        return characteristic_coefficients(self.disc(unknowns), *self.ratio(unknowns), self.law)

    def margin(self, unknowns: FloatArray) -> float:
        found = self.coefficients(unknowns)
        return found.hurwitz if self.kind == "Hopf" else found.constant

    def equations(self, unknowns: FloatArray) -> FloatArray:
        rest = () if self.kind == "onset" else (self.margin(unknowns),)
        return np.array([self.balance(unknowns), *rest])

    def limits(self, unknowns: FloatArray) -> FloatArray:
        """Return numbers that are positive inside the plane and the limits of the search."""
        disc = self.disc(unknowns)
        inside = [
            *(unknowns[:2] - self.plane.lower),
            *(self.plane.upper - unknowns[:2]),
            self.sense * (disc.disc_speed - disc.shaft_speed),
        ]
        if self.kind != "onset":
            inside += [unknowns[2] - FARTHEST, NEAREST - unknowns[2]]
        if self.kind == "Hopf":
            slowest = SLOWEST * disc.natural_frequency
            inside.append(self.coefficients(unknowns).squared_frequency - slowest**2)
        return np.array(inside)

    def starts(self) -> Iterator[FloatArray]:
        for across in (0, 1):
            for value in self.plane.lines(across).tolist():
                yield from self.crossings(across, value)

    def crossings(self, across: int, value: float) -> Iterator[FloatArray]:
        found = [self.whirl(across, value)] if self.kind == "onset" else self.zeros(across, value)
        for point in found:
            if point is not None and np.all(self.limits(point) > 0.0):
                yield point

    def zeros(self, across: int, value: float) -> Iterator[FloatArray | None]:
        ratios = np.geomspace(FARTHEST, NEAREST, NODES)
        if self.plane.names[1 - across] != INERTIA:

            def margin(nearness: float) -> float:
                whirl = self.whirl(across, value, nearness)
                return math.nan if whirl is None else self.margin(whirl)

            for nearness in _roots(margin, ratios):
                yield self.whirl(across, value, nearness)
            return

        # Whirls do not depend on the inertia, only their stability does.
        def unknowns(inertia: float, nearness: float) -> FloatArray:
            return np.array([*self.pair(across, value, inertia), nearness])

        inertias = np.linspace(self.plane.lower[1 - across], self.plane.upper[1 - across], NODES)
        for nearness in _roots(lambda nearness: self.balance(unknowns(float(inertias[0]), nearness)), ratios):

            def margin_at(inertia: float, nearness: float = nearness) -> float:
                return self.margin(unknowns(inertia, nearness))

            for inertia in _roots(margin_at, inertias):
                yield unknowns(inertia, nearness)

    @staticmethod
    def pair(across: int, value: float, other: float) -> tuple[float, float]:
        return (value, other) if across == 0 else (other, value)

    def whirl(self, across: int, value: float, *nearness: float) -> FloatArray | None:
        """Return the unknowns of the whirl at a ratio, on a line with one constant parameter, or None."""
        along = 1 - across
        low, high = self.plane.lower[along], self.plane.upper[along]

        def unknowns(other: float) -> FloatArray:
            return np.array([*self.pair(across, value, other), *nearness])

        def balance(other: float) -> float:
            return self.balance(unknowns(other))

        # The balance is monotonic in every parameter on one side of ω = Ω, so it has at most one zero.
        return unknowns(brentq(balance, low, high)) if balance(low) * balance(high) < 0.0 else None


def _traced(condition: _Condition, step: float) -> Iterator[Boundary]:
    scales = condition.plane.size if condition.kind == "onset" else np.append(condition.plane.size, SCALE)
    curves: list[FloatArray] = []
    for start in condition.starts():
        if any(_near(start / scales, curve) for curve in curves):
            continue
        curve = follow(condition.equations, condition.limits, start, scales, step=step)
        curves.append(curve.points / scales)
        yield Boundary(
            condition.kind,
            curve.points[:, :2],
            np.array([condition.alpha(point) for point in curve.points]),
            curve.closed,
        )


def _roots(function: Callable[[float], float], nodes: FloatArray) -> Iterator[float]:
    for (left, low), (right, high) in itertools.pairwise((node, function(node)) for node in nodes.tolist()):
        if low * high < 0.0:
            yield float(brentq(function, left, right))


def _near(point: FloatArray, curve: FloatArray) -> bool:
    """Return whether a point lies on the polygon through the points of a curve, within SAME."""
    begin, along = curve[:-1], np.diff(curve, axis=0)
    share = np.sum((point - begin) * along, axis=1) / np.sum(along**2, axis=1)
    feet = begin + np.clip(share, 0.0, 1.0)[:, np.newaxis] * along
    return bool(np.min(np.linalg.norm(feet - point, axis=1)) < SAME)
