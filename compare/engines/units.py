"""Motions in other units: the requested motions in dimensionless form, with other parameters.

The studies' masses are mostly 1 kg and speeds below 2 m/s; an engine may be wrong at all others. The units are
powers of two, so an engine without absolute constants returns the same digits.
"""

import functools
import itertools
import zlib
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any, TypeVar

import numpy as np
from numpy.typing import ArrayLike

from reference_model.systems import FloatArray
from reference_model.systems.joint import AnySystem, FrictionJoint
from reference_model.trajectory import Trajectory

MOST = 5
"""Largest power of two in the factors of masses, stiffnesses, loads, speeds, lengths and times."""

UNITS = tuple(
    (mass, length, time)
    for mass, length, time in itertools.product(range(-MOST, MOST + 1), repeat=3)
    if length <= 0 and max(abs(length - time), abs(mass - 2 * time), abs(mass + length - 2 * time)) <= MOST
)
"""Powers of two for kg, m and s; no lengths larger than in SI units, because the plate of an engine is finite."""

DIMENSIONS = {
    "mass": (1, 0, 0),
    "stiffness": (1, 0, -2),
    "damping": (1, 0, -1),
    "friction_force": (1, 1, -2),
    "disc_speed": (0, 0, -1),
    "offset": (0, 1, 0),
    "hardening": (1, -2, -2),
    "stop_gap": (0, 1, 0),
    "stop_stiffness": (1, 0, -2),
    "polar_inertia": (1, 2, 0),
    "contact_radius": (0, 1, 0),
    "shaft_damping": (1, 2, -1),
    "shaft_speed": (0, 0, -1),
}
"""Powers of mass, length and time in each parameter."""


Given = TypeVar("Given", bound=AnySystem)


def in_units(system: Given, mass: float, length: float, time: float) -> Given:
    """Return ``system`` with other units of mass, length and time, given as multiples of these numbers."""
    if isinstance(system, FrictionJoint):
        inertia = mass * length**2
        moment = inertia / time**2
        return replace(
            system,
            inertia=system.inertia * inertia,
            friction_moment=system.friction_moment * moment,
            damping=system.damping * inertia / time,
            stiffness=system.stiffness * moment,
            moment=tuple((at * time, value * moment) for at, value in system.moment),
        )
    changes = {
        name: getattr(system, name) * (mass ** float(m) * length ** float(d) * time ** float(t))
        for name, (m, d, t) in DIMENSIONS.items()
        if hasattr(system, name)
    }
    return replace(system, **changes)


@dataclass(frozen=True)
class InOtherUnits:
    """A ``simulate`` that asks ``function`` for each motion in units drawn from ``seed`` and the system."""

    function: Callable[..., Any]
    seed: int

    def __call__(
        self, system: AnySystem, initial_state: ArrayLike, times: ArrayLike, **accuracy: float
    ) -> Any:
        """Return the motion in the units of ``system``."""
        units = self._units(system)
        answer = self.function(*self.motion(system, initial_state, times), **_step(accuracy, units))
        return _back(answer, system, units)

    def motion(
        self, system: AnySystem, initial_state: ArrayLike, times: ArrayLike
    ) -> tuple[AnySystem, FloatArray, FloatArray]:
        """Return a motion in the units that ``function`` receives."""
        return _asked(system, initial_state, times, self._units(system))

    @property
    def simulate_many(self) -> Callable[..., Any] | None:
        """Wrapped ``function.simulate_many``; None if it is missing, or takes one step for all motions."""
        at_once = getattr(self.function, "simulate_many", None)
        return at_once and functools.partial(self._many, at_once)

    def _many(
        self,
        at_once: Callable[..., Any],
        systems: Sequence[AnySystem],
        initial_states: Sequence[ArrayLike],
        times: Sequence[ArrayLike],
        **accuracy: float,
    ) -> Any:
        # one call has one step, so all motions have the units of the first system
        units = [self._units(systems[0] if "step" in accuracy else system) for system in systems]
        asked = [_asked(*motion) for motion in zip(systems, initial_states, times, units, strict=True)]
        answers = at_once(*map(list, zip(*asked, strict=True)), **_step(accuracy, units[0]))
        if isinstance(answers, Trajectory) or not isinstance(answers, Sequence) or len(answers) != len(asked):
            return answers
        return [_back(*one) for one in zip(answers, systems, units, strict=True)]

    def _units(self, system: AnySystem) -> tuple[int, int, int]:
        return UNITS[zlib.crc32(repr((self.seed, system)).encode()) % len(UNITS)]


def _factors(system: AnySystem, units: tuple[int, int, int]) -> FloatArray:
    _, length, time = units
    if isinstance(system, FrictionJoint):
        return np.array([1.0, 1.0 / 2.0**time])
    places = [2.0**length, 2.0**length] + [1.0] * (system.state_size // 2 - 2)
    return np.array(places + [place / 2.0**time for place in places])


def _asked(
    system: AnySystem, state: ArrayLike, times: ArrayLike, units: tuple[int, int, int]
) -> tuple[AnySystem, FloatArray, FloatArray]:
    return (
        in_units(system, *(2.0**power for power in units)),
        np.asarray(state, dtype=float) * _factors(system, units),
        np.asarray(times, dtype=float) * 2.0 ** units[2],
    )


def _step(accuracy: dict[str, float], units: tuple[int, int, int]) -> dict[str, float]:
    return {name: value * 2.0 ** units[2] if name == "step" else value for name, value in accuracy.items()}


def _back(answer: Any, system: AnySystem, units: tuple[int, int, int]) -> Any:
    """Return the answer in the units of ``system``; an invalid answer is unchanged."""
    factors, second = _factors(system, units), 2.0 ** units[2]
    if not isinstance(answer, Trajectory) or np.shape(answer.states)[1:] != factors.shape:
        return answer
    speed = factors[3] if len(factors) == 6 else factors[-1]
    return Trajectory(
        system,
        np.asarray(answer.times, dtype=float) / second,
        np.asarray(answer.states, dtype=float) / factors,
        tuple(
            replace(
                phase,
                start=phase.start / second,
                end=phase.end / second,
                initial_state=np.asarray(phase.initial_state, dtype=float) / factors,
            )
            for phase in answer.phases
        ),
        replace(answer.solution, regularisation=answer.solution.regularisation / speed),
    )
