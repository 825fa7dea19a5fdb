"""The steady and periodic motions that formulas and continuation give along one parameter."""

from __future__ import annotations

import math
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import replace
from typing import Any, NamedTuple

from compare.sweep.compute.motions import matched
from compare.sweep.define.plan import Continuation
from reference_model import Orbit, self_centred_equilibria, whirl_orbit, whirls
from reference_model.systems import System

SAMPLES = 64
"""Of an orbit, on which its radii are looked for: between two the radius of one near to a circle differs by 1e-3."""


class Known(NamedTuple):
    """A motion: what it is, least and largest radius in m, whether it is stable."""

    meaning: str
    least: float
    largest: float
    stable: bool


def known_branches(plan: Continuation) -> list[dict[int, Known]]:
    """Return branches of motions, each by the places of the values of the axis."""
    return matched(list(_known(plan)), lambda one: one.meaning)


def _known(plan: Continuation) -> Iterator[list[Known]]:
    """Yield the motions at each value.

    A whirl with an offset is sought from that of the value before.
    """
    orbit: Orbit | None = None
    for value in plan.x.values.tolist():
        change: dict[str, Any] = {plan.x.name: value}
        system = replace(plan.system, **change)
        here: list[Known] = []
        with suppress(ValueError):  # of a disc on single points, of which no formula knows
            rests = self_centred_equilibria(system)
            here += [_circle("self-centred", math.hypot(one.x, one.y), one.stable) for one in rests]
        if system.offset == 0.0:
            with suppress(ValueError):
                here += [_circle("whirl", one.radius, one.stable) for one in whirls(system)]
        else:
            orbit = _orbit(system, orbit, plan.tolerance)
            if orbit is not None:
                radii = orbit.trajectory.radius
                here.append(Known("whirl", float(radii.min()), float(radii.max()), orbit.stable))
        yield here


def _orbit(system: System, before: Orbit | None, tolerance: float) -> Orbit | None:
    """Return the whirl by shooting from that of the value before, or else from the circle without offset."""
    for guess in (before, None) if before is not None else (None,):
        with suppress(ValueError, RuntimeError):  # there is none, or it is not found
            return whirl_orbit(system, guess=guess, tolerance=tolerance, samples=SAMPLES)
    return None


def _circle(meaning: str, radius: float, stable: bool) -> Known:
    return Known(meaning, radius, radius, stable)
