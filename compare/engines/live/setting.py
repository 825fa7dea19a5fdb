"""Common code of the foreign engines: checks, steps, contact points, our friction law, and results."""

import cmath
import math
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from compare.engines.engine import UnsupportedSystemError
from reference_model.systems import (
    DiscOnDisc,
    FloatArray,
    System,
    checked_state,
    checked_times,
    checked_tolerance,
    finite_numbers,
)
from reference_model.systems.joint import AnySystem, FrictionJoint
from reference_model.trajectory import Phase, SimulationError, Solution, Trajectory


class Model:
    """The bodies in an ``engine`` and their current state.

    In engines with contact, n feet below the body are spheres on vertical joints, each pressed by its own weight N/n
    on a plate that turns at ω, because several loads of one rigid body are indeterminate.

    ``arms`` are the contact points, ``half`` is the number of coordinates, ``method`` names integrator and contact,
    and ``epsilon`` is the slip speed in m/s that regularises the friction law. A ``linear`` model has springs without
    hardening and stop. In a ``patch``, one contact with the engine's own friction against spin stands for a ring; its
    moment alone is at most μN·R.
    """

    engine = ""
    kinds: tuple[str, ...] = ("pin", "points")
    method = ""
    most_points = math.inf
    linear = True
    patch = False
    epsilon = 0.0

    def __init__(self, system: System, state: FloatArray, tolerance: float, **options: Any) -> None:
        self.system, self.half = system, len(state) // 2
        self.arms = [0j] if self.patch else contact_arms(self.engine, system, self.most_points)
        self.build(state, tolerance, **options)

    def build(self, state: FloatArray, tolerance: float, *_: Any, **options: Any) -> None:
        """Create the bodies."""
        raise NotImplementedError

    def advance(self, h: float, number: int) -> FloatArray:
        """Take ``number`` steps of ``h`` s, and return the state."""
        raise NotImplementedError

    def work(self, steps: int) -> tuple[int, int]:
        """Return the numbers of evaluations and steps for requested ``steps``."""
        return steps, steps

    def close(self) -> None:
        """Release the engine's resources."""


class JointModel(Model):
    """A body on a hinge, with the engine's own friction in the joint; ``start`` is the first time in s.

    Spring, damper and applied moment are a torque that is set before each step. The applied moment is that of
    mid-step.
    """

    kinds: tuple[str, ...] = ("joint",)

    def __init__(
        self, joint: FrictionJoint, state: FloatArray, tolerance: float, start: float, **options: Any
    ) -> None:
        if joint.static_ratio > 1.0:
            raise UnsupportedSystemError(f"{self.engine} has one friction moment at rest and in motion")
        self.joint, self.time = joint, start
        self.angle, self.spin = map(float, state)
        self.build(state, tolerance, **options)

    def turn(self, torque: float, h: float) -> tuple[float, float]:
        """Take a step of ``h`` s under ``torque`` in N m, and return angle and spin."""
        raise NotImplementedError

    def advance(self, h: float, number: int) -> FloatArray:
        """Take ``number`` steps of ``h`` s, and return the state."""
        joint = self.joint
        for _ in range(number):
            spring = joint.stiffness * (self.angle - joint.offset) + joint.damping * self.spin
            self.angle, self.spin = self.turn(joint.applied(self.time + 0.5 * h) - spring, h)
            self.time += h
        return np.array([self.angle, self.spin])


@dataclass(frozen=True)
class Setting:
    """One setting of an engine, callable as the ``simulate`` of any engine; ``joint`` is its model of joints.

    Steps last ``step`` s, if given, else 0.1·tolerance^(1/3) / max(k, ω), which halves first-order errors between the
    tolerances of an estimate, but at least ``finest`` / max(k, ω). ``step`` is None for an integrator with error
    control.
    """

    name: str
    says: str
    model: type[Model]
    options: Mapping[str, Any] = field(default_factory=dict)  # options of the model
    finest: float = 0.0  # smallest step in units of 1/max(k, ω)
    step: float | None = 2e-3
    precision: float = 0.0
    joint: type[JointModel] | None = None

    @property
    def kinds(self) -> tuple[str, ...]:
        """The kinds of systems that the setting simulates."""
        return self.model.kinds + (self.joint.kinds if self.joint else ())

    def __call__(
        self,
        system: AnySystem,
        initial_state: ArrayLike,
        times: ArrayLike,
        *,
        tolerance: float = 1e-9,
        step: float | None = None,
    ) -> Trajectory:
        """Return the motion."""
        grid, tolerance, engine = checked_times(times), checked_tolerance(tolerance), self.model.engine
        if isinstance(system, FrictionJoint):
            state = finite_numbers("initial_state", initial_state)
        else:
            state = checked_state(system, initial_state)
            if self.model.linear and not system.linear_support:
                raise UnsupportedSystemError(f"{engine} does not simulate a nonlinear support")
        longest = step or max(0.1 * max(tolerance, 1e-12) ** (1.0 / 3.0), self.finest) / rate(system)
        states, steps = [state], 0
        began = time.perf_counter()
        model = self._model(system, state, tolerance, float(grid[0]))
        try:
            for i, interval in enumerate(np.diff(grid).tolist(), 1):
                number = math.ceil(interval / longest * (1.0 - 1e-9))
                states.append(model.advance(interval / number, number))
                steps += number
                if not np.all(np.isfinite(states[-1])):
                    raise SimulationError(
                        f"{engine} diverged before t = {grid[i]:g} s: try a smaller tolerance"
                    )
        finally:
            model.close()
        wall = time.perf_counter() - began
        solution = Solution(model.method, tolerance, *model.work(steps), wall, model.epsilon)
        phases = (Phase("slip", float(grid[0]), float(grid[-1]), state),)
        return Trajectory(system, grid, np.array(states), phases, solution)

    def _model(self, system: AnySystem, state: FloatArray, tolerance: float, start: float) -> Model:
        if not isinstance(system, FrictionJoint):
            return self.model(system, state, tolerance, **self.options)
        if self.joint is None:
            raise UnsupportedSystemError(f"{self.model.engine}, {self.name}, does not simulate a joint")
        return self.joint(system, state, tolerance, start, **self.options)


