"""Detection of implicit steps that skip a peak of friction, due to ``static_ratio`` or a Stribeck curve.

If friction falls within the slip change of a step, Newton's method may find a contact that holds, or a contact that
has passed its peak and runs away.
"""

import math
import warnings
from contextlib import AbstractContextManager, nullcontext
from typing import Any

import exudyn as exu
import numpy as np

from exudyn_models.forces.any_pair import change_of_slip
from exudyn_models.solver.contacts import contacts_of
from exudyn_models.solver.repeated_steps import user_function

RESOLVED = 0.05
"""Largest slip change of a step divided by ε: a contact then still holds 99 % of static friction (tested)."""

LEAST_FALL = 1e-3
"""Smallest relative fall of friction that counts as a peak."""


def peaks_resolved(mbs: Any, options: Any) -> AbstractContextManager[None]:
    """Repeat steps that skip a peak with a smaller step; warn if steps are fixed."""
    data, places = mbs.systemData, mbs.systemData.GetObjectLTGODE2
    contacts = [
        (np.array(places(item)), contact)
        for item, contact in contacts_of(mbs).items()
        if contact.stick is None and contact.factors.depends_on_slip
    ]
    times = exu.ConfigurationType.StartOfStep, exu.ConfigurationType.Current
    warned = False

    def look(t: float) -> list[float] | None:
        nonlocal warned
        step = t - data.GetTime(times[0])
        motions = [
            values(one) for one in times for values in (data.GetODE2Coordinates, data.GetODE2Coordinates_t)
        ]
        share = min(_right_share(contact, t, *[one[own] for one in motions]) for own, contact in contacts)
        if share == 1.0 or step <= 2.0 * options.minimumStepSize:
            return None
        if options.adaptiveStep:
            return [math.inf, 0.9 * share * step]
        if not warned:
            warned = True
            warnings.warn(
                f"the step of {step:.3g} s to t = {t:.6g} s skips a peak of friction, so a contact that should "
                f"hold may run away: use adaptiveStep = True or steps of {share * step:.2g} s",
                RuntimeWarning,
                stacklevel=4,
            )
        return None

    if not contacts:
        return nullcontext()
    return user_function(mbs, "PostNewton", lambda own: lambda mbs, t: look(t) or own(mbs, t))


def _right_share(contact: Any, t: float, start: Any, rates: Any, end: Any, end_rates: Any) -> float:
    """Return the share, up to 1, of a step that skips no peak of friction."""
    factors, reference = contact.factors, contact.reference
    before, after, change, spin, radius = change_of_slip(
        contact.kinds, factors.geometry, reference + start, rates, reference + end, end_rates
    )
    epsilon = factors.geometry[3]
    resolved = RESOLVED * epsilon
    passes_zero = before < epsilon or change > max(before, after - epsilon)
    if after <= epsilon or change <= resolved or not passes_zero:
        return 1.0
    peak = factors.friction_force(t, radius, epsilon, spin * epsilon / after)
    if factors.friction_force(t, radius, after, spin) >= (1.0 - LEAST_FALL) * peak:
        return 1.0
    return float(max(resolved, before - epsilon) / change)
