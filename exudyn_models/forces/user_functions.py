"""Force and Jacobian of a friction contact as user functions for Exudyn.

Rotors on one axis with a constant friction force need no compiled code.
"""

import math
from collections.abc import Callable
from functools import cache, partial
from typing import Any, cast

import numpy as np

from exudyn_models.forces.any_pair import (
    force_on_any,
    gradients_of_locked_slips,
    jacobian_on_any,
    locked_slips,
    locked_slips_of_pin,
    parameters_of,
    slip_on_any,
)
from exudyn_models.forces.axial_pairs import functions_on_axis, on_one_axis
from exudyn_models.forces.jit import FLOATS, LONGEST, TABLE, entry_point
from exudyn_models.forces.load_and_coefficient import LoadAndCoefficient
from exudyn_models.forces.planar_pairs import IN_THE_PLANE, force_in_the_plane, jacobian_in_the_plane
from exudyn_models.forces.slip_kinematics import Floats, Kinds
from reference_model.systems import FloatArray

ForceFunction = Callable[[Any, float, int, Floats, Floats], Floats]
JacobianFunction = Callable[[Any, float, int, Floats, Floats, float, float], FloatArray]


def force_and_jacobian(
    kinds: Kinds, reference: FloatArray, factors: LoadAndCoefficient
) -> tuple[ForceFunction, JacobianFunction]:
    """Return the user functions of force and Jacobian; ``reference`` contains the nodes' coordinates."""
    if on_one_axis(kinds, factors):
        return functions_on_axis(kinds, factors)
    in_plane = kinds in IN_THE_PLANE
    parameters = parameters_of(factors.contact or factors.geometry, kinds, reference)
    force = entry_point(force_in_the_plane if in_plane else force_on_any, *FORCE)
    slip = entry_point(slip_on_any, TABLE, FLOATS, FLOATS) if factors.depends_on_motion else None

    def motion(t: float, q: Floats, q_t: Floats) -> Motion:
        return (t, *slip(parameters, q, q_t)) if slip else (t, math.nan, math.nan, math.nan)

    def varying(mbs: Any, t: float, item: int, q: Floats, q_t: Floats) -> Floats:
        friction = factors.friction_force(*motion(t, q, q_t))
        return cast(Floats, force(parameters, friction, mbs, t, item, q, q_t))

    @cache  # compiled when first needed; explicit solvers never need it
    def derive() -> Callable[..., Any]:
        if in_plane and slip is None:
            return entry_point(jacobian_in_the_plane, *FORCE, float, float)
        return entry_point(jacobian_on_any, TABLE, *[float] * 3, *FORCE[1:], float, float)

    def jacobian(mbs: Any, t: float, item: int, q: Floats, q_t: Floats, *weights: float) -> FloatArray:
        known = motion(t, q, q_t)
        friction = 1.0 if factors.contact else factors.friction_force(*known)
        slopes = () if in_plane and slip is None else factors.friction_force_slopes(*known)
        return cast(FloatArray, derive()(parameters, friction, *slopes, mbs, t, item, q, q_t, *weights))

    return varying if factors.contact is None else partial(force, parameters, 1.0), jacobian


def constraint_and_gradients(kinds: Kinds, factors: LoadAndCoefficient, rim: float) -> tuple[Any, Any]:
    """Return the user functions of a constraint that lets a contact stick; ``rim`` (m) is 0 for a pin."""
    parameters = parameters_of(
        factors.geometry, kinds, np.zeros(LONGEST)
    )  # its coordinates need no reference
    slips = locked_slips if rim > 0.0 else locked_slips_of_pin
    gradients = entry_point(gradients_of_locked_slips, *FORCE, None)
    return partial(entry_point(slips, *FORCE, None), parameters, rim), partial(gradients, parameters, rim)


Motion = tuple[float, float, float, float]
"""Time (s), radius (m), slip speed (m/s) and relative spin (rad/s)."""

FORCE = TABLE, float, None, None, None, FLOATS, FLOATS
