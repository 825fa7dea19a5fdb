"""A third engine for the comparison: implement one function. Judge it with

cd examples && friction-discs report fig03 --engine 05_your_own_engine:simulate
"""  # noqa: D400, D415

from scipy.integrate import solve_ivp

from reference_model import Phase, Solution, Trajectory


def simulate(pin, initial_state, times, *, tolerance=1e-9):
    """Integrate eq. 1 with friction that is viscous below a slip speed of 100·tolerance."""

    def eq1(_, state):
        z, v = complex(*state[:2]), complex(*state[2:])
        w = v - 1j * pin.disc_speed * z  # slip
        friction = -pin.friction_force * w / max(abs(w), 100 * tolerance)
        a = (friction - pin.damping * v - pin.stiffness * (z - pin.offset)) / pin.mass
        return v.real, v.imag, a.real, a.imag

    local = max(0.01 * tolerance, 1e-13)  # of a step, so that the end is good to the tolerance
    span = (times[0], times[-1])
    run = solve_ivp(eq1, span, initial_state, method="LSODA", t_eval=times, rtol=local, atol=local)
    phases = (Phase("slip", *span, run.y[:, 0]),)
    return Trajectory(pin, run.t, run.y.T, phases, Solution("LSODA", tolerance, run.nfev, len(run.t), 0.0))
