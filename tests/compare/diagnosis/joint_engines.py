"""Engines of joints, some with one mistake each."""

import itertools
import math
from dataclasses import replace
from functools import partial

import numpy as np
from scipy.integrate import solve_ivp

from compare.engines import Engine
from reference_model import Trajectory


def load_of(joint):
    """Return the load on friction as a function of the time, the angle and the spin."""
    times, values = zip(*joint.moment, strict=True) if joint.moment else ((0.0,), (0.0,))

    def load(t, angle, spin):
        applied = np.interp(t, times, values) if len(times) > 1 else values[0]
        return applied - joint.stiffness * (angle - joint.offset) - joint.damping * spin

    return load


def stepped(
    joint, start, times, *, step,
    friction=None, static=None, inertia=1.0, damping=True, late=0.0, drag=0.0, stops_below=0.0, bounce=0.0,
    implicit=False, spring=1.0, theta=0.5, moment_at=0.5, noise=0.0, leaks=0.0, heals=0.0, drift=0.0,
):  # fmt: skip
    """Simulate by Moreau's time stepping, or by the θ method if ``implicit``.

    ``friction`` maps joint, spin, angle and step to a factor of F. ``static`` replaces the static ratio. ``inertia``
    and ``spring`` are factors, ``late`` delays a breakaway in s, and ``drag`` in 1/s is hidden damping.
    ``stops_below`` is the speed in rad/s that counts as rest, and ``bounce`` the speed after a stop. ``moment_at`` is
    the place in a step where the applied moment is read. After ``leaks`` (s) a joint at rest is free. After a
    slide, ``heals`` replaces the static ratio, and a joint at rest turns with ``drift`` in rad/s.
    """
    load, mass = load_of(joint), inertia * joint.inertia
    ratio = static(joint) if callable(static) else static or joint.static_ratio
    (angle, spin), found, held, rested, top, moved = start, [start], 0.0, 0.0, 0.0, False
    random = np.random.default_rng()
    for begin, end in itertools.pairwise(times):
        number = max(1, math.ceil((end - begin) / step - 1e-9))
        h = (end - begin) / number
        for i in range(number):
            at, before = begin + (i + moment_at) * h, spin
            rests = spin == 0.0
            middle = angle + (theta if implicit else 0.5) * h * spin
            push = load(at, joint.offset + spring * (middle - joint.offset), spin if damping else 0.0)
            if implicit:  # the spring and the damper at θ
                rate = theta * h * (joint.damping + theta * h * joint.stiffness * spring)
                free = spin + h * push / (mass + rate)
                most = h * joint.friction_moment / (mass + rate)
            else:
                free, most = spin + h * push / mass, h * joint.friction_moment / mass
            most *= 1.0 if friction is None else friction(joint, spin, angle, h)
            top = max(top, abs(before))
            most *= not 0.0 < leaks < rested
            limit = most * (heals if heals and moved else ratio) if rests else most
            moved = moved or not rests
            rested = rested + h if rests else 0.0
            breaks = abs(free) > limit
            held = held + h if rests and breaks else 0.0
            if rests and (not breaks or held <= late):
                spin = 0.0
            elif abs(free) <= most or (heals and before * free < 0.0):
                spin = -bounce * (free > 0.0) if bounce < top else 0.0
                top = 0.0
            else:
                spin = free - math.copysign(most, free)
            spin *= math.exp(-drag * h)
            if noise:
                spin *= 1.0 + noise * random.standard_normal()
            if abs(spin) < stops_below:
                spin = 0.0
            angle += h * drift * (moved and spin == 0.0)
            angle += h * (spin if implicit and theta == 1.0 else 0.5 * (before + spin))
        found.append((angle, spin))
    return Trajectory(joint, np.asarray(times, dtype=float), np.array(found, dtype=float))


