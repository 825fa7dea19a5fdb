"""A launch without radial motion: three rotors and Coulomb friction that sticks, by formulas and by SciPy.

Nothing of Exudyn or of its friction law takes part. While the clutch slips it transmits its capacity, whatever the
slip. While it sticks, engine and disc are one body, and the clutch transmits what that takes, up to the capacity.
"""

from __future__ import annotations

import functools
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from scipy.integrate import solve_ivp

from compare.studies.drivetrain.launch.parameters import (
    ENGINE_SPEED,
    KNOTS,
    MEAN,
    RIPPLE,
    UNTIL,
    capacity,
    resistance,
)
from compare.studies.toolkit.drivetrain_bench import centred_car
from reference_model.systems import FloatArray

if TYPE_CHECKING:
    from exudyn_models import Drivetrain
    from exudyn_models.drivetrain.parameters import Torque


@dataclass(frozen=True)
class FullSlip:
    """A clutch whose capacity grows from zero like ``rate``·t (N m), between a constant engine torque and a vehicle.

    The rigid drivetrain closes its slip like a parabola. The torsional spring winds up under the growing torque, by
    which the disc runs ahead of the vehicle: a constant part of its speed, once the first oscillation has died away.
    """

    rotors: Drivetrain
    engine_speed: float
    engine_torque: float
    rate: float

    @property
    def wind_up(self) -> float:
        """By how much the disc turns faster than it would without spring, in rad/s."""
        driven = self.rotors.vehicle_inertia / (self.rotors.disc_inertia + self.rotors.vehicle_inertia)
        return driven**2 * self.rate / self.rotors.torsional_stiffness

    def speeds(self, t: float) -> tuple[float, float, float]:
        """Return those of engine, disc and vehicle in rad/s at the time t in s, the oscillation having died away."""
        car = self.rotors
        given = self.rate * t**2 / 2.0
        engine = self.engine_speed + (self.engine_torque * t - given) / car.engine_inertia
        rigid = given / (car.disc_inertia + car.vehicle_inertia)
        disc = rigid + self.wind_up
        return engine, disc, rigid - self.wind_up * car.disc_inertia / car.vehicle_inertia

    def time_of(self, slip: float) -> float:
        """Return the time in s at which the slip has fallen to ``slip`` in rad/s."""
        car = self.rotors
        inverse = 1.0 / car.engine_inertia + 1.0 / (car.disc_inertia + car.vehicle_inertia)
        # s₀ + a·t − b·t² = slip
        start = self.engine_speed - self.wind_up - slip
        a, b = self.engine_torque / car.engine_inertia, self.rate * inverse / 2.0
        return (a + math.sqrt(a * a + 4.0 * b * start)) / (2.0 * b)

    def heat(self, t: float) -> float:
        """Return ∫ capacity·slip dt in J up to t, with what the oscillation at the start adds.

        The twist θ of the spring obeys J_r·θ'' + d·θ' + k·θ = g·rate·t with g = J_v/(J_d + J_v); the disc runs ahead
        with g·θ', and ∫t·θ' dt = t·θ − ∫θ dt. The oscillation adds (d²/k − J_r)·g·rate/k² to ∫θ dt.
        """
        car = self.rotors
        both = car.disc_inertia + car.vehicle_inertia
        g, k, d = car.vehicle_inertia / both, car.torsional_stiffness, car.torsional_damping
        ramp = g * self.rate / k
        twist = ramp * (t - d / k)
        area = ramp * (t**2 / 2.0 - d / k * t + (d**2 / k - car.disc_inertia * g) / k)
        inverse = 1.0 / car.engine_inertia + 1.0 / both
        rigid = (
            self.engine_speed * t**2 / 2.0
            + self.engine_torque / car.engine_inertia * t**3 / 3.0
            - self.rate * inverse / 2.0 * t**4 / 4.0
        )
        return self.rate * (rigid - g * (t * twist - area))


ENGINE, DISC, VEHICLE = range(3)
"""Places among the three angles, and among the three speeds that follow them; the last of the states is the heat."""


@dataclass(frozen=True)
class Part:
    """A part of a launch of slip or of stick, from ``start`` to ``end`` in s, and its states over the time."""

    sticks: bool
    start: float
    end: float
    states: Callable[[Any], FloatArray]


