"""Your own engine in one function. Judge it with

cd examples && friction-discs report fig03 --engine 05_your_own_engine:simulate
"""  # noqa: D400, D415

import numpy as np
from scipy.integrate import solve_ivp

from reference_model import Trajectory


def simulate(pin, initial_state, times, *, tolerance=1e-9):
    """Integrate eq. 1 with friction regularised below a slip speed of 100·tolerance."""
    turning = pin.disc_speed * np.array([[0.0, 1.0], [-1.0, 0.0]])
    slow = 100 * tolerance

    def eq1(_, state):
        position, velocity = state[:2], state[2:]
        slip = velocity + turning @ position
        friction = -pin.friction_force * slip / max(np.hypot(*slip), slow)
        springs = -pin.stiffness * (position - (pin.offset, 0.0))
        return *velocity, *((friction + springs - pin.damping * velocity) / pin.mass)

    def jacobian(_, state):
        slip = state[2:] + turning @ state[:2]
        speed, one = np.hypot(*slip), np.eye(2)
        across = one - np.outer(slip, slip) / speed**2 if speed > slow else one
        hold = pin.friction_force / max(speed, slow) * across
        by_position = -(hold @ turning + pin.stiffness * one) / pin.mass
        return np.block([[0 * one, one], [by_position, -(hold + pin.damping * one) / pin.mass]])

    local = max(0.01 * tolerance, 1e-13)  # error per step, so that the final state meets the tolerance
    span, accuracy = (times[0], times[-1]), {"rtol": local, "atol": local}
    run = solve_ivp(eq1, span, initial_state, method="LSODA", t_eval=times, jac=jacobian, **accuracy)
    return Trajectory(pin, run.t, run.y.T)


simulate.nonlinear = False  # no hardening springs and no stops
