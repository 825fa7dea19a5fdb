"""Right engines of many kinds, and parts of wrong ones, around the reference and ``stepping``."""

import cmath
import functools
import math
from dataclasses import replace

import numpy as np
from scipy.integrate import solve_ivp
from scipy.interpolate import CubicHermiteSpline
from stepping import cone, engine, stepped

from compare.engines import EVERY_KIND, Engine, reference
from reference_model import Trajectory


def around(name, change, kinds=("pin",), **how):
    """Return the reference with another answer, ``change(system, start, times, simulate)``."""

    def simulate(system, start, times, *, tolerance):
        times = np.asarray(times, dtype=float)
        states = change(system, start, times, functools.partial(reference.function, tolerance=tolerance))
        return Trajectory(system, times, np.vstack((start, states[1:])))

    return Engine(name, simulate, kinds, phases=False, **how)


def scaled(columns, factor):
    """Return a change that multiplies some columns of discs' or, if they are below 4, of all states."""

    def change(system, start, times, simulate):
        states = simulate(system, start, times).states.copy()
        if max(columns) < states.shape[1]:
            states[:, columns] *= factor
        return states

    return change


def in_other_time(clock):
    """Return a change that returns the state of the time ``clock(t)`` after the start."""

    def change(system, start, times, simulate):
        asked = times[0] + np.maximum(clock(times - times[0]), 1e-12 * np.arange(len(times)))
        return simulate(system, start, asked).states

    return change


def on_grid(step, states_at):
    """Return a change that computes the states on a grid and reads others by ``states_at(grid, states, times)``."""

    def change(system, start, times, simulate):
        number = max(math.ceil((times[-1] - times[0]) / step - 1e-9), 1)
        grid = times[0] + step * np.arange(number + 1)
        return states_at(grid, simulate(system, start, grid).states, times)

    return change


def nearest(grid, states, times):
    """Return the states of the nearest points of the grid."""
    return states[np.clip(np.rint((times - grid[0]) / (grid[1] - grid[0])).astype(int), 0, len(grid) - 1)]


def linear(grid, states, times):
    """Return the states by linear interpolation."""
    return np.array([np.interp(times, grid, column) for column in states.T]).T


def cubic(grid, states, times):
    """Return the states by interpolation of positions and velocities."""
    curve = CubicHermiteSpline(grid, states[:, :2], states[:, 2:])
    return np.hstack((curve(times), curve(times, 1)))


def in_batches(name, arranged, base=None):
    """Return an engine whose batches are ``arranged(systems, starts, times, answers)``."""
    base = base or engine("base")

    def simulate(*motion, **accuracy):
        return base.function(*motion, **accuracy)

    def many(systems, starts, times, **accuracy):
        motions = list(zip(systems, starts, times, strict=True))
        return arranged(*zip(*motions, strict=True), [base.function(*one, **accuracy) for one in motions])

    simulate.simulate_many = many
    return replace(base, name=name, function=simulate)


def with_steps(name, advance, step=4e-3, **how):
    """Return an engine that advances place and velocity by ``advance(system, z, v, h)``."""

    def simulate(system, start, times, *, step):
        z, v, states = complex(*start[:2]), complex(*start[2:]), [start]
        for interval in np.diff(times).tolist():
            number = max(1, math.ceil(interval / step - 1e-9))
            for _ in range(number):
                z, v = advance(system, z, v, interval / number)
            states.append([z.real, z.imag, v.real, v.imag])
        return Trajectory(system, np.asarray(times, dtype=float), np.array(states, dtype=float))

    return Engine(name, simulate, nonlinear=False, phases=False, step=step, **how)


def pull(system, z, v):
    """Return the acceleration by the support."""
    return (-system.stiffness * (z - system.offset) - system.damping * v) / system.mass


def braked(system, z, v, h):
    """Return the velocity after friction has acted for the time ``h``."""
    slip, most = v - 1j * system.disc_speed * z, h * system.friction_force / system.mass
    return v - most * cone(slip / most) if most else v


def symplectic_euler(system, z, v, h):
    """Advance as most game engines do."""
    v = braked(system, z, v + h * pull(system, z, v), h)
    return z + h * v, v


def strang(system, z, v, h):
    """Advance by half of friction, the support, and the other half."""
    v = braked(system, z, v, 0.5 * h)
    v += 0.5 * h * pull(system, z, v)
    z += h * v
    return z, braked(system, z, v + 0.5 * h * pull(system, z, v), 0.5 * h)


def position_based(system, z, v, h):
    """Advance as XPBD does, with friction as a correction of the place."""
    new, target = z + h * (v + h * pull(system, z, v)), z * cmath.exp(1j * system.disc_speed * h)
    most = h * h * system.friction_force / system.mass
    new -= most * cone((new - target) / most) if most else 0.0
    return new, (new - z) / h


