"""What engines do that are not Coulomb's: friction that knows two axes of the world, and stick along tangents."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from scipy.integrate import solve_ivp

from compare.accuracy import refined
from compare.foreign.cases import CASES
from reference_model import Phase, Solution, Trajectory

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


def error_of(law: Law, name: str) -> tuple[float, float]:
    """Return how far off a pin is by that ``law`` in the case of that ``name``, in m, and the error of that number.

    It is from the change at smaller ε and tolerance, see ``refined``.
    """
    case = CASES[name]
    pin = case.system

    def off(epsilon: float) -> float:
        def motion(_: float, state: np.ndarray) -> tuple[float, ...]:
            z, v = complex(*state[:2]), complex(*state[2:])
            friction = pin.friction_force * law(v - 1j * pin.disc_speed * z, epsilon)
            a = (friction - pin.damping * v - pin.stiffness * (z - pin.offset)) / pin.mass
            return v.real, v.imag, a.real, a.imag

        span, accuracy = (case.times[0], case.times[-1]), 1e-3 * epsilon
        run = solve_ivp(
            motion,
            span,
            case.start,
            method="LSODA",
            t_eval=case.times,
            rtol=accuracy,
            atol=accuracy,
            max_step=0.05,
        )
        solution = Solution("LSODA", accuracy, run.nfev, len(run.t), 0.0, epsilon)
        phases = (Phase("slip", *span, run.y[:, 0]),)
        found = case.quantity(Trajectory(pin, case.times, run.y.T, phases, solution))
        return float(np.max(np.abs(found - case.exact())))

    value, error = refined(off, 1e-5)
    return float(value), float(error)
