"""What engines do that are not Coulomb's: friction that knows two axes of the world, and stick along tangents."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from compare.claims.error_estimates import refined
from compare.foreign.cases import CASES, Case
from reference_model import Phase, Solution, Trajectory, plain

Law = Callable[[complex, float], complex]
"""Friction against a slip in m/s, as a fraction of μN, smoothed over a slip speed ε in m/s."""


def box(slip: complex, epsilon: float) -> complex:
    """Return what each axis has by itself: up to √2 times too large."""
    x, y = slip.real, slip.imag
    return -complex(x / max(abs(x), epsilon), y / max(abs(y), epsilon))


def pyramid(slip: complex, epsilon: float) -> complex:
    """Return what takes most power out of the slip with |F_x| + |F_y| <= μN: all along the axis nearest to it."""
    x, y = slip.real, slip.imag
    share = min(max(0.5 + 0.5 * (abs(x) - abs(y)) / epsilon, 0.0), 1.0)
    return -complex(share * x / max(abs(x), epsilon), (1.0 - share) * y / max(abs(y), epsilon))


def creep(steps: int) -> float:
    """Return how far ``steps`` along tangents of its circle carry a stuck pin off it, in m, the largest over time."""
    case = CASES["stuck"]
    i = np.linspace(0, steps, len(case.times))
    h = float(case.times[-1]) / steps
    return float(np.max(np.abs(case.start[0] * (1.0 + 1j * case.system.disc_speed * h) ** i - case.exact())))


def _run(law: Law, case: Case, epsilon: float, **options: Any) -> Any:
    """Return what ``solve_ivp`` makes of ``case`` under ``law``, smoothed over a slip of ``epsilon`` m/s."""
    pin = case.system

    def friction(slip_x: float, slip_y: float, *_: float) -> tuple[float, float, float]:
        force = pin.friction_force * law(complex(slip_x, slip_y), epsilon)
        return force.real, force.imag, 0.0

    def motion(_: float, state: np.ndarray) -> list[float]:
        return plain.rates(pin, friction, state)

    span, accuracy = (case.times[0], case.times[-1]), 1e-3 * epsilon
    return solve_ivp(
        motion, span, case.start, method="LSODA", rtol=accuracy, atol=accuracy, max_step=0.05, **options
    )


def release_by(law: Law) -> tuple[float, float]:
    """Return when a stuck pin is let go by ``law`` in s, and the error of that, see ``refined``.

    That is when its slip along an axis of the world, which creeps below ε as long as friction holds it, comes to ε.
    """
    case = CASES["release"]
    turning = 1j * case.system.disc_speed

    def time(epsilon: float) -> float:
        def beyond(_: float, state: np.ndarray) -> float:
            slip = complex(*state[2:]) - turning * complex(*state[:2])
            return max(abs(slip.real), abs(slip.imag)) - epsilon

        beyond.terminal, beyond.direction = True, 1.0  # type: ignore[attr-defined]
        events = _run(law, case, epsilon, events=beyond).t_events[0]
        return float(events[0]) if len(events) else math.nan

    value, error = refined(time, 1e-5)
    return float(value), float(error)


def release_where(held: Callable[[complex], float]) -> float:
    """Return when a stuck pin's pull, as a fraction of μN, leaves ``held`` <= 1, in s, by (6) in closed form."""
    case = CASES["release"]
    pin, start = case.system, complex(*case.start[:2])
    carried = pin.stiffness - pin.mass * pin.disc_speed**2 + 1j * pin.damping * pin.disc_speed

    def excess(time: float) -> float:
        pull = carried * start * np.exp(1j * pin.disc_speed * time) - pin.stiffness * pin.offset
        return held(pull / pin.friction_force) - 1.0

    times = np.linspace(case.times[0], case.times[-1], 401)
    beyond = [excess(time) > 0.0 for time in times]
    first = beyond.index(True)
    return float(brentq(excess, times[first - 1], times[first], xtol=1e-14)) if first else 0.0


def error_of(law: Law, name: str) -> tuple[float, float]:
    """Return how far off a pin is by that ``law`` in the case of that ``name``, in m, and the error of that number.

    It is from the change at smaller ε and tolerance, see ``refined``.
    """
    case = CASES[name]
    pin = case.system

    def off(epsilon: float) -> float:
        span, accuracy = (case.times[0], case.times[-1]), 1e-3 * epsilon
        run = _run(law, case, epsilon, t_eval=case.times)
        solution = Solution("LSODA", accuracy, run.nfev, len(run.t), 0.0, epsilon)
        phases = (Phase("slip", *span, run.y[:, 0]),)
        found = case.quantity(Trajectory(pin, case.times, run.y.T, phases, solution))
        return float(np.max(np.abs(found - case.exact())))

    value, error = refined(off, 1e-5)
    return float(value), float(error)
