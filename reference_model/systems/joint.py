"""A joint with dry friction: frozen, validated parameters in SI units."""

import math
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any, ClassVar, TypeAlias

import numpy as np

from reference_model.systems import (
    COLUMNS,
    LEAST,
    MOST,
    MOST_RATIO,
    System,
    checked_parameter,
    finite_number,
    shown,
)


@dataclass(frozen=True, kw_only=True)
class FrictionJoint:
    """A body that turns about a fixed axis, with Coulomb friction in the joint.

    J·φ̈ = M(t) − C·(φ − φ₀) − β·φ̇ − F·sign(φ̇). At rest, friction balances any load |M − C·(φ − φ₀)| up to the static
    ratio times F. The state is the angle φ in rad and the spin φ̇ in rad/s. Raises ``ValueError`` if a value is not
    finite or out of range.

    Parameters
    ----------
    inertia
        J in kg m², > 0.
    friction_moment
        F in N m, >= 0: the friction moment of a joint that turns.
    static_ratio
        Largest friction moment at rest, divided by F, >= 1.
    damping
        β in N m s/rad, >= 0.
    stiffness
        C in N m/rad, >= 0.
    offset
        φ₀ in rad, the angle of the relaxed spring.
    moment
        Applied moment as points (t, M) in s and N m, with increasing times. It is linear between two points, constant
        before the first and after the last, and 0 without points.

    """

    inertia: float
    friction_moment: float
    static_ratio: float = 1.0
    damping: float = 0.0
    stiffness: float = 0.0
    offset: float = 0.0
    moment: tuple[tuple[float, float], ...] = ()

    state_size: ClassVar[int] = 2
    _parameters: ClassVar[dict[str, tuple[str, float]]] = {  # unit and smallest value
        "inertia": ("kg m²", LEAST),
        "friction_moment": ("N m", 0.0),
        "damping": ("N m s/rad", 0.0),
        "stiffness": ("N m/rad", 0.0),
        "offset": ("rad", -MOST),
    }

    def __post_init__(self) -> None:
        for name, (unit, least) in self._parameters.items():
            object.__setattr__(self, name, checked_parameter(name, getattr(self, name), unit, least))
        ratio = finite_number("static_ratio", self.static_ratio)
        if not 1.0 <= ratio <= MOST:
            raise ValueError(f"static_ratio = {ratio:g}: it must be >= 1")
        object.__setattr__(self, "static_ratio", ratio)
        object.__setattr__(self, "moment", _points(self.moment))
        for name, formula, rate in (
            ("stiffness", "√(stiffness/inertia)", math.sqrt(self.stiffness / self.inertia)),
            ("damping", "damping/inertia", self.damping / self.inertia),
        ):
            if rate > MOST_RATIO:
                raise ValueError(
                    f"{name} = {getattr(self, name):g}: {formula} must be at most {MOST_RATIO:g}"
                )

    @property
    def breakaway_moment(self) -> float:
        """Largest load in N m that friction holds at rest."""
        return self.static_ratio * self.friction_moment

    def applied(self, time: float) -> float:
        """Return the applied moment M in N m at ``time`` in s."""
        if not self.moment:
            return 0.0
        times, values = zip(*self.moment, strict=True)
        return float(np.interp(time, times, values))


def _points(moment: Any) -> tuple[tuple[float, float], ...]:
    """Return ``moment`` as points of floats; raise ``ValueError`` unless their times increase."""
    points: list[tuple[float, float]] = []
    for i, point in enumerate(moment if isinstance(moment, Iterable) else [moment]):
        if not isinstance(point, Iterable) or len(pair := tuple(point)) != 2:
            raise ValueError(f"moment[{i}] = {shown(point)}: it must be (t, M), in s and N m")
        time, value = (finite_number(f"moment[{i}]", number) for number in pair)
        if max(abs(time), abs(value)) > MOST:
            raise ValueError(f"moment[{i}] = {shown(point)}: its size must be at most {MOST:g}")
        if points and time <= points[-1][0]:
            raise ValueError(f"moment[{i}] = {shown(point)}: the times of the points must increase")
        points.append((time, value))
    return tuple(points)


AnySystem: TypeAlias = System | FrictionJoint
"""A system that ``reference_model.simulate`` simulates."""

COLUMNS[FrictionJoint] = (("angle", "rad"), ("spin", "rad/s"))
