"""What of a contact creeps: under the regularised law, what friction holds slips with less than ε, not with zero."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from exudyn_models.forces.friction_laws import point_regularisation
from exudyn_models.forces.slip_potential import ring_potential_slopes, ring_potentials
from reference_model.systems import DiscOnDisc, FloatArray, System

WHOLE = 0
"""Column of the contact as a whole; single points, where there are some, have the columns after it."""


def creep_ratios(system: System, states: FloatArray, epsilon: float) -> FloatArray:
    """Return slip speeds over those below which the law is viscous, shape (n, 1 or 1 + points) for n ``states``.

    First the (mean) slip speed of the contact over ε, then the slip speed of each point over δ.
    """
    omega = system.disc_speed
    if not isinstance(system, DiscOnDisc):
        x, y, vx, vy = states.T
        return np.asarray(np.hypot(vx + omega * y, vy - omega * x)[:, None] / epsilon)
    x, y, angle, vx, vy, spin = states.T[..., None]
    ux, uy = vx + omega * y, vy - omega * x
    rim = system.contact_radius * (spin - omega)
    if system.contact_points is None:
        return np.asarray(ring_potentials(np.hypot(ux, uy)[:, 0], rim[:, 0])[:, None] / epsilon)
    alpha = angle + _angles_between(system.contact_points)
    speeds = np.hypot(ux - rim * np.sin(alpha), uy + rim * np.cos(alpha))
    delta = point_regularisation(epsilon, system.contact_points)
    return np.hstack((speeds.mean(axis=1, keepdims=True) / epsilon, speeds / delta))


def creep_ratio_rates(
    system: System, state: FloatArray, acceleration: FloatArray, epsilon: float
) -> FloatArray:
    """Return the rates in 1/s at which ``creep_ratios`` grow, one of each, where nothing is at rest."""
    omega, size = system.disc_speed, len(acceleration)
    z, v, a = (complex(*vector[:2]) for vector in (state, state[size:], acceleration))
    slip, rate = np.array([v - 1j * omega * z]), np.array([a - 1j * omega * v])
    if not isinstance(system, DiscOnDisc):
        return _growth(slip, rate) / epsilon
    rim = system.contact_radius * (state[5] - omega)
    rim_rate = system.contact_radius * acceleration[2]
    if system.contact_points is None:
        by_speed, by_rim = ring_potential_slopes(abs(slip[0]), abs(rim))
        growth = by_speed * _growth(slip, rate) + by_rim * math.copysign(1.0, rim) * rim_rate
        return np.asarray(growth / epsilon)
    across = 1j * np.exp(1j * (state[2] + _angles_between(system.contact_points)))
    growths = _growth(slip + rim * across, rate + (rim_rate + 1j * state[5] * rim) * across)
    delta = point_regularisation(epsilon, system.contact_points)
    return np.asarray([growths.mean() / epsilon, *(growths / delta)])


def load_ratios(system: System, states: FloatArray, accelerations: FloatArray, epsilon: float) -> FloatArray:
    """Return the load on friction over what it can take, shape (n,), for a system that creeps as a whole.

    It is the load at rest. The viscous friction of the creep, P/ε of the limit, lacks what changes the creep and what
    damps it. Along the slip (u, φ̇ − ω), which is normal to the limit surface, that is the power that goes into both
    over μN·P.
    """
    if system.friction_force == 0.0:
        return np.full(len(states), np.inf)
    omega, size = system.disc_speed, accelerations.shape[1]
    z, v, a = (array[:, 0] + 1j * array[:, 1] for array in (states, states[:, size:], accelerations))
    slip, rate = v - 1j * omega * z, a - 1j * omega * v
    power = (slip.conjugate() * (system.mass * rate + system.damping * slip)).real
    if isinstance(system, DiscOnDisc):
        spin = states[:, 5] - omega
        power = power + spin * (system.polar_inertia * accelerations[:, 2] + system.shaft_damping * spin)
    ratios = creep_ratios(system, states, epsilon)[:, WHOLE]
    limit = system.friction_force * epsilon * np.where(ratios > 0.0, ratios, 1.0)
    return np.asarray(ratios + power / limit)


def creeping(system: System, state: list[float], epsilon: float) -> int | None:
    """Return the column of ``creep_ratios`` that is below 1, or None; of several, ``WHOLE``."""
    size = len(state) // 2
    x, y, vx, vy = state[0], state[1], state[size], state[size + 1]
    speed = math.hypot(vx + system.disc_speed * y, vy - system.disc_speed * x)
    if isinstance(
        system, DiscOnDisc
    ):  # no part slips less than the difference of centre and rim: mostly enough
        speed = abs(speed - abs(system.contact_radius * (state[5] - system.disc_speed)))
    if speed >= epsilon:
        return None
    if not isinstance(system, DiscOnDisc):
        return WHOLE
    ratios = creep_ratios(system, np.array([state]), epsilon)[0]
    return int(np.argmax(ratios < 1.0)) if np.any(ratios < 1.0) else None


def _growth(slip: NDArray[np.complex128], rate: NDArray[np.complex128]) -> FloatArray:
    """Return the rate of |slip|."""
    speed = np.abs(slip)
    return np.asarray((slip.conjugate() * rate).real / np.where(speed > 0.0, speed, 1.0))


def _angles_between(points: int) -> FloatArray:
    return 2.0 * math.pi * np.arange(points) / points
