"""An engine of its own kind, and the same engine broken on purpose: a check is worth what it fails on.

The model is eq. 1 with a friction law that is viscous below a small slip speed ε, in plain real coordinates and
with LSODA, which copes with the stiffness of stick. ε falls with the tolerance, so that the error of both can be
estimated. Nothing is shared with the two engines of the project.
"""

from __future__ import annotations

import functools
import math
from collections.abc import Callable

import numpy as np
from scipy.integrate import LSODA

from compare.engines import Engine
from reference_model.trajectory import Phase, Solution, Trajectory

TIGHTEST = 1e-13

Law = Callable[[float, float, float], "tuple[float, float]"]


def circle(ux, uy, epsilon):
    """Return the direction of Coulomb friction against the slip u, viscous below ε."""
    speed = max(math.hypot(ux, uy), epsilon)
    return -ux / speed, -uy / speed


def wrong_sign(ux, uy, epsilon):
    fx, fy = circle(ux, uy, epsilon)
    return -fx, -fy


def square(ux, uy, epsilon):
    """Friction on each axis by itself: its limit is a square instead of the circle.

    Such a pin sticks along one axis for long, which is stiff: a coarse ε will do for an engine that is wrong.
    """
    epsilon = max(epsilon, 1e-3)
    return -ux / math.hypot(ux, epsilon), -uy / math.hypot(uy, epsilon)


def simulate(system, initial_state, times, *, tolerance=1e-9, law=circle, damping_factor=1.0):
    m, C, X0, omega = system.mass, system.stiffness, system.offset, system.disc_speed
    beta, friction = damping_factor * system.damping, system.friction_force
    epsilon = 100.0 * tolerance
    times = np.asarray(times, dtype=float)
    evaluations = 0

    def rates(_, state):
        nonlocal evaluations
        evaluations += 1
        x, y, vx, vy = state
        fx, fy = law(vx + omega * y, vy - omega * x, epsilon)
        return (
            vx,
            vy,
            (friction * fx - beta * vx - C * (x - X0)) / m,
            (friction * fy - beta * vy - C * y) / m,
        )

    def slip_and_margin(state):
        """Return the slip speed, and by how much friction exceeds what holds the pin (eq. 6)."""
        x, y, vx, vy = state
        needed = complex(C - m * omega**2, beta * omega) * complex(x, y) - C * X0
        return math.hypot(vx + omega * y, vy - omega * x), friction - abs(needed)

    # The tolerance is of the end, not of a step. Where slip starts and ends, the law has a bend.
    local = max(0.01 * tolerance, TIGHTEST)
    start = np.array(initial_state, dtype=float)
    solver = LSODA(rates, times[0], start, times[-1], rtol=local, atol=0.1 * local, first_step=1e-6)
    states = np.empty((len(times), 4))
    states[0], recorded, steps = start, 1, 0
    stuck = slip_and_margin(start)[0] < epsilon and slip_and_margin(start)[1] > 0.0
    phases = [("stick" if stuck else "slip", float(times[0]), start)]
    _, before = slip_and_margin(start)
    while solver.status == "running":
        message = solver.step()
        steps += 1
        if solver.status == "failed" or not np.all(np.isfinite(solver.y)):
            raise RuntimeError(f"LSODA gave up at t = {solver.t:g} s: {message}")
        if recorded < len(times) and times[recorded] <= solver.t:
            stop = int(np.searchsorted(times, solver.t, side="right"))
            states[recorded:stop] = solver.dense_output()(times[recorded:stop]).T
            recorded = stop
        slip, margin = slip_and_margin(solver.y)
        if stuck and margin < 0.0:
            share = before / (before - margin) if before > margin else 1.0
            t = solver.t_old + share * (solver.t - solver.t_old)
            phases.append(("slip", t, solver.dense_output()(t)))
            stuck = False
        elif not stuck and slip < epsilon and margin > 0.0:
            phases.append(("stick", solver.t, solver.y.copy()))
            stuck = True
        before = margin
    starts = [t for _, t, _ in phases]
    return Trajectory(
        system,
        times.copy(),
        states,
        tuple(
            Phase(kind, t, end, state)
            for (kind, t, state), end in zip(phases, [*starts[1:], float(times[-1])], strict=True)
        ),
        Solution("LSODA, regularised", tolerance, evaluations, steps, 0.0, epsilon),
    )


def broken_engines() -> dict[str, Engine]:
    """Return the unbroken engine ("intact") and those with one fault each."""
    return {
        "intact": Engine("intact", simulate),
        "wrong sign": Engine("wrong sign", functools.partial(simulate, law=wrong_sign)),
        "square": Engine("square", functools.partial(simulate, law=square)),
        "half the damping": Engine("half the damping", functools.partial(simulate, damping_factor=0.5)),
    }
