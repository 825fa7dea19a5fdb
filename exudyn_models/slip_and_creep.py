"""A motion in turns of slip and creep, each by the solver that suits it."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial
from typing import Any, cast

import numpy as np

from exudyn_models.creep import WHOLE, creep_ratio_rates, creep_ratios, creeping
from exudyn_models.models import build
from exudyn_models.ring_friction import add_ring_friction
from exudyn_models.scales import settling_time, time_scale
from exudyn_models.solving import Steps, joined, solve
from exudyn_models.supported_body import Model
from reference_model.systems import DiscOnDisc, FloatArray, System

CREEP_NEWTON_TOLERANCE = 1e-6
"""Residual of Newton's iteration while creeping, relative to μN (and μN·R, where that is less).

It is a millionth of the creep, and above rounding down to ε ~ 1e-11.
"""

VISCOUS_RANGE = 2.0**40
"""By how much the viscous part of the friction law is continued in the model of a creeping system."""


Part = int | frozenset[int]
"""What of a contact creeps: ``WHOLE``, or some of several points by what an ``add`` takes as ``held``."""

Creeping = Callable[[System, list[float], float], Part | None]


@dataclass(frozen=True)
class Friction:
    """A way to put friction between two discs.

    ``add`` adds it to a model, as ``AddFriction`` describes. ``creeping`` is a function like ``creep.creeping``: it
    says what of the contact creeps so that a model in which it stays viscous can take over; for some of several
    points that is made by the argument ``held`` of ``add``.
    """

    add: Callable[..., Any]
    creeping: Creeping


RING_FRICTION = Friction(add_ring_friction, creeping)


def solve_in_turns(
    system: System,
    state: FloatArray,
    span: float,
    epsilon: float,
    *,
    integrator: str,
    step: float,
    tolerance: float,
    friction: Friction,
) -> Steps:
    """Solve for ``span`` s with ``integrator`` where the contact slips, generalised-α where some of it creeps.

    There an explicit method would need steps of 3·mε/μN. The implicit one is of second order: its step makes its
    error, a phase error of the rotation of (ωh)²/12, one per cent of the creep that the regularisation itself makes,
    so that both fall together.

    What creeps, all of the contact or one of several points, feels the viscous part of the law only. Meanwhile the
    model is therefore one in which that part has no end, and Newton's iteration can not be thrown off by the bend of
    the law. The explicit method takes over as soon as something else creeps, or nothing.
    """
    settling = 0.0
    since, part = math.inf, cast(Part | None, None)

    def not_settled(t: float, state: list[float]) -> bool:
        nonlocal since, part
        now = friction.creeping(system, state, epsilon)
        if now != part:
            since, part = (math.inf if now is None else t), now
        return t - since < settling

    start, end = 0.0, span
    runs: list[Steps] = []
    while start < end or not runs:
        settling = settling_time(system, epsilon, min(step, _creep_step(system, state, epsilon, end - start)))
        since, part = math.inf, None
        model = build(system, state, regularisation=epsilon, friction=friction.add)
        runs.append(
            solve(model, start, end, integrator=integrator, step=step, tolerance=tolerance, watch=not_settled)
        )
        state, start = runs[-1].states[-1], float(runs[-1].times[-1])
        if part is None or start >= end:
            break
        creep_step = min(step, _creep_step(system, state, epsilon, end - start))
        if part != WHOLE:
            creep_step = min(creep_step, _pivot_step(system, runs[-1], epsilon))
        runs.append(
            solve(
                _creep_model(system, state, epsilon, part, friction.add),
                start,
                end,
                integrator="GeneralizedAlpha",
                step=creep_step,
                tolerance=CREEP_NEWTON_TOLERANCE * system.friction_force * _lever(system),
                watch=_Creep(system, state, epsilon, part, friction.creeping),
            )
        )
        state, start = runs[-1].states[-1], float(runs[-1].times[-1])
    return joined(runs)


class _Creep:
    """Watches whether ``part`` goes on creeping, and at much the same speed of the pivoting disc if it is a point."""

    def __init__(
        self, system: System, state: FloatArray, epsilon: float, part: Part, creeping: Creeping
    ) -> None:
        self.creeping, self.system, self.epsilon, self.part = creeping, system, epsilon, part
        self.speed = self._mean_slip(state)

    def __call__(self, t: float, state: list[float]) -> bool:
        if self.creeping(self.system, state, self.epsilon) != self.part:
            return False
        return self.part == WHOLE or 0.5 < self._mean_slip(np.array(state)) / self.speed < 2.0

    def _mean_slip(self, state: FloatArray) -> float:
        return float(creep_ratios(self.system, state[None, :], self.epsilon)[0, WHOLE])


def _creep_step(system: System, state: FloatArray, epsilon: float, span: float) -> float:
    """Return the step in s of generalised-α for creep of all the contact from ``state``, at most 0.01 time scales."""
    x, y = state[:2]
    longest = 0.01 * time_scale(system, state, span)
    rotation = abs(system.disc_speed) ** 3 * math.hypot(x, y)
    return min(longest, math.sqrt(0.12 * epsilon / rotation)) if rotation > 0.0 else longest


def _pivot_step(system: System, steps: Steps, epsilon: float) -> float:
    """Return the step for a disc on points that pivots about one of them, from the last of ``steps``.

    It turns with its spin at the distance R from the point, and its slip P changes in a time P/|dP/dt|.
    """
    ratio = creep_ratios(system, steps.states[-1:], epsilon)[0, WHOLE]
    rate = creep_ratio_rates(system, steps.states[-1], steps.accelerations[-1], epsilon)[WHOLE]
    radius = system.contact_radius if isinstance(system, DiscOnDisc) else 0.0
    turning = abs(steps.states[-1, 5]) ** 3 * radius
    return math.sqrt(0.12 * epsilon / (turning + epsilon * rate**2 / ratio))


def _creep_model(
    system: System, state: FloatArray, epsilon: float, part: Part, add_friction: Callable[..., Any]
) -> Model:
    """Build ``system`` in which ``part`` of the contact creeps without an end to the creep."""
    if part != WHOLE:
        held = partial(add_friction, held=part)
        return build(system, state, regularisation=epsilon, friction=held)
    viscous = replace(system, friction_force=VISCOUS_RANGE * system.friction_force)
    return build(viscous, state, regularisation=VISCOUS_RANGE * epsilon, friction=add_friction)


def _lever(system: System) -> float:
    """Return the length in m by which a residual moment counts as a force: R, or 1 if that is less."""
    return min(1.0, system.contact_radius) if isinstance(system, DiscOnDisc) else 1.0
