"""Force and Jacobian of a friction contact as the user functions that Exudyn calls.

Where μN is a number Exudyn calls compiled code as it would call Python; where it is a function of time there is a
call of Python in between, and one that depends on the motion multiplies in Python what compiled code finds for 1 N.
Rotors on one axis need no compiled code.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from typing import Any, cast

import numpy as np

from exudyn_models.forces.any_pair import (
    force_on_any,
    friction_derivatives_on_nodes,
    friction_on_nodes,
    jacobian_on_any,
)
from exudyn_models.forces.axial_pairs import functions_on_axis, on_one_axis
from exudyn_models.forces.friction_laws import CONTACT_SIZE
from exudyn_models.forces.jit import taking_lists
from exudyn_models.forces.load_and_coefficient import LoadAndCoefficient
from exudyn_models.forces.planar_pairs import LAWS
from exudyn_models.forces.slip_kinematics import Floats, Kinds
from exudyn_models.forces.stick_dampers import StickDampers
from reference_model.systems import FloatArray

ForceFunction = Callable[[Any, float, int, Floats, Floats], Floats]
JacobianFunction = Callable[[Any, float, int, Floats, Floats, float, float], FloatArray]


def force_and_jacobian(
    kinds: Kinds, reference: FloatArray, factors: LoadAndCoefficient
) -> tuple[ForceFunction, JacobianFunction]:
    """Return both functions for load and coefficient as they are now and the nodes' ``reference`` coordinates.

    The force carries the ``StickDampers`` of the contact.
    """
    if on_one_axis(kinds, factors):
        force, jacobian = functions_on_axis(kinds, factors)
    elif factors.depends_on_motion:
        force = _force_by_motion(kinds, reference, factors)
        jacobian = _jacobian_by_motion(kinds, reference, factors)
    else:
        laws = LAWS.get(kinds, (force_on_any, jacobian_on_any))
        rest, size = [*kinds, *reference.tolist()], len(reference)
        sizes = CONTACT_SIZE + len(rest), None, None, None, size, size
        force = _under(factors, rest, taking_lists(laws[0], *sizes))
        jacobian = _under(factors, rest, taking_lists(laws[1], *sizes, float, float))
    setattr(force, _DAMPERS, StickDampers(kinds, reference, factors))
    return force, jacobian


_DAMPERS = "stick_dampers"


def stick_dampers_of(force: Any) -> StickDampers | None:
    """Return what a ``force`` of ``force_and_jacobian`` carries, None for any other function."""
    return getattr(force, _DAMPERS, None)


def _under(factors: LoadAndCoefficient, rest: Floats, evaluate: Callable[..., Any]) -> Callable[..., Any]:
    """Return a function with parameters before its other arguments as one with those of the ``factors``."""
    if factors.contact is not None:
        return partial(evaluate, [float(number) for number in (*factors.contact, *rest)])

    def function(mbs: Any, t: float, *motion: Any) -> Any:
        return evaluate([*factors.contact_at(t), *rest], mbs, t, *motion)

    return function


def _force_by_motion(kinds: Kinds, reference: FloatArray, factors: LoadAndCoefficient) -> ForceFunction:
    def force(mbs: Any, t: float, item: int, q: Sequence[float], q_t: Sequence[float]) -> list[float]:
        contact = factors.contact_at(t)
        forces, *motion = friction_on_nodes(kinds, reference + q, np.array(q_t), contact)
        forces *= factors.friction_force(t, *motion)
        return cast(list[float], forces.tolist())

    return force


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
        contact = factors.contact_at(t)
        state = kinds, reference + q, np.array(q_t)
        derivatives, motion_derivatives = friction_derivatives_on_nodes(
            *state, position_factor, velocity_factor, contact
        )
        forces, *motion = friction_on_nodes(*state, contact)
        derivatives *= factors.friction_force(t, *motion)
        derivatives += np.outer(forces, factors.friction_force_slopes(t, *motion) @ motion_derivatives)
        return -derivatives  # Exudyn takes those of the left-hand side

    return jacobian
