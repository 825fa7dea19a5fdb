"""A rectangle in two parameters of a disc, for the search for boundaries."""

from __future__ import annotations

import itertools
from collections.abc import Iterable
from dataclasses import dataclass, fields
from typing import Any

import numpy as np

from reference_model.formulas.disc import pin_of
from reference_model.formulas.pin import whirl_radius
from reference_model.support import require_linear_support
from reference_model.systems import DiscOnDisc, FloatArray

LINES = 9
"""Number of starting lines in each direction of the plane."""

INSET = 1e-6
"""Distance of the outermost lines from the borders of a plane, so that all starts lie inside."""


@dataclass(frozen=True)
class ParameterPlane:
    """A rectangle in two parameters of a disc; all others are those of ``disc``.

    ``names`` are those of two parameters in ``DiscOnDisc``, except contact, offset and nonlinear support; ``lower``
    and ``upper`` are the limits of their ranges. Raises ``ValueError`` if a name is not allowed, a range is empty
    or includes parameters without a whirl at any load, or there is an offset or a nonlinear support.
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
                raise ValueError(f"disc_speed from {low:g} to {high:g} rad/s: there is no whirl at rest")
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
