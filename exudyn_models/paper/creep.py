"""Creep of a contact: under the regularised law a held contact slips slower than ε instead of resting."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from exudyn_models.forces.laws.places import point_regularisation, ring_places
from exudyn_models.forces.slip_potential import ring_potential_slopes, ring_potentials
from reference_model.systems import DiscOnDisc, FloatArray, Place, System

WHOLE = 0
"""Column of the contact as a whole; columns of single points follow."""

RELAXATIONS = 40.0
"""Number of relaxation times until slip has settled."""


@dataclass(frozen=True)
class RegularisedContact:
    """The contact of a system under the regularised law, viscous below the slip speed ε > 0."""

    system: System
    epsilon: float

    @cached_property
    def point_epsilon(self) -> float:
        """Slip speed δ below which the friction of one of several points is viscous."""
        return point_regularisation(self.epsilon, self._places)

    @cached_property
    def in_master_axes(self) -> RegularisedContact:
        """The contact in axes that turn with the master disc."""
        return replace(self, system=replace(self.system, disc_speed=0.0))

    @cached_property
    def relaxation_times(self) -> tuple[float, float]:
        """Relaxation times in s of slip below ε to creep: the shorter and the longer time of centre and rim.

        The resistance per m/s is μN/ε for a pin, at least half as large for a disc or its rim on a continuous ring,
        and 1/n as large for one of n points at rest. The inertia of the rim, J/R², may be far larger than the mass.
        """
        system = self.system
        if system.friction_force == 0.0:
            return math.inf, math.inf
        inertias, share = [system.mass], 1
        if isinstance(system, DiscOnDisc):
            inertias.append(system.polar_inertia / system.contact_radius**2)
            share = system.contact_points or 2
        times = sorted(share * inertia * self.epsilon / system.friction_force for inertia in inertias)
        return times[0], times[-1]

    @property
    def settling_time(self) -> float:
        """Time in s that slip below ε needs to settle."""
        return RELAXATIONS * self.relaxation_times[0]

    @cached_property
    def _places(self) -> tuple[Place, ...]:
        if not isinstance(self.system, DiscOnDisc) or self.system.contact_points is None:
            return ()
        return ring_places(self.system.contact_radius, self.system.contact_points)

    @cached_property
    def _arms(self) -> NDArray[np.complex128]:
        return np.array([complex(x, y) for x, y, _ in self._places])

    def slip_ratios(self, states: FloatArray) -> FloatArray:
        """Return slip speeds divided by their viscous limits, shape (n, 1 or 1 + points), for n ``states``.

        The first column is the mean slip speed/ε, the others are the points' slip speeds/δ.
        """
        system, epsilon, omega = self.system, self.epsilon, self.system.disc_speed
        if not isinstance(system, DiscOnDisc):
            x, y, vx, vy = states.T
            return np.asarray(np.hypot(vx + omega * y, vy - omega * x)[:, None] / epsilon)
        x, y, angle, vx, vy, spin = states.T[..., None]
        ux, uy = vx + omega * y, vy - omega * x
        rim = system.contact_radius * (spin - omega)
        if system.contact_points is None:
            return np.asarray(ring_potentials(np.hypot(ux, uy)[:, 0], rim[:, 0])[:, None] / epsilon)
        speeds = np.abs(ux + 1j * uy + 1j * (spin - omega) * np.exp(1j * angle) * self._arms)
        return np.hstack((speeds.mean(axis=1, keepdims=True) / epsilon, speeds / self.point_epsilon))

    def slip_ratio_rates(self, state: FloatArray, acceleration: FloatArray) -> FloatArray:
        """Return the growth rates in 1/s of ``slip_ratios`` for one state without rest."""
        system, epsilon, omega = self.system, self.epsilon, self.system.disc_speed
        size = len(acceleration)
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
        across = 1j * np.exp(1j * state[2]) * self._arms / system.contact_radius
        growths = _growth(slip + rim * across, rate + (rim_rate + 1j * state[5] * rim) * across)
        return np.asarray([growths.mean() / epsilon, *(growths / self.point_epsilon)])

    def load_ratios(self, states: FloatArray, accelerations: FloatArray) -> FloatArray:
        """Return the load at rest divided by the friction limit, shape (n,), for a system that creeps as a whole.

        The result is P/ε, the share of the viscous friction, plus the power of the forces that change and damp the
        creep, divided by μN·P.
        """
        if self.system.friction_force == 0.0:
            return np.full(len(states), np.inf)
        system, epsilon, omega = self.system, self.epsilon, self.system.disc_speed
        size = accelerations.shape[1]
        z, v, a = (array[:, 0] + 1j * array[:, 1] for array in (states, states[:, size:], accelerations))
        slip, rate = v - 1j * omega * z, a - 1j * omega * v
        power = (slip.conjugate() * (system.mass * rate + system.damping * slip)).real
        if isinstance(system, DiscOnDisc):
            spin = states[:, 5] - omega
            power = power + spin * (system.polar_inertia * accelerations[:, 2] + system.shaft_damping * spin)
        ratios = self.slip_ratios(states)[:, WHOLE]
        limit = system.friction_force * epsilon * np.where(ratios > 0.0, ratios, 1.0)
        return np.asarray(ratios + power / limit)

    def creeping(self, state: list[float]) -> int | None:
        """Return the column of ``slip_ratios`` below 1, ``WHOLE`` if there are several, or None."""
        system, size = self.system, len(state) // 2
        x, y, vx, vy = state[0], state[1], state[size], state[size + 1]
        speed = math.hypot(vx + system.disc_speed * y, vy - system.disc_speed * x)
        if isinstance(system, DiscOnDisc):
            # A bound usually suffices: the mean over a ring is at least the slip of the centre or of the rim, and no
            # point slips less than their difference.
            rim = abs(system.contact_radius * (state[5] - system.disc_speed))
            speed = max(speed, rim) if system.contact_points is None else abs(speed - rim)
        if speed >= self.epsilon:
            return None
        if not isinstance(system, DiscOnDisc):
            return WHOLE
        ratios = self.slip_ratios(np.array([state]))[0]
        return int(np.argmax(ratios < 1.0)) if np.any(ratios < 1.0) else None


def _growth(slip: NDArray[np.complex128], rate: NDArray[np.complex128]) -> FloatArray:
    speed = np.abs(slip)
    return np.asarray((slip.conjugate() * rate).real / np.where(speed > 0.0, speed, 1.0))
