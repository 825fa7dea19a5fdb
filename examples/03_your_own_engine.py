"""A third engine for the comparison: implement one function. Judge it with

cd examples && friction-discs report fig03 --engine 03_your_own_engine:simulate
"""  # noqa: D400, D415

import numpy as np
from scipy.integrate import solve_ivp

from reference_model import Phase, Solution, Trajectory


def simulate(system, initial_state, times, *, tolerance=1e-9):
    """Integrate eq. 1 with friction that is viscous below a slip speed of 100·tolerance."""
    m, C, beta, omega, slow = (
        system.mass,
        system.stiffness,
        system.damping,
        system.disc_speed,
        100 * tolerance,
    )

    def eq1(_, state):
        x, y, vx, vy = state
        wx, wy = vx + omega * y, vy - omega * x  # slip
        mu_n = system.friction_force / max(np.hypot(wx, wy), slow)
        ax, ay = -beta * vx - C * (x - system.offset) - mu_n * wx, -beta * vy - C * y - mu_n * wy
        return vx, vy, ax / m, ay / m

    times = np.array(times, dtype=float)
    span, local = (times[0], times[-1]), max(0.01 * tolerance, 1e-13)  # of a step, not of the end
    run = solve_ivp(eq1, span, initial_state, method="LSODA", t_eval=times, rtol=local, atol=local)
    phases = (Phase("slip", *span, run.y[:, 0]),)
    solution = Solution("LSODA", tolerance, run.nfev, len(run.t), wall_time=0.0, regularisation=slow)
    return Trajectory(system, times, run.y.T, phases, solution)
