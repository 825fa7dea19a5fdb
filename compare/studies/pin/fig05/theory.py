"""The motions of Fig. 5 by other ways than an engine's: plain events, the polar form, the map of stick phases."""

from __future__ import annotations

import functools
import math

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from compare.claims.error_estimates import TIGHTEST, TRUTH
from compare.claims.paper_parameters import FIG5, FIG5_STARTS
from compare.engines import Engine
from compare.studies.pin.fig05.parameters import (
    AFTERWARDS,
    BESIDE,
    CAPTURE,
    SIDES_TOLERANCE,
    SLIDING_START,
    SLIDING_TIMES,
    UNTIL,
)
from reference_model import Orbit, simulate, whirl_orbit
from reference_model.formulas.pin import release_time
from reference_model.motion.pin_equations import simulate_polar_form
from reference_model.systems import FloatArray


@functools.cache
def sliding_in_polar_form(tolerance: float) -> FloatArray:
    """Return the states of the sliding pin, shape (101, 4), by (10) and an integration of its own."""
    return simulate_polar_form(FIG5, np.array(SLIDING_START), SLIDING_TIMES, tolerance=tolerance)


@functools.cache
def whirl() -> Orbit:
    """Return the periodic orbit found by shooting with the reference at its tightest."""
    return whirl_orbit(FIG5)


@functools.cache
def reference_events(name: str) -> FloatArray:
    """Return all times in s at which the pin sticks and lets go, from the reference at its tightest."""
    return simulate(FIG5, FIG5_STARTS[name], [0.0, UNTIL], tolerance=TRUTH).stick_times


@functools.cache
def first_stick_and_release(name: str, tolerance: float) -> FloatArray:
    """Return both times from eq. 1 with a plain event on the slip speed, and eq. 7; nothing of ``simulate``.

    The event is at a slip speed s that falls with the tolerance; the slip that is left then lasts for
    s/(μN/m − |a|), where ma is the force that friction must balance in stick.
    """
    m, C, beta, omega = FIG5.mass, FIG5.stiffness, FIG5.damping, FIG5.disc_speed
    limit = 1e4 * tolerance

    def eq1(_: float, state: FloatArray) -> FloatArray:
        x, y, vx, vy = state
        wx, wy = vx + omega * y, vy - omega * x
        friction = FIG5.friction_force / math.hypot(wx, wy)
        return np.array(
            [
                vx,
                vy,
                (-beta * vx - C * (x - FIG5.offset) - friction * wx) / m,
                (-beta * vy - C * y - friction * wy) / m,
            ]
        )

    def slip(_: float, state: FloatArray) -> float:
        x, y, vx, vy = state
        return math.hypot(vx + omega * y, vy - omega * x) - limit

    slip.terminal, slip.direction = True, -1.0  # type: ignore[attr-defined]
    solution = solve_ivp(
        eq1, (0.0, 20.0), FIG5_STARTS[name], method="DOP853", events=slip, rtol=tolerance, atol=tolerance
    )
    x, y = solution.y_events[0][0][:2]
    z = complex(x, y)
    pull = -beta * 1j * omega * z - C * (z - FIG5.offset) + m * omega**2 * z
    left = limit / ((FIG5.friction_force - abs(pull)) / m)
    stick = solution.t_events[0][0] + left
    return np.array([stick, stick + release_time(FIG5, abs(z), math.atan2(y, x) + omega * left)])


@functools.lru_cache(maxsize=8)
def critical_velocity(engine: Engine, tolerance: float) -> float:
    """Return vx(0) in m/s at which stick phases neither move outwards nor inwards.

    It is no number for an engine whose pin does not stick twice, or moves the same way from both starts. At small
    tolerances it is looked for beside that of a larger one first.
    """

    def outward(velocity: float) -> float:
        trajectory = engine.simulate(FIG5, (0.1, 0.0, velocity, 0.0), [0.0, 15.0], tolerance=tolerance)
        radii = [math.hypot(*phase.initial_state[:2]) for phase in trajectory.stick_phases[:2]]
        return radii[1] - radii[0] if len(radii) == 2 else math.nan

    def between(low: float, high: float) -> float:
        if not outward(low) * outward(high) < 0.0:
            return math.nan
        return float(brentq(outward, low, high, xtol=1e-4 * CAPTURE))

    if tolerance < SIDES_TOLERANCE:
        rough = critical_velocity(engine, SIDES_TOLERANCE)
        if math.isfinite(rough) and math.isfinite(near := between(rough - BESIDE, rough + BESIDE)):
            return near
    low, high = (start[2] for start in FIG5_STARTS.values())
    return between(low, high)


@functools.cache
def predicted_critical_velocity() -> float:
    """Return ``critical_velocity`` by the reference."""
    return critical_velocity(Engine("reference", simulate), TIGHTEST)


def outside_at_end(engine: Engine, velocity: float, tolerance: float) -> float:
    """Return how much farther than 2·X0 from the axis the pin with vx(0) = ``velocity`` in m/s ends, in m."""
    trajectory = engine.simulate(FIG5, (0.1, 0.0, velocity, 0.0), [0.0, AFTERWARDS], tolerance=tolerance)
    return float(trajectory.radius[-1]) - 2.0 * FIG5.offset