def smooth(joint, start, times, *, tolerance, epsilon=None, shape=np.tanh, method="Radau"):
    """Integrate friction F·shape(ω/ε) with ε = 100 tolerances times the speed, or a constant ``epsilon`` in rad/s.

    At slow slip the static ratio acts as a bump, so the joint breaks away at the right load.
    """
    load = load_of(joint)
    rate = joint.friction_moment / joint.inertia
    slow = epsilon or 100.0 * tolerance * max(abs(start[1]), 0.1 * rate, 1e-3)

    def rates(t, state):
        bump = 1.0 + (joint.static_ratio - 1.0) * math.exp(-((state[1] / (1000.0 * slow)) ** 2))
        pull = joint.friction_moment * bump * shape(state[1] / slow)
        return state[1], (load(t, *state) - pull) / joint.inertia

    found = [start]
    bends = [t for t, _ in joint.moment if times[0] < t < times[-1]]
    state, size = np.array(start, dtype=float), max(abs(start[1]), 1e-3)
    for begin, end in itertools.pairwise(times):
        nodes = [begin, *(t for t in bends if begin < t < end), end]
        for one, other in itertools.pairwise(nodes):
            accuracy = {"rtol": max(0.01 * tolerance, 3e-14), "atol": max(0.01 * tolerance * size, 1e-14)}
            state = solve_ivp(rates, (one, other), state, method, **accuracy).y[:, -1]
        found.append(state)
    return Trajectory(joint, np.asarray(times, dtype=float), np.array(found, dtype=float))


def euler(joint, start, times, *, step, gain=1.0):
    """Simulate by explicit Euler steps with F·sign(ω)."""
    load, (angle, spin), found = load_of(joint), start, [start]
    for begin, end in itertools.pairwise(times):
        number = max(1, math.ceil((end - begin) / step - 1e-9))
        h = (end - begin) / number
        for i in range(number):
            pull = gain * joint.friction_moment * np.sign(spin)
            angle, spin = (
                angle + h * spin,
                spin + h * (load(begin + i * h, angle, spin) - pull) / joint.inertia,
            )
        found.append((angle, spin))
    return Trajectory(joint, np.asarray(times, dtype=float), np.array(found, dtype=float))


def changed(change):
    """Return time stepping whose states are changed afterwards."""

    def simulate(joint, start, times, *, step):
        run = stepped(joint, start, times, step=step)
        return Trajectory(joint, run.times, change(run.states))

    return simulate


def karnopp(joint, start, times, *, step):
    """Simulate by semi-implicit Euler steps, with rest below the speed that friction stops within a step."""
    load, (angle, spin), found = load_of(joint), start, [start]
    for begin, end in itertools.pairwise(times):
        number = max(1, math.ceil((end - begin) / step - 1e-9))
        h = (end - begin) / number
        most = h * joint.friction_moment / joint.inertia
        for i in range(number):
            pull = load(begin + i * h, angle, spin)
            if abs(spin) <= most and abs(pull) <= joint.static_ratio * joint.friction_moment:
                spin = 0.0
            else:
                way = np.sign(spin) if abs(spin) > most else np.sign(pull)
                spin += h * pull / joint.inertia - way * most
            angle += h * spin
        found.append((angle, spin))
    return Trajectory(joint, np.asarray(times, dtype=float), np.array(found, dtype=float))


def without_offset(joint, start, times, *, step):
    """Simulate with a spring that is relaxed at 0."""
    return stepped(replace(joint, offset=0.0), start, times, step=step)


def three_points(joint, start, times, *, step):
    """Simulate with the first three points of the moment."""
    return stepped(replace(joint, moment=joint.moment[:3]), start, times, step=step)


def kicked(joint, start, times, *, step):
    """Simulate with speeds of at least 1 mrad/s after a slow start."""
    run = stepped(joint, (start[0], max(start[1], 1e-3) if start[1] > 0.0 else start[1]), times, step=step)
    after = np.where(np.abs(run.states[:, 1:]) > 0.0, 1.0, float(0.0 < start[1] < 1e-3)) * [[0.0, 1e-3]]
    return Trajectory(
        joint, run.times, np.vstack((start, np.where(run.states == 0.0, after, run.states)[1:]))
    )


def engine(name, function=stepped, step=1e-3, **how):
    """Return an engine of joints with a fixed step, or with a tolerance if ``step`` is None."""
    return Engine(name, partial(function, **how), ("joint",), phases=False, step=step)
