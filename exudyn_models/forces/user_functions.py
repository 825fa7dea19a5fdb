"""Force and Jacobian of a friction contact as user functions for Exudyn.

Python assembles the Jacobian of a friction force that depends on the motion; the rest is compiled. Rotors on one axis
with a constant friction force need no compiled code.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import cache, partial
from typing import Any

import numpy as np

from exudyn_models.forces.any_pair import (
    force_on_any,
    force_on_mounted,
    friction_derivatives_on_nodes,
    jacobian_on_any,
    jacobian_on_mounted,
)
from exudyn_models.forces.axial_pairs import functions_on_axis, on_one_axis
from exudyn_models.forces.friction_laws import CONTACT_SIZE, Contact
from exudyn_models.forces.jit import KeptOnDisk, taking_lists
from exudyn_models.forces.laws.product import LAW
from exudyn_models.forces.load_and_coefficient import LoadAndCoefficient
from exudyn_models.forces.planar_pairs import LAWS
from exudyn_models.forces.slip_kinematics import Floats, Kinds
from reference_model.systems import FloatArray

derivatives_on_nodes = KeptOnDisk(friction_derivatives_on_nodes)

ForceFunction = Callable[[Any, float, int, Floats, Floats], Floats]
JacobianFunction = Callable[[Any, float, int, Floats, Floats, float, float], FloatArray]


def force_and_jacobian(
    kinds: Kinds, reference: FloatArray, factors: LoadAndCoefficient
) -> tuple[ForceFunction, JacobianFunction]:
    """Return the user functions of force and Jacobian; ``reference`` contains the nodes' coordinates."""
    if on_one_axis(kinds, factors):
        return functions_on_axis(kinds, factors)
    return _compiled_functions(kinds, reference, factors)


def _compiled_functions(
    kinds: Kinds, reference: FloatArray, factors: LoadAndCoefficient
) -> tuple[ForceFunction, JacobianFunction]:
    master, disc, mounts = kinds
    any_pair = (force_on_mounted, jacobian_on_mounted) if mounts else (force_on_any, jacobian_on_any)
    force, jacobian = LAWS.get(kinds, any_pair)
    first, rest, size = mounts or (), [master, disc, *reference.tolist()], len(reference)
    numbers = len(first) + CONTACT_SIZE + len(rest)
    law_and_time = (None, None, None) if factors.law is None else (LAW, None, float)
    evaluate = taking_lists(force, numbers, *law_and_time, None, size, size)
    bound = partial(evaluate, _numbers(first, factors.contact or factors.geometry, rest), factors.law)
    if factors.depends_on_motion:
        return bound, _jacobian_by_motion(kinds, reference, factors)

    @cache  # compiled when first needed; explicit solvers never need it
    def derive() -> Callable[..., Any]:
        return taking_lists(jacobian, numbers, None, None, None, size, size, float, float)

    constant = None if factors.contact is None else _numbers(first, factors.contact, rest)

    def jacobian_by_time(mbs: Any, t: float, *motion: Any) -> Any:
        return derive()(constant or _numbers(first, factors.contact_at(t), rest), mbs, t, *motion)

    return bound, jacobian_by_time


def _numbers(first: Floats, contact: Contact, rest: Floats) -> list[float]:
    return [float(number) for number in (*first, *contact, *rest)]


def _jacobian_by_motion(kinds: Kinds, reference: FloatArray, factors: LoadAndCoefficient) -> JacobianFunction:
    def jacobian(
        mbs: Any,
        t: float,
        item: int,
        q: Sequence[float],
        q_t: Sequence[float],
        position_factor: float,
        velocity_factor: float,
    ) -> FloatArray:
        derivatives, motion_derivatives, (forces, *motion) = derivatives_on_nodes(
            kinds, reference + q, np.array(q_t), position_factor, velocity_factor, factors.geometry
        )
        derivatives *= factors.friction_force(t, *motion)
        derivatives += np.outer(forces, factors.friction_force_slopes(t, *motion) @ motion_derivatives)
        return np.asarray(-derivatives)  # Exudyn expects derivatives of the negative force

    return jacobian
