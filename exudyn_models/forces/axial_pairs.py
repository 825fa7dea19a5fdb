"""Friction of a rotor on a rotor or on the ground, both about one axis: so short that it needs no compiled code.

All of a contact slips in its own direction there, and force and slip of the centre are zero: with the mean radius r
of the contact P = r·|S|, and M = −μN·r·sign(S), or that times P/ε where P < ε. Points share that alike.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from exudyn_models.forces.friction_laws import NONE_HELD, mean_radius
from exudyn_models.forces.load_and_coefficient import LoadAndCoefficient
from exudyn_models.forces.slip_kinematics import GROUND, ROTOR, Kinds
from reference_model.systems import FloatArray

Moment = Callable[[float, float], float]
"""M in N m on the disc, of the time in s and S in rad/s."""


def on_one_axis(kinds: Kinds, factors: LoadAndCoefficient) -> bool:
    """Return whether this is a contact of which ``functions_on_axis`` are the functions."""
    return kinds[0] in (ROTOR, GROUND) and kinds[1] == ROTOR and factors.geometry[4] == NONE_HELD


def functions_on_axis(kinds: Kinds, factors: LoadAndCoefficient) -> tuple[Any, Any]:
    """Return force and Jacobian as the user functions that Exudyn calls."""
    moment, grounded = _moment(factors), kinds[0] == GROUND

    def force_on_ground(
        mbs: Any, t: float, item: int, q: Sequence[float], q_t: Sequence[float]
    ) -> list[float]:
        return [moment(t, q_t[0])]

    def force(mbs: Any, t: float, item: int, q: Sequence[float], q_t: Sequence[float]) -> list[float]:
        of_disc = moment(t, q_t[1] - q_t[0])
        return [-of_disc, of_disc]

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
        # Exudyn takes derivatives of the left-hand side.
        return -by_spin * (np.ones((1, 1)) if grounded else np.array([[1.0, -1.0], [-1.0, 1.0]]))

    return (force_on_ground if grounded else force), jacobian


def power_on_axis(factors: LoadAndCoefficient, t: float, spin: float) -> float:
    """Return what friction turns into heat in W, at the time t (s) and S (rad/s)."""
    contact = factors.geometry
    speed = mean_radius(contact) * abs(spin)
    friction = factors.friction_force(t, 0.0, speed, spin)
    return friction * speed * min(1.0, speed / contact[3])


def _moment(factors: LoadAndCoefficient) -> Moment:
    contact = factors.geometry
    radius = mean_radius(contact)
    creep = radius / contact[3]  # P/ε over |S|
    if factors.contact is not None:
        limit = factors.contact[2] * radius

        def constant(t: float, spin: float) -> float:
            share = creep * spin
            return -limit if share > 1.0 else limit if share < -1.0 else -limit * share

        return constant
    friction_force = factors.friction_force

    def moment(t: float, spin: float) -> float:
        share = creep * spin
        share = 1.0 if share > 1.0 else -1.0 if share < -1.0 else share
        return -friction_force(t, 0.0, radius * abs(spin), spin) * radius * share

    return moment


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
