"""Friction at single points. It depends on the angle φ, because the points turn with the disc."""

from __future__ import annotations

import cmath
import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from reference_model.systems import (
    MOST_POINTS,
    FloatArray,
    Place,
    checked_places,
    positive_number,
    require_whole,
)


@dataclass(frozen=True, repr=False)
class Points:
    """Contact in points at any positions, each with its share of the load.

    ``places`` contains (x, y, share) of each point, in m relative to the disc's centre at φ = 0. Raises
    ``ValueError`` unless at least two positions differ and the shares are positive and sum to 1.
    """

    places: Sequence[Place]

    def __post_init__(self) -> None:
        object.__setattr__(self, "places", checked_places("places", self.places))

    def __repr__(self) -> str:
        return f"{type(self).__name__}({len(self.places)} places)"

    def __iter__(self) -> Iterator[Place]:
        return iter(self.places)

    @cached_property
    def shares(self) -> tuple[float, ...]:
        return tuple(share for _, _, share in self.places)

    @cached_property
    def _arms(self) -> tuple[complex, ...]:
        return tuple(complex(x, y) for x, y, _ in self.places)

    @cached_property
    def _seen_from(self) -> dict[int | None, tuple[_Friction, ...]]:
        """All other points relative to each point requested so far; for None all points relative to the centre."""
        return {None: tuple((arm, arm.conjugate(), share) for arm, share in self._loaded)}

    @property
    def _loaded(self) -> Iterator[tuple[complex, float]]:
        return zip(self._arms, self.shares, strict=True)

    def arm(self, point: int, angle: float) -> complex:
        return cmath.exp(1j * angle) * self._arms[point]

    def arms(self, angle: float) -> list[complex]:
        turn = cmath.exp(1j * angle)
        return [turn * arm for arm in self._arms]

    def spacing(self, point: int) -> float:
        distances = abs(np.array(self._arms) - self._arms[point])
        return float(np.delete(distances, point).min())

    def force_and_moment(self, slip: complex, relative_spin: float, angle: float) -> tuple[complex, float]:
        """Like :meth:`Contact.force_and_moment`; a point at rest contributes nothing."""
        return _friction_of(self._seen_from[None], slip, relative_spin, angle)

    def friction_of_others(
        self, point: int, slip: complex, relative_spin: float, angle: float
    ) -> tuple[complex, float]:
        """Return force and moment of all points but ``point``, which slips with ``slip``."""
        if point not in self._seen_from:
            own = self._arms[point]
            self._seen_from[point] = tuple(
                (arm - own, arm.conjugate(), share)
                for i, (arm, share) in enumerate(self._loaded)
                if i != point
            )
        return _friction_of(self._seen_from[point], slip, relative_spin, angle)

    def jacobian(self, slip: complex, relative_spin: float, angle: float) -> FloatArray:
        result = np.zeros((3, 4))
        for arm, share in zip(self.arms(angle), self.shares, strict=True):
            velocity = slip - 1j * relative_spin * arm
            speed = abs(velocity)
            if speed == 0.0:
                raise ValueError(
                    f"angle = {angle:g} rad: a point is at rest, where friction has no derivative"
                )
            direction = velocity / speed
            across = 1j * direction
            # Derivatives of the point's slip in u_x, u_y, S, φ. Only the component across the slip changes friction.
            by_unknowns = np.array((1.0, 1j, -1j * arm, relative_spin * arm))
            turning = -share * ((by_unknowns * across.conjugate()).real / speed)
            friction = turning * across
            result[0] += friction.real
            result[1] += friction.imag
            result[2] += (arm.conjugate() * friction).imag
            result[2, 3] += share * ((1j * arm).conjugate() * -direction).imag
        return result


@dataclass(frozen=True, init=False)
class PointsOnRing(Points):
    """Contact in n points on a circle of ``radius`` R in m, each with 1/n of the load.

    Point i of ``points`` = n (3 to 1000) lies at φ + 2πi/n. The paper uses n = 6.
    """

    radius: float
    points: int

    def __init__(self, radius: float, points: int) -> None:
        object.__setattr__(self, "radius", positive_number("radius", radius, "m"))
        require_whole("points", points, least=3, most=MOST_POINTS)
        object.__setattr__(self, "points", points)
        around = (cmath.rect(self.radius, 2.0 * math.pi * i / points) for i in range(points))
        super().__init__([(arm.real, arm.imag, 1.0 / points) for arm in around])

    def __repr__(self) -> str:
        return f"PointsOnRing(radius={self.radius!r}, points={self.points!r})"


_Friction = tuple[complex, complex, float]
"""Position relative to the point with the given slip, conjugate of the arm, and share."""


def _friction_of(
    points: Iterable[_Friction], slip: complex, relative_spin: float, angle: float
) -> tuple[complex, float]:
    turn = cmath.exp(1j * angle)
    turning = 1j * relative_spin * turn
    force = moment = 0j
    for place, conjugate_arm, share in points:
        velocity = slip - turning * place
        speed = abs(velocity)
        if speed > 0.0:
            friction = velocity * (-share / speed)
            force += friction
            moment += conjugate_arm * friction
    return force, (turn.conjugate() * moment).imag
