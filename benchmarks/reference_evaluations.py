"""Evaluations for Fig. 5's two runs to t = 400 s: this reference, and simpler methods of the same accuracy.

Run with ``python benchmarks/reference_evaluations.py``; takes about half a minute.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Sequence

import numpy as np
from rich.console import Console
from rich.table import Table
from scipy.integrate import solve_ivp

from compare.claims.parameters import FIG5, FIG5_STARTS
from reference_model import simulate
from reference_model.formulas import pin as formulas
from reference_model.systems import FloatArray

STARTS = tuple(FIG5_STARTS.values())
UNTIL = 400.0
SAMPLES = 4001

Outcome = tuple[int, FloatArray]


def this_reference(start: Sequence[float]) -> Outcome:
    """Run the reference, with output at 4001 times."""
    trajectory = simulate(FIG5, start, np.linspace(0.0, UNTIL, SAMPLES))
    return trajectory.solution.evaluations, trajectory.at_end


def plain_events(start: Sequence[float]) -> Outcome:
    """Integrate x, y, vx, vy with a terminal event on slip speed; stick in closed form, output only at the end."""
    omega = FIG5.disc_speed
    rest = 1e-9  # slip at which the pin counts as stuck, and its initial slip along the pull after release
    state, t, evaluations = np.array(start), 0.0, 0

    def slip(_: float, y: FloatArray) -> float:
        return math.hypot(y[2] + omega * y[1], y[3] - omega * y[0]) - 0.5 * rest

    slip.terminal, slip.direction = True, -1.0  # type: ignore[attr-defined]
    while t < UNTIL:
        solution = solve_ivp(
            _eq1(0.0), (t, UNTIL), state, method="DOP853", events=slip, rtol=1e-10, atol=1e-11
        )
        evaluations += solution.nfev
        state, t = solution.y[:, -1], float(solution.t[-1])
        if t < UNTIL:
            z = complex(state[0], state[1])
            delay = formulas.release_time(FIG5, abs(z), np.angle(z))
            t += delay
            z *= np.exp(1j * omega * delay)
            pull = _acceleration(z, 1j * omega * z) + omega**2 * z
            v = 1j * omega * z + rest * pull / abs(pull)
            state = np.array((z.real, z.imag, v.real, v.imag))
    return evaluations, state


def regularised(start: Sequence[float]) -> Outcome:
    """Integrate with the law v/√(v²+ε²), ε = 1e-6 m/s; the error of the end state is due to the regularisation."""
    solution = solve_ivp(_eq1(1e-6), (0.0, UNTIL), start, method="DOP853", rtol=1e-9, atol=1e-10)
    return solution.nfev, solution.y[:, -1]


def _acceleration(z: complex, v: complex) -> complex:
    """Return the acceleration by support and damper."""
    return -(FIG5.stiffness * (z - FIG5.offset) + FIG5.damping * v) / FIG5.mass


def _eq1(epsilon: float) -> Callable[[float, FloatArray], FloatArray]:
    def rates(_: float, y: FloatArray) -> FloatArray:
        z, v = complex(y[0], y[1]), complex(y[2], y[3])
        w = v - 1j * FIG5.disc_speed * z
        a = _acceleration(z, v) - FIG5.friction_force / FIG5.mass * w / math.hypot(abs(w), epsilon)
        return np.array((v.real, v.imag, a.real, a.imag))

    return rates


def main() -> None:
    """Print the table."""
    table = Table(title="Fig. 5 to t = 400 s")
    for column in ("way", "start", "evaluations", "error of the end state", "seconds"):
        table.add_column(column, justify="left" if column == "way" else "right")
    ends = [simulate(FIG5, start, [0.0, UNTIL], tolerance=1e-13).at_end for start in STARTS]
    for way in (this_reference, plain_events, regularised):
        for number, (start, end) in enumerate(zip(STARTS, ends, strict=True), 1):
            began = time.perf_counter()
            evaluations, state = way(start)
            seconds = time.perf_counter() - began
            error = float(np.max(np.abs(state - end)))
            table.add_row(
                way.__name__.replace("_", " "),
                str(number),
                f"{evaluations:,}",
                f"{error:.1e}",
                f"{seconds:.2f}",
            )
    Console().print(table)


if __name__ == "__main__":
    main()
