"""Where formulas say that the motions change, as curves in the plane of a map.

They hold without offset, but for that of (5); a disc is taken on the continuous ring.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import Any, NamedTuple, get_args

import numpy as np

from compare.sweep.define.plan import Map
from reference_model.formulas.pin import largest_load_with_equilibrium
from reference_model.steady.bifurcation_curves import Kind, ParameterPlane, boundaries
from reference_model.systems import DiscOnDisc, FloatArray, PinOnDisc, System

NODES = 101
"""Values of each parameter between which the zeros of a margin are interpolated."""


class Curve(NamedTuple):
    """A curve: what happens there, and its points, shape (n, 2), in the units of the two parameters."""

    meaning: str
    points: FloatArray


class _Margin(NamedTuple):
    """What changes its sign on a curve."""

    meaning: str
    of: Callable[[Any], float]


PIN = (
    _Margin(r"(5): $\mu N = C|X_0|$", lambda pin: largest_load_with_equilibrium(pin) - pin.friction_force),
    _Margin(r"(11): $|\omega| = k$", lambda pin: abs(pin.disc_speed) - pin.natural_frequency),
)
DISC = (
    _Margin(
        r"sticking on the axis: $b|\omega-\Omega| = \mu N R$",
        lambda disc: (
            disc.shaft_damping * abs(disc.disc_speed - disc.shaft_speed)
            - disc.friction_force * disc.contact_radius
        ),
    ),
)
MEANINGS: dict[Kind, str] = {
    "Hopf": "the whirl loses its stability (Hopf)",
    "fold": "two whirls meet (fold)",
    "onset": "the rotation about the axis loses its stability",
}


def curves(plan: Map) -> tuple[Curve, ...]:
    """Return all curves in the plane of ``plan``."""
    found = list(_zeros(plan))
    if isinstance(plan.system, DiscOnDisc):
        found.extend(_boundaries(plan, plan.system))
    return tuple(found)


def _boundaries(plan: Map, disc: DiscOnDisc) -> Iterator[Curve]:
    """Yield what :mod:`reference_model.steady.bifurcation_curves` knows; nothing where it does not know the plane."""
    x, y = plan.x, plan.y
    centred = replace(disc, offset=0.0, contact_points=None)
    try:
        plane = ParameterPlane(centred, (x.name, y.name), (x.low, y.low), (x.high, y.high))
    except ValueError:  # a parameter that it does not have, or a range beyond the existence of whirls
        return
    for kind in get_args(Kind):
        for boundary in boundaries(plane, kind):
            yield Curve(MEANINGS[kind], boundary.parameters)


def _zeros(plan: Map) -> Iterator[Curve]:
    """Yield the curves on which the margins are zero."""
    from contourpy import contour_generator

    axes = [np.linspace(axis.low, axis.high, NODES) for axis in (plan.x, plan.y)]
    systems = [[_at(plan, x, y) for x in axes[0].tolist()] for y in axes[1].tolist()]
    for margin in PIN if isinstance(plan.system, PinOnDisc) else DISC:
        values = np.array([[margin.of(system) for system in row] for row in systems])
        for points in contour_generator(x=axes[0], y=axes[1], z=values).lines(0.0):
            yield Curve(margin.meaning, np.asarray(points))


def _at(plan: Map, x: float, y: float) -> System:
    changes: dict[str, Any] = {plan.x.name: x, plan.y.name: y}
    return replace(plan.system, **changes)