def contact_arms(engine: str, system: System, most: float = math.inf) -> list[complex]:
    """Return the positions in m of the contact points on the disc at angle 0.

    Raises ``UnsupportedSystemError`` for a ring, or more than ``most`` points.
    """
    if not isinstance(system, DiscOnDisc):
        return [0j]
    n = system.contact_points
    if n is None:
        raise UnsupportedSystemError(f"{engine} does not simulate a disc on a continuous ring")
    if n > most:
        raise UnsupportedSystemError(
            f"contact_points = {n}: {engine} does not simulate a disc on more than {most:g} points"
        )
    return [cmath.rect(system.contact_radius, 2.0 * math.pi * i / n) for i in range(n)]


def rate(system: AnySystem) -> float:
    """Return max(k, ω) in 1/s, of a joint the fastest rate of spring and damper, or 1/s if both are zero."""
    if isinstance(system, FrictionJoint):
        return max(math.sqrt(system.stiffness / system.inertia), system.damping / system.inertia) or 1.0
    return max(system.natural_frequency, abs(system.disc_speed)) or 1.0


def mobility(system: System) -> float:
    """Return the largest change of slip in m/s for an impulse of 1 N s on the contact."""
    turning = system.contact_radius**2 / system.polar_inertia if isinstance(system, DiscOnDisc) else 0.0
    return 1.0 / system.mass + turning


def inertia_of(system: System) -> float:
    """Return J, or the mass of a pin, which does not turn."""
    return system.polar_inertia if isinstance(system, DiscOnDisc) else system.mass


def radius_of(system: System) -> float:
    """Return R, or 0 of a pin."""
    return system.contact_radius if isinstance(system, DiscOnDisc) else 0.0


def shaft_torque(system: System, spin: float) -> float:
    """Return the torque in N m of the shaft on a disc; 0 for a pin."""
    return system.shaft_damping * (system.shaft_speed - spin) if isinstance(system, DiscOnDisc) else 0.0


def support_force(system: System, z: complex, v: complex) -> complex:
    """Return the force in N of springs, stop and dampers at ``z`` (m) and ``v`` (m/s)."""
    w = z - system.offset
    stop = system.stop_stiffness * max(0.0, 1.0 - system.stop_gap / abs(w)) if w else 0.0
    return -(system.stiffness + system.hardening * abs(w) ** 2 + stop) * w - system.damping * v


def our_friction(system: System, arms: list[complex], state: Sequence[float], epsilon: float) -> Any:
    """Return force in N, and for a disc moment in N m, of −μN·v/max(|v|, ε) at the contact points."""
    half = len(state) // 2
    z, v = complex(*state[:2]), complex(*state[half : half + 2])
    turned, spin = (cmath.rect(1.0, state[2]), state[5]) if half > 2 else (1.0 + 0j, 0.0)
    load, omega, force, moment = system.friction_force / len(arms), system.disc_speed, 0j, 0.0
    for unturned in arms:
        arm = unturned * turned
        slip = v + 1j * (spin * arm - omega * (z + arm))
        friction = -load * slip / max(abs(slip), epsilon, 1e-300)
        force += friction
        moment += (arm.conjugate() * friction).imag
    return (force.real, force.imag, moment)[:half]


# --- Common code of planar engines, with contact as a joint.
#
# A planar engine has no normal load. For top-down scenes, these engines recommend a joint that removes the relative
# velocity of two bodies up to a force limit, here μN/n at each contact point. The second body there is kinematic and
# has the velocity of the master disc. Steps are semi-implicit, of order 1.


class TopDown(Model):
    """A body with a kinematic partner at each contact point; a ``shipped`` engine keeps its defaults."""

    shipped, linear = False, False

    def state(self) -> tuple[float, ...]:
        """Return x, y, angle, vx, vy and spin."""
        raise NotImplementedError

    def load(self, force: complex, torque: float, below: list[complex]) -> None:
        """Set force and torque on the body, and the velocities ``below`` of its partners."""
        raise NotImplementedError

    def step(self, h: float) -> None:
        """Take a step of ``h`` s; call ``load_now`` before velocities change."""
        raise NotImplementedError

    def load_now(self) -> None:
        """Set the forces and the partners' velocities for the current state."""
        system = self.system
        x, y, angle, vx, vy, spin = self.state()
        turned, z = cmath.rect(1.0, angle), complex(x, y)
        below = [1j * system.disc_speed * (z + arm * turned) for arm in self.arms]
        self.load(support_force(system, z, complex(vx, vy)), shaft_torque(system, spin), below)

    def advance(self, h: float, number: int) -> FloatArray:
        """Take ``number`` steps of ``h`` s, and return the state."""
        for _ in range(number):
            self.step(h)
        places, speeds = np.split(np.array(self.state()), 2)
        return np.concatenate((places[: self.half], speeds[: self.half]))
