"""Steps across a peak of friction, as that of ``static_ratio`` or of Stribeck's curve, that implicit solvers skip.

Where friction falls within the slip change of a step, the equations of the step have several solutions: a contact
that holds, and one that has passed its peak and runs away. Newton's method finds either.
"""

from __future__ import annotations

import math
import warnings
from typing import Any

import exudyn as exu
import numpy as np

from exudyn_models.forces.any_pair import slip_in_step
from exudyn_models.forces.friction_laws import mean_radius
from exudyn_models.forces.stick_dampers import StickDampers
from exudyn_models.solver.step_limit import contacts_of
from reference_model.systems import FloatArray

RESOLVED = 0.05
"""Slip change of a step, over ε, that is small enough: the trapezoidal rule swings by half of it about the place where
a contact comes to hold, and there tests hold 99 % of what it can."""

LEAST_FALL = 1e-3
"""Fall of friction from its peak, over the peak, that counts."""


class PeakCheck:
    """Rejects steps of an assembled model that skip a peak of friction, or warns of the first one."""

    def __init__(self, mbs: Any, options: Any) -> None:
        self._options, self._warned = options, False
        found = [(item, contact) for item, contact, _ in contacts_of(mbs) if contact.factors.depends_on_slip]
        self.contacts = [
            (np.array(mbs.systemData.GetObjectLTGODE2(item)), contact) for item, contact in found
        ]

    def recommend(self, mbs: Any, t: float) -> list[float] | None:
        """Return what Exudyn takes for a step that is to be repeated with a smaller size, None for a right one."""
        data, start = mbs.systemData, exu.ConfigurationType.StartOfStep
        step = t - data.GetTime(start)
        motions = [
            (data.GetODE2Coordinates(one), data.GetODE2Coordinates_t(one))
            for one in (start, exu.ConfigurationType.Current)
        ]
        share = min(
            right_share(contact, t, *[(q[places], q_t[places]) for q, q_t in motions])
            for places, contact in self.contacts
        )
        if share == 1.0 or step <= 2.0 * self._options.minimumStepSize:
            return None
        if self._options.adaptiveStep:
            return [math.inf, 0.9 * share * step]
        if not self._warned:
            self._warned = True
            warnings.warn(
                f"the step of {step:.3g} s to t = {t:.6g} s skips a peak of friction, so that a contact that should "
                f"hold may run away: take adaptiveStep = True or steps of {share * step:.2g} s",
                RuntimeWarning,
                stacklevel=4,
            )
        return None


Motion = tuple[FloatArray, FloatArray]
"""Coordinates without reference values, and velocities."""


def right_share(contact: StickDampers, t: float, start: Motion, end: Motion) -> float:
    """Return the share, up to 1, of a step to the time t (s) that skips no peak of the friction of ``contact``."""
    geometry, friction = contact.factors.geometry, contact.factors.friction_force
    motions = contact.reference + start[0], start[1], contact.reference + end[0], end[1]
    before, after, change, least, spin, radius = slip_in_step(
        contact.kinds, *motions, geometry, mean_radius(geometry)
    )
    epsilon = geometry[3]
    if after <= epsilon or least >= epsilon or change <= RESOLVED * epsilon:
        return 1.0
    peak = friction(t, radius, epsilon, spin * epsilon / after)
    if friction(t, radius, after, spin) >= (1.0 - LEAST_FALL) * peak:
        return 1.0
    return max(RESOLVED * epsilon, before - epsilon) / change