def implicit(theta, system, z, v, h):
    """Advance by the θ-method, with friction that acts at the end of the step."""
    share = system.mass + h * theta * system.damping + (h * theta) ** 2 * system.stiffness
    known = z + h * (1.0 - theta) * v
    spring = (1.0 - theta) * (z - system.offset) + theta * (known - system.offset)
    free = (system.mass * v - h * ((1.0 - theta) * system.damping * v + system.stiffness * spring)) / share
    turn, carried = 1.0 - 1j * system.disc_speed * h * theta, 1j * system.disc_speed * known
    slip, most = free * turn - carried, h * system.friction_force / share
    if abs(slip) <= most * abs(turn):
        return known + h * theta * carried / turn, carried / turn
    along = slip / abs(slip)
    for _ in range(4):
        slip = (free - most * along) * turn - carried
        along = slip / abs(slip)
    return known + h * theta * (free - most * along), free - most * along


def runge_kutta(system, z, v, h):
    """Advance by two stages, with friction regularised by the step."""
    wide = h * system.friction_force / system.mass + 1e-12

    def rate(z, v):
        slip = v - 1j * system.disc_speed * z
        return pull(system, z, v) - system.friction_force / system.mass * slip / max(abs(slip), wide)

    half = v + 0.5 * h * rate(z, v)
    return z + h * half, v + h * rate(z + 0.5 * h * v, half)


def smooth(method, shape, width=1e2):
    """Return an engine of SciPy with friction ``shape(v/ε)``, where ε is ``width`` times the tolerance."""

    def simulate(system, start, times, *, tolerance):
        def rates(_, state):
            z, v = complex(*state[:2]), complex(*state[2:])
            slip = v - 1j * system.disc_speed * z
            share = shape(abs(slip) / (width * tolerance)) / max(abs(slip), 1e-300)
            a = pull(system, z, v) - system.friction_force / system.mass * share * slip
            return [v.real, v.imag, a.real, a.imag]

        local = max(0.01 * tolerance, 1e-13)
        accuracy = {"method": method, "rtol": local, "atol": local, "t_eval": times}
        found = solve_ivp(rates, (times[0], times[-1]), start, **accuracy)
        return Trajectory(system, np.asarray(times, dtype=float), found.y.T)

    return Engine(f"{method} {getattr(shape, '__name__', 'root')}", simulate, nonlinear=False, phases=False)


def in_single_precision(system, start, times, simulate):
    """Return states rounded to single precision."""
    return np.float64(np.float32(simulate(system, start, times).states))


def on_single_grid(system, start, times, *, step):
    """Step in single precision."""
    single = replace(
        system, **{name: float(np.float32(getattr(system, name))) for name in ("mass", "stiffness")}
    )
    found = stepped(single, np.float64(np.float32(start)), times, step=step)
    return Trajectory(system, np.asarray(times, dtype=float), np.float64(np.float32(found.states)))


def root(slip):
    """Return the share of friction at v/ε."""
    return slip / math.hypot(slip, 1.0)


RIGHT = (
    with_steps("symplectic Euler", symplectic_euler),
    with_steps("Strang splitting", strang),
    with_steps("XPBD", position_based),
    with_steps("θ = 1/2", functools.partial(implicit, 0.5)),
    with_steps("θ = 0.7", functools.partial(implicit, 0.7)),
    with_steps("implicit Euler", functools.partial(implicit, 1.0)),
    with_steps("Runge-Kutta", runge_kutta),
    with_steps("Runge-Kutta of order 2", runge_kutta, order=2.0),
    with_steps("game at 60 Hz", symplectic_euler, step=1.0 / 60.0),
    with_steps("short steps", symplectic_euler, step=1e-3),
    engine("previous direction", lagging=True),
    engine("sign of the slip", law=lambda impulse: impulse / abs(impulse) if impulse else 0j),
    replace(engine("single precision"), function=on_single_grid),
    replace(engine("four substeps"), function=lambda *motion, step: stepped(*motion, step=step / 4.0)),
    smooth("LSODA", math.tanh),
    smooth("LSODA", root),
    smooth("RK45", root, 1e5),
    around("states in single precision", in_single_precision),
    around("discs in single precision", in_single_precision, EVERY_KIND),
    around("own grid", on_grid(1e-3, cubic), precision=1e-5),
    in_batches("batches", lambda systems, starts, times, answers: answers),
    in_batches(
        "batches of the reference", lambda *_, answers=None: _[-1], replace(reference, kinds=("pin",))
    ),
    replace(reference, name="in other units", seed=3),
    replace(reference, name="only points", kinds=("points",)),
    replace(reference, name="only rings", kinds=("ring",)),
    replace(engine("blocks"), kinds=("block",)),
)
"""Engines of different kinds that converge to Coulomb friction."""
