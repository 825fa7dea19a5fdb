"""A rectangle in two parameters of a disc, in which boundaries are traced."""

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
"""On which curves are looked for, in each direction of the plane."""

INSET = 1e-6
"""Distance of the outermost lines from the borders of a plane, so that all starts are inside."""


@dataclass(frozen=True)
class ParameterPlane:
    """A rectangle in two parameters of a disc; the others are those of ``disc``.

    Parameters
    ----------
    disc : DiscOnDisc
        The other parameters.
    names : tuple of str
        The two parameters, as the fields of ``DiscOnDisc`` are called; all but those of contact and stop.
    lower, upper : tuple of float
        Their ranges.

    Raises
    ------
    ValueError
        If a name is no parameter, a range is empty or reaches where no whirl exists at any load, or if there is
        an offset or a support that is not linear.

    """

    disc: DiscOnDisc
    names: tuple[str, str]
    lower: tuple[float, float]
    upper: tuple[float, float]

    def __post_init__(self) -> None:
        """Refuse a plane in which nothing can be traced."""
        if self.disc.offset != 0.0:
            raise ValueError(
                f"offset = {self.disc.offset:g} m: boundaries are known for whirls without offset"
            )
        require_linear_support(self.disc)
        # A contact that is handed over has a radius of its own.
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
        """Return the disc with the two parameters of these values."""
        changes: dict[str, Any] = dict(zip(self.names, map(float, values), strict=True))
        return DiscOnDisc(**vars(self.disc) | changes)  # in half the time of replace()

    def lines(self, which: int) -> FloatArray:
        """Return the values of one parameter on the lines where curves are looked for, shape (LINES,)."""
        inset = INSET * self.size[which]
        return np.linspace(self.lower[which] + inset, self.upper[which] - inset, LINES)

    @property
    def size(self) -> FloatArray:
        """Length of both ranges, shape (2,)."""
        return np.subtract(self.upper, self.lower)
