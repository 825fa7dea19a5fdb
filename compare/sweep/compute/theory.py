"""Theory by formulas and continuation: motions along one parameter, and curves in the plane of a map."""

import math
from collections.abc import Callable, Iterator
from contextlib import suppress
from dataclasses import replace
from typing import Any, NamedTuple, get_args

import numpy as np

from compare.sweep.compute.motions import TheoryMotion, matched
from compare.sweep.plan import Continuation, Map
from reference_model import Orbit, self_centred_equilibria, whirl_orbit, whirls
from reference_model.formulas.pin import largest_load_with_equilibrium
from reference_model.steady.bifurcation_curves import Kind, ParameterPlane, boundaries
from reference_model.systems import DiscOnDisc, FloatArray, PinOnDisc, System

# --- Steady and periodic motions along one parameter

SAMPLES = 64
"""Number of samples of an orbit; the radius of a nearly circular orbit varies by 1e-3 between two samples."""


def theory_branches(plan: Continuation) -> list[dict[int, TheoryMotion]]:
    """Return branches as maps from indices of values to motions."""
    return matched(list(_motions_along(plan)), lambda one: one.meaning)


def _motions_along(plan: Continuation) -> Iterator[list[TheoryMotion]]:
    """Yield the motions at each value; a whirl with an offset continues the previous whirl."""
    orbit: Orbit | None = None
    for value in plan.x.values.tolist():
        change: dict[str, Any] = {plan.x.name: value}
        system = replace(plan.system, **change)
        here: list[TheoryMotion] = []
        with suppress(ValueError):  # no formula covers a disc on single points
            rests = self_centred_equilibria(system)
            here += [_circle("self-centred", math.hypot(one.x, one.y), one.stable) for one in rests]
        if system.offset == 0.0:
            with suppress(ValueError):
                here += [_circle("whirl", one.radius, one.stable) for one in whirls(system)]
        else:
            orbit = _orbit(system, orbit, plan.tolerance)
            if orbit is not None:
                radii = orbit.trajectory.radius
                here.append(TheoryMotion("whirl", float(radii.min()), float(radii.max()), orbit.stable))
        yield here


def _orbit(system: System, before: Orbit | None, tolerance: float) -> Orbit | None:
    """Return the whirl by shooting from the previous whirl, or from the circle without offset."""
    for guess in (before, None) if before is not None else (None,):
        with suppress(ValueError, RuntimeError):  # no whirl exists, or shooting fails
            return whirl_orbit(system, guess=guess, tolerance=tolerance, samples=SAMPLES)
    return None


def _circle(meaning: str, radius: float, stable: bool) -> TheoryMotion:
    return TheoryMotion(meaning, radius, radius, stable)


# --- Boundaries between motions according to formulas, as curves in the plane of a map
#
# All except (5) hold without offset; a disc is treated as a continuous ring.

NODES = 101  # values of each parameter; zeros of a margin are interpolated


class Curve(NamedTuple):
    """A boundary: its meaning, and its points, shape (n, 2)."""

    meaning: str
    points: FloatArray


class _Margin(NamedTuple):
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
    """Yield the curves of :mod:`reference_model.steady.bifurcation_curves`, if it supports the plane."""
    x, y = plan.x, plan.y
    centred = replace(disc, offset=0.0, contact_points=None)
    try:
        plane = ParameterPlane(centred, (x.name, y.name), (x.low, y.low), (x.high, y.high))
    except ValueError:  # an unsupported parameter, or a range without whirls
        return
    for kind in get_args(Kind):
        for boundary in boundaries(plane, kind):
            yield Curve(MEANINGS[kind], boundary.parameters)


def _zeros(plan: Map) -> Iterator[Curve]:
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
