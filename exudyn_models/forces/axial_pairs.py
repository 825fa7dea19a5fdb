"""Friction of a rotor on a rotor or on the ground about one axis, without compiled code if constant.

The whole contact slips in circumferential direction, and force and slip of the centre are zero. With the mean radius
r of the contact P = r·|S|, and M = −μN·r·sign(S), times P/ε if P < ε. Points share this equally.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import partial
from typing import Any

import numpy as np

from exudyn_models.forces.friction_laws import NONE_HELD, Contact, mean_radius
from exudyn_models.forces.jit import compiled, taking_lists
from exudyn_models.forces.laws.product import LAW, Law, friction_force_under
from exudyn_models.forces.load_and_coefficient import LoadAndCoefficient
from exudyn_models.forces.slip_kinematics import GROUND, ROTOR, Floats, Kinds
from reference_model.systems import FloatArray


def on_one_axis(kinds: Kinds, factors: LoadAndCoefficient) -> bool:
    """Return whether ``functions_on_axis`` apply to this contact."""
    return kinds[0] in (ROTOR, GROUND) and kinds[1] == ROTOR and factors.geometry[4] == NONE_HELD


def functions_on_axis(kinds: Kinds, factors: LoadAndCoefficient) -> tuple[Any, Any]:
    """Return force and Jacobian as user functions for Exudyn."""
    grounded, contact = kinds[0] == GROUND, factors.geometry
    if factors.contact is not None:
        force = _constant(grounded, factors.contact)
    else:
        law, size = (force_on_ground, 1) if grounded else (force_on_rotor, 2)
        evaluate = taking_lists(law, 2, LAW, None, float, None, None, size)
        force = partial(evaluate, [mean_radius(contact), contact[3]], factors.law)

    def jacobian(
        mbs: Any,
        t: float,
        item: int,
        q: Sequence[float],
        q_t: Sequence[float],
        position_factor: float,
        velocity_factor: float,
    ) -> FloatArray:
        spin = q_t[0] if grounded else q_t[1] - q_t[0]
        by_spin = velocity_factor * _slope(factors, t, spin)
        # Exudyn expects derivatives of the left-hand side.
        return -by_spin * (np.ones((1, 1)) if grounded else np.array([[1.0, -1.0], [-1.0, 1.0]]))

    return force, jacobian


def _constant(grounded: bool, contact: Contact) -> Any:
    radius = mean_radius(contact)
    creep = radius / contact[3]  # P/ε over |S|
    limit = contact[2] * radius

    def on_ground(mbs: Any, t: float, item: int, q: Sequence[float], q_t: Sequence[float]) -> list[float]:
        share = creep * q_t[0]
        return [-limit if share > 1.0 else limit if share < -1.0 else -limit * share]

    def on_rotor(mbs: Any, t: float, item: int, q: Sequence[float], q_t: Sequence[float]) -> list[float]:
        share = creep * (q_t[1] - q_t[0])
        of_disc = -limit if share > 1.0 else limit if share < -1.0 else -limit * share
        return [-of_disc, of_disc]

    return on_ground if grounded else on_rotor


@compiled
def force_on_ground(
    parameters: Floats, law: Law, mbs: Any, t: float, item: int, q: Floats, q_t: Floats
) -> Floats:
    """Return the moment on a rotor as a user function for Exudyn; ``parameters`` are mean radius (m) and ε (m/s)."""
    return (_moment(parameters, law, t, q_t[0]),)


@compiled
def force_on_rotor(
    parameters: Floats, law: Law, mbs: Any, t: float, item: int, q: Floats, q_t: Floats
) -> Floats:
    """Return the moments on both rotors, as ``force_on_ground``."""
    of_disc = _moment(parameters, law, t, q_t[1] - q_t[0])
    return -of_disc, of_disc


@compiled
def _moment(parameters: Floats, law: Law, t: float, spin: float) -> float:
    radius, epsilon = parameters
    speed = radius * abs(spin)
    limit = radius * friction_force_under(law, epsilon, t, 0.0, speed, spin)
    return -math.copysign(limit * min(1.0, speed / epsilon), spin)


def _slope(factors: LoadAndCoefficient, t: float, spin: float) -> float:
    """Return the derivative of M by S, in N m s."""
    contact = factors.geometry
    radius, epsilon = mean_radius(contact), contact[3]
    speed = radius * abs(spin)
    motion = 0.0, speed, spin
    _, by_speed, by_spin = factors.friction_force_slopes(t, *motion)
    share = math.copysign(min(1.0, speed / epsilon), spin)
    by_share = radius / epsilon if speed < epsilon else 0.0
    change = by_speed * math.copysign(radius, spin) + by_spin
    return -radius * float(change * share + factors.friction_force(t, *motion) * by_share)
