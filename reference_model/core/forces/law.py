"""Scaled parameters of a motion, and the point of the body whose velocity is an unknown."""

import math
from collections.abc import Callable
from typing import Any, NamedTuple

from reference_model.numerics.parts import inlined, part
from reference_model.systems import FloatArray

CENTRE = -1
"""Index of the centre in place of a contact point."""

OWN = -1.0
"""``Law.load`` of a friction law that only interpreted runs support."""

WIDTH = 7
"""Number of values per contact point."""


class Law(NamedTuple):
    """Scaled parameters, with forces divided by the mass.

    ``hold`` is the friction that can hold the centre at rest, negative if friction cannot hold the shaft's moment.
    For ``outer``, ``inner`` (over κ) and ``load`` see :func:`reference_model.core.forces.contact.shares`. A law
    of the user, ``own``, has the load OWN; ``outer`` and ``inner`` are its resting radii.
    ``shaft`` is b/J, ``lag`` κ(ω − Ω), and ``gyration`` κ. ``stretch`` is s₀ of the stretched time.

    ``around`` contains seven numbers for each contact point: its position η (x, y) in the frame of the disc, divided
    by κ; its share q of the load; the force (x, y) and the moment of all points per unit of friction if the disc
    turns about it in the positive sense; the distance to its neighbour. It is empty for a pin and a ring.

    The unknown is the slip of the centre or of the contact point ``point``, which lies at (``arm_x``, ``arm_y``) and
    carries ``share``. ``sense`` is ±1 if this point rests and the disc turns about it, otherwise 0.
    """

    damping: float
    stiffness: float
    offset: float
    hardening: float
    gap: float
    stop: float
    friction: float
    hold: float
    omega: float
    outer: float
    inner: float
    load: float
    shaft: float
    lag: float
    gyration: float
    stretch: float
    around: FloatArray
    own: Any
    point: int
    arm_x: float
    arm_y: float
    share: float
    sense: float


@inlined
def arm(angle: float, law: Law) -> tuple[float, float]:
    """Return the arm of the point that ``law`` follows, relative to the centre."""
    c, s = math.cos(angle), math.sin(angle)
    return c * law.arm_x - s * law.arm_y, s * law.arm_x + c * law.arm_y


@part
def seen_from(point: int, sense: float, law: Law) -> Law:
    """Return the law with the slip of ``point`` as an unknown, at rest if ``sense`` is not 0."""
    x, y, share = 0.0, 0.0, 1.0
    if point != CENTRE:
        x, y, share = law.around[WIDTH * point], law.around[WIDTH * point + 1], law.around[WIDTH * point + 2]
    return Law(
        law.damping, law.stiffness, law.offset, law.hardening, law.gap, law.stop, law.friction, law.hold,
        law.omega, law.outer, law.inner, law.load, law.shaft, law.lag, law.gyration, law.stretch, law.around,
        law.own, point, x, y, share, sense,
    )  # fmt: skip


SCALARS = 16
"""Number of fields before ``around``."""


HARDENING, STOP, FRICTION, HOLD, SHAFT = (
    Law._fields.index(name) for name in ("hardening", "stop", "friction", "hold", "shaft")
)
"""Places of some parameters in an array of them."""


def _unpacked() -> Any:
    namespace: dict[str, Any] = {"Law": Law}
    arguments = ", ".join(f"parameters[{i}]" for i in range(SCALARS))
    exec(
        f"def unpacked(parameters, around):\n    return Law({arguments}, around, 0.0, {CENTRE}, 0.0, 0.0, 1.0, 0.0)",
        namespace,
    )
    return part(namespace["unpacked"])


unpacked: Callable[[FloatArray, FloatArray], Law] = _unpacked()
"""Return the law with the parameters in an array: numba takes 0.3 ms to pass a named tuple from Python."""
