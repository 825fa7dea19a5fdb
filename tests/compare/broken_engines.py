"""An engine of its own kind, and engines broken on purpose: a check is worth what it fails on.

The one that is right is that of ``compare.judge.faults``. The model of most of the broken ones is eq. 1 or 19 with a
friction law that is viscous below a small slip speed ε, in plain coordinates and with LSODA, which copes with the
stiffness of stick. ε falls with the tolerance, so that errors can be estimated. Nothing is shared with the two
engines of the project.
"""

from __future__ import annotations

import cmath
import functools
import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np
from scipy.integrate import LSODA
from scipy.special import ellipe, ellipkm1

from compare.engines import EVERY_KIND, Engine
from compare.judge.faults import plain
from reference_model.systems import DiscOnDisc
from reference_model.trajectory import Phase, Solution, Trajectory

TIGHTEST, NARROWEST = 1e-12, 1e-8
"""Tolerance and ε in m/s below which rounding of the slip makes LSODA's steps in stick collapse."""

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


def ring(slip, relative_spin, radius, epsilon):
    """Return force and moment of (20) per newton of μN, viscous below a mean slip speed ε."""
    u, w = abs(slip), radius * abs(relative_spin)
    if u + w == 0.0:
        return 0j, 0.0
    m = min(4.0 * (u / (u + w)) * (w / (u + w)), 1.0)  # rounding
    complement = ((u - w) / (u + w)) ** 2
    first, second = (ellipkm1(complement) if u != w else 0.0), ellipe(m)
    mean = 2.0 / math.pi * (u + w) * second
    by_slip = ((u + w) * second + (u - w) * first) / (math.pi * u) if u > 1e-9 * w else u / (2.0 * w)
    by_rim = ((u + w) * second - (u - w) * first) / (math.pi * w) if w > 1e-9 * u else w / (2.0 * u)
    full = min(1.0, mean / epsilon)
    force = -full * by_slip * slip / u if u > 0.0 else 0j
    return force, full * math.copysign(radius * by_rim, relative_spin)


def on_points(slip, relative_spin, angle, radius, points, law, epsilon):
    """Return force and moment of points on a circle, each with its share of μN."""
    force, moment = 0j, 0.0
    for i in range(points):
        arm = radius * cmath.exp(1j * (angle + 2.0 * math.pi * i / points))
        velocity = slip - 1j * relative_spin * arm
        friction = complex(*law(velocity.real, velocity.imag, epsilon)) / points
        force += friction
        moment += (arm.conjugate() * friction).imag
    return force, moment


def simulate(
    system,
    initial_state,
    times,
    *,
    tolerance=1e-9,
    law=circle,
    moment_factor=1.0,
    points=None,
    turning=1.0,
):
    m, C, X0, omega = system.mass, system.stiffness, system.offset, system.disc_speed
    beta, friction = system.damping, system.friction_force
    epsilon = max(100.0 * tolerance, NARROWEST)
    times = np.asarray(times, dtype=float)
    is_disc = isinstance(system, DiscOnDisc)
    if is_disc:
        points = points or system.contact_points or (None if law is circle else 12)
    evaluations = 0

    def contact(slip, relative_spin, angle):
        if not is_disc:
            return complex(*law(slip.real, slip.imag, epsilon)), 0.0
        if points is None:
            return ring(slip, relative_spin, system.contact_radius, epsilon)
        return on_points(slip, relative_spin, angle, system.contact_radius, points, law, epsilon)

    def pull(z):
        """Return the force of springs and stop against the deflection, and 0 at none."""
        w = z - X0
        d = abs(w)
        stop = system.stop_stiffness * max(0.0, d - system.stop_gap)
        return (C + system.hardening * d**2) * w + (stop * w / d if stop > 0.0 else 0.0)

    def rates(_, state):
        nonlocal evaluations
        evaluations += 1
        places, velocities = state[: len(state) // 2], state[len(state) // 2 :]
        (x, y), (vx, vy) = places[:2], velocities[:2]
        angle, spin = (places[2], velocities[2]) if is_disc else (0.0, 0.0)
        force, moment = contact(complex(vx + omega * y, vy - omega * x), omega - spin, angle)
        spring = pull(complex(x, y))
        forces = [
            (friction * force.real - beta * vx - spring.real) / m,
            (friction * force.imag - beta * vy - spring.imag) / m,
        ]
        if not is_disc:
            return (vx, vy, *forces)
        shaft = -system.shaft_damping * (spin - system.shaft_speed)
        torsion = (moment_factor * friction * moment + shaft) / system.polar_inertia
        return (vx, vy, turning * spin, *forces, torsion)

    def slip_and_margin(state):
        """Return the slip speed, and by how much friction exceeds what holds the pin (eq. 6).

        A disc is said to slip all the time: where it rests, friction is viscous.
        """
        if is_disc:
            return math.inf, -1.0
        x, y, vx, vy = state
        needed = complex(-m * omega**2, beta * omega) * complex(x, y) + pull(complex(x, y))
        return math.hypot(vx + omega * y, vy - omega * x), friction - abs(needed)

    # The tolerance is of the end, not of a step. Where slip starts and ends, the law has a bend.
    local = max(0.01 * tolerance, TIGHTEST)
    start = np.array(initial_state, dtype=float)
    solver = LSODA(rates, times[0], start, times[-1], rtol=local, atol=0.1 * local, first_step=1e-6)
    states = np.empty((len(times), len(start)))
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


def half_the_damping(system, *arguments, **options):
    weaker = replace(system, damping=0.5 * system.damping)
    return replace(plain.simulate(weaker, *arguments, **options), system=system)


def broken(name, **fault):
    return Engine(name, functools.partial(simulate, **fault), EVERY_KIND)


def broken_engines() -> dict[str, Engine]:
    """Return the unbroken engine ("intact") and those with one fault each."""
    engines = (
        Engine("intact", plain.simulate, EVERY_KIND),
        broken("wrong sign", law=wrong_sign),
        broken("square", law=square),
        Engine("half the damping", half_the_damping, EVERY_KIND),
    )
    return {engine.name: engine for engine in engines}


def broken_on_discs() -> dict[str, Engine]:
    """Return engines with faults that only a friction disc can have."""
    engines = (
        broken("moment of the wrong sign", moment_factor=-1.0),
        broken("moment 1 % off", moment_factor=1.01),
        broken("five points", points=5),
        broken("angle of half the spin", turning=0.5),
    )
    return {engine.name: engine for engine in engines}