@dataclass(frozen=True)
class Launch:
    """Three rotors with a clutch of given capacity, between which Coulomb friction acts.

    Parameters
    ----------
    rotors : Drivetrain
        Of which engine, disc and vehicle turn, and nothing else moves.
    capacity : callable
        Of the clutch in N m, over the time in s.
    bends : sequence of float
        Times in s at which the capacity has a bend.
    engine_torque, vehicle_torque : callable
        As ``build_drivetrain`` takes them.

    """

    rotors: Drivetrain
    capacity: Callable[[float], float]
    bends: Sequence[float]
    engine_torque: Torque
    vehicle_torque: Torque

    def run(self, engine_speed: float, until: float, tolerance: float = 1e-12) -> tuple[Part, ...]:
        """Return the parts of a launch of a vehicle at rest up to ``until`` (s), from a speed in rad/s."""
        parts: list[Part] = []
        t, sticks, state = 0.0, False, np.array([0.0, 0.0, 0.0, engine_speed, 0.0, 0.0, 0.0])
        while t < until:
            run = solve_ivp(
                self._sticking if sticks else self._slipping,
                (t, min([bend for bend in self.bends if bend > t] + [until])),
                state,
                method="DOP853",
                rtol=tolerance,
                atol=tolerance,
                events=_ends(self.spare if sticks else _slip),
                dense_output=True,
            )
            parts.append(Part(sticks, t, float(run.t[-1]), run.sol))
            t, state, sticks = float(run.t[-1]), run.y[:, -1], sticks != (run.status == 1)
        return tuple(parts)

    def held(self, t: float, state: FloatArray) -> float:
        """Return the torque in N m that the clutch transmits while it sticks."""
        car = self.rotors
        engine, torsion, _ = self._torques(t, state)
        return float(
            engine - car.engine_inertia * (engine + torsion) / (car.engine_inertia + car.disc_inertia)
        )

    def spare(self, t: float, state: FloatArray) -> float:
        """Return by how much the capacity exceeds what holds, in N m."""
        return self.capacity(t) - abs(self.held(t, state))

    def _torques(self, t: float, state: FloatArray) -> tuple[float, float, float]:
        """Return those on engine, disc and vehicle, but for the clutch's, in N m."""
        angles, speeds = state[:3], state[3:6]
        torsion = self.rotors.torsional_stiffness * (
            angles[DISC] - angles[VEHICLE]
        ) + self.rotors.torsional_damping * (speeds[DISC] - speeds[VEHICLE])
        return (
            self.engine_torque(t, angles[ENGINE], speeds[ENGINE]),
            -torsion,
            torsion + self.vehicle_torque(t, angles[VEHICLE], speeds[VEHICLE]),
        )

    def _rates(self, t: float, state: FloatArray, transmitted: float) -> list[float]:
        car = self.rotors
        engine, disc, vehicle = self._torques(t, state)
        return [
            *state[3:6],
            (engine - transmitted) / car.engine_inertia,
            (disc + transmitted) / car.disc_inertia,
            vehicle / car.vehicle_inertia,
            transmitted * _slip(t, state),
        ]

    def _slipping(self, t: float, state: FloatArray) -> list[float]:
        return self._rates(t, state, self.capacity(t))

    def _sticking(self, t: float, state: FloatArray) -> list[float]:
        return self._rates(t, state, self.held(t, state))


def states_at(parts: Sequence[Part], t: float) -> FloatArray:
    """Return the states at a time in s."""
    return next(part for part in parts if t <= part.end).states(t)


@functools.cache
def sticking_launch() -> tuple[Launch, tuple[Part, ...]]:
    """Return the launch of the centred car under Coulomb friction that sticks, and its parts."""
    from exudyn_models import four_cylinder

    launch = Launch(centred_car(), capacity, KNOTS[1:], four_cylinder(MEAN, RIPPLE), resistance)
    return launch, launch.run(ENGINE_SPEED, UNTIL)


def time_of_stick() -> FloatArray:
    """Return when that launch begins to stick and when it slips again, in s."""
    _, parts = sticking_launch()
    start = next(part.start for part in parts if part.sticks)
    return np.array([start, next(part.start for part in parts if not part.sticks and part.start > start)])


def torque_held(times: FloatArray) -> FloatArray:
    """Return the torque in N m that holds the clutch in that launch, at times at which it sticks."""
    launch, parts = sticking_launch()
    return np.array([launch.held(t, states_at(parts, t)) for t in times])


def end_of_launch() -> FloatArray:
    """Return the speeds of engine, disc and vehicle in rad/s and the heat in J at the end of that launch."""
    _, parts = sticking_launch()
    return parts[-1].states(UNTIL)[3:]


def _slip(t: float, state: FloatArray) -> float:
    return float(state[3 + ENGINE] - state[3 + DISC])


def _ends(function: Callable[[float, FloatArray], float]) -> Any:
    """Return an event for ``solve_ivp`` that ends a run where ``function`` falls through zero."""

    def event(t: float, state: FloatArray) -> float:
        return function(t, state)

    ending: Any = event
    ending.terminal, ending.direction = True, -1.0
    return ending
