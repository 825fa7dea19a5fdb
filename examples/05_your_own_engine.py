"""Your own engine in one function. Judge it with

cd examples && friction-discs report fig03 --engine 05_your_own_engine:simulate
"""  # noqa: D400, D415

import sys

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


def errors(tolerances):
    """Return the largest error in m and m/s at each tolerance, for a pin of Fig. 5 that slides for 30 s."""
    from reference_model import PinOnDisc
    from reference_model import simulate as exact

    pin = PinOnDisc(mass=1.0, stiffness=1.0, damping=0.1, friction_force=0.09, disc_speed=1.5, offset=0.1)
    start, times = (0.9, 0.0, 0.0, 0.9), np.linspace(0.0, 30.0, 31)
    expected = exact(pin, start, times, tolerance=1e-12).states
    return [
        np.abs(simulate(pin, start, times, tolerance=each).states - expected).max() for each in tolerances
    ]


def draw(path):
    """Draw the error of this engine against its tolerance."""
    from matplotlib.figure import Figure

    tolerances = 10.0 ** -np.arange(4, 10)
    figure = Figure(figsize=(4.5, 3.2), layout="constrained")
    panel = figure.subplots()
    panel.loglog(tolerances, errors(tolerances), "o-", label="error")
    panel.loglog(tolerances, tolerances, "k:", label="tolerance")
    panel.set(xlabel="tolerance", ylabel="m, m/s")
    panel.legend()
    figure.savefig(path, dpi=80)


if __name__ == "__main__":
    print(f"largest error at a tolerance of 1e-8: {errors([1e-8])[0]:.0e} m or m/s")
    if len(sys.argv) > 1:
        draw(sys.argv[1])
