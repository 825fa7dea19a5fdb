"""Euler's method fails, Runge–Kutta passes: pytest --pyargs compare --engine 07_engine_under_pytest:euler."""

import sys
from functools import partial

import numpy as np

from reference_model import Phase, Solution, Trajectory


def euler(pin, initial_state, times, *, tolerance=1e-9, step=1e-3, advance=lambda f, y, h: y + h * f(y)):
    """Integrate eq. 1 with a fixed step. It ignores ``tolerance``, so its error cannot be estimated."""

    def eq1(y):
        (z, v), X0 = y.tolist(), pin.offset
        w, d = v - 1j * pin.disc_speed * z, max(abs(z - X0), 1e-99)  # slip, deflection
        spring = pin.stiffness + pin.hardening * d**2 + pin.stop_stiffness * max(0.0, 1.0 - pin.stop_gap / d)
        force = -spring * (z - X0) - pin.damping * v - pin.friction_force * w / abs(w)
        return np.array([v, force / pin.mass])

    states = [np.array(initial_state, dtype=float)]
    for span in np.diff(times):
        y, steps = states[-1][::2] + 1j * states[-1][1::2], int(np.ceil(span / step))
        for _ in range(steps):
            y = advance(eq1, y, span / steps)
        states.append(y.view(float))
    phases = (Phase("slip", times[0], times[-1], states[0]),)
    return Trajectory(pin, np.array(times), np.array(states), phases, Solution("Euler", tolerance, 0, 0, 0.0))


def fourth_order(f, y, h):  # noqa: D103
    k1 = f(y)
    k2 = f(y + h / 2 * k1)
    k3 = f(y + h / 2 * k2)
    return y + h / 6 * (k1 + 2 * k2 + 2 * k3 + f(y + h * k3))


runge_kutta = partial(euler, advance=fourth_order)
runge_kutta.step = 0.01  # s
euler.sticks = runge_kutta.sticks = False


def errors(engine, steps):
    """Return the largest error in m and m/s at each step in s, for a pin that slides for 10 s."""
    from reference_model import PinOnDisc, simulate

    pin = PinOnDisc(mass=1.0, stiffness=1.0, damping=0.1, friction_force=0.09, disc_speed=1.5, offset=0.1)
    start, times = (0.9, 0.0, 0.0, 0.9), (0.0, 10.0)
    exact = simulate(pin, start, times, tolerance=1e-12).at_end
    return [np.abs(engine(pin, start, times, step=step).at_end - exact).max() for step in steps]


def draw(path):
    """Draw the error of both methods against the step."""
    from matplotlib.figure import Figure

    steps = np.array([0.01, 0.02, 0.05, 0.1])
    figure = Figure(figsize=(4.5, 3.2), layout="constrained")
    panel = figure.subplots()
    for name, engine in (("Euler", euler), ("Runge–Kutta", runge_kutta)):
        panel.loglog(steps, errors(engine, steps), "o-", label=name)
    panel.set(xlabel="step in s", ylabel="error in m, m/s")
    panel.legend()
    figure.savefig(path, dpi=80)


if __name__ == "__main__":
    for name, engine in (("Euler", euler), ("Runge–Kutta", runge_kutta)):
        print(f"{name}: error {errors(engine, [0.01])[0]:.0e} m or m/s with steps of 0.01 s")
    if len(sys.argv) > 1:
        draw(sys.argv[1])
