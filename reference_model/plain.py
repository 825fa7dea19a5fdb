"""Eq. 1 and 19 to 21 of the paper as printed, integrated by SciPy: the file to read first.

There is one change: below a slip speed ε, friction is divided by ε, so a sticking body creeps more slowly than ε.
"""

import math
import time
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import ArrayLike
from scipy.integrate import solve_ivp

from reference_model.contact.contact_law import Contact
from reference_model.systems import DiscOnDisc, System, checked_state, checked_times, checked_tolerance
from reference_model.trajectory import Phase, SimulationError, Solution, Trajectory

Friction = Callable[[Any, Any, Any, Any], "tuple[Any, Any, Any]"]
"""Function of slip in x and y (m/s), ω − φ̇ (rad/s) and φ (rad), real or complex; returns F_x, F_y (N), M (N m)."""


def on_ring(load: float, R: float, points: int, epsilon: float) -> Friction:
    """Return the friction of (20), with its integral over χ as a mean over ``points`` that slip by (21).

    One point and R = 0 give the pin of (1).
    """
    chi = 2.0 * np.pi * np.arange(points) / points

    def friction(slip_x: Any, slip_y: Any, relative_spin: Any, angle: Any) -> tuple[Any, Any, Any]:
        sine, cosine = np.sin(angle + chi), np.cos(angle + chi)
        v_x = slip_x + R * relative_spin * sine
        v_y = slip_y - R * relative_spin * cosine
        speed = np.maximum(np.sqrt(v_x**2 + v_y**2), epsilon)
        moment = load * R * np.mean((v_x * sine - v_y * cosine) / speed)
        return -load * np.mean(v_x / speed), -load * np.mean(v_y / speed), moment

    return friction


def by_law(load: float, law: Contact) -> Friction:
    """Return the friction of a contact law in closed form."""

    def friction(slip_x: Any, slip_y: Any, relative_spin: Any, angle: Any) -> tuple[Any, Any, Any]:
        force, moment = law.force_and_moment(complex(slip_x, slip_y), relative_spin, angle)
        return load * force.real, load * force.imag, load * moment

    return friction


def stiffness(system: System, w_x: Any, w_y: Any) -> Any:
    """Return the secant stiffness in N/m at the deflection w: the paper's C, plus hardening and stop."""
    squared = w_x**2 + w_y**2
    d = np.sqrt(squared)
    beyond = (d - system.stop_gap) / d if d.real > system.stop_gap else 0.0
    return system.stiffness + system.hardening * squared + system.stop_stiffness * beyond


def rates(system: System, friction: Friction, state: Any) -> list[Any]:
    """Return the time derivatives of a state, (4,) or (6,): (1) for a pin and (19) for a disc."""
    (x, y, *angle), (vx, vy, *spin) = np.reshape(state, (2, -1)).tolist()
    omega, C = system.disc_speed, stiffness(system, x - system.offset, y)
    turning = (omega - spin[0], angle[0]) if isinstance(system, DiscOnDisc) else (0.0, 0.0)
    force_x, force_y, moment = friction(vx + omega * y, vy - omega * x, *turning)
    ax = (force_x - system.damping * vx - C * (x - system.offset)) / system.mass
    ay = (force_y - system.damping * vy - C * y) / system.mass
    if not isinstance(system, DiscOnDisc):
        return [vx, vy, ax, ay]
    shaft = system.shaft_damping * (spin[0] - system.shaft_speed)
    return [vx, vy, spin[0], ax, ay, (moment - shaft) / system.polar_inertia]


def simulate(
    system: System, initial_state: ArrayLike, times: ArrayLike, *, tolerance: float = 1e-9
) -> Trajectory:
    """Return the motion like :func:`reference_model.simulate`, but with creep instead of stick phases."""
    # With a finer tolerance Radau cannot resolve the creep: slip is the difference of two velocities.
    clock, fine = time.perf_counter(), max(checked_tolerance(tolerance), 1e-10)
    start, times = checked_state(system, initial_state), checked_times(times)
    (x, y, *_), (vx, vy, *_) = np.split(start, 2)
    R, points = 0.0, 1
    if isinstance(system, DiscOnDisc):
        # The error of the mean where a point of a ring rests is about 1/points².
        R, points = system.contact_radius, system.contact_points or math.ceil(fine**-0.5)
    size = max(math.hypot(x, y), abs(system.offset), R) or 1.0
    speed = max(math.hypot(vx, vy), abs(system.disc_speed) * size) or 1.0
    epsilon = 10.0 * fine * speed  # errors of stick are at least ε
    friction = on_ring(system.friction_force, R, points, epsilon)
    run = solve_ivp(
        lambda _, state: rates(system, friction, state), (times[0], times[-1]), start, "Radau", times,
        rtol=0.1 * fine, atol=1e-3 * fine * np.repeat((size, speed), len(start) // 2),
    )  # fmt: skip
    if not run.success:
        raise SimulationError(f"Radau gave up: {run.message}; try a larger tolerance")
    states = np.vstack((start, *np.transpose(run.y)[1:]))  # SciPy returns no states for a single time
    phase = Phase("slip", float(times[0]), float(times[-1]), start)
    solution = Solution("Radau", tolerance, run.nfev, len(run.t), time.perf_counter() - clock, epsilon)
    return Trajectory(system, times, states, (phase,), solution)
