"""Energy and power balance of a trajectory, a check of any engine without a reference solution."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.interpolate import make_interp_spline

from reference_model.systems import FloatArray
from reference_model.trajectory import Trajectory

SPLINE_DEGREE = 5

CROWDED = 0.05
"""Samples nearer than this fraction of their usual distance to the end of a phase are left out."""


@dataclass(frozen=True, eq=False)
class PowerBalance:
    """Where the energy went that the drive of the disc put in; all in J since the start, shape (n,).

    Parameters
    ----------
    times : array
        In s: those of the trajectory, and the bounds of its phases.
    drive_work : array
        What the drive of the disc put in.
    friction_heat, damper_heat : array
        What friction and the dampers of the support turned into heat.
    stored_energy : array
        Kinetic energy and that of the springs, itself, not since the start.

    """

    times: FloatArray
    drive_work: FloatArray
    friction_heat: FloatArray
    damper_heat: FloatArray
    stored_energy: FloatArray

    @property
    def residual(self) -> FloatArray:
        """Drive work less heat less gain of stored energy: zero for the right motion."""
        gain = self.stored_energy - self.stored_energy[0]
        return np.asarray(self.drive_work - self.friction_heat - self.damper_heat - gain)

    @property
    def drive_power(self) -> float:
        """Mean power of the drive in W."""
        return float(self.drive_work[-1] / (self.times[-1] - self.times[0]))

    @property
    def turned_over(self) -> float:
        """Energy by which to judge the residual: all heat, and the most that was stored."""
        return float(self.friction_heat[-1] + self.damper_heat[-1] + np.max(self.stored_energy))


def power_balance(trajectory: Trajectory) -> PowerBalance:
    """Return the energy balance of ``trajectory``.

    The friction heat is μN·∫|w|dt in slip phases (with the smoothing that the engine declared). In stick
    phases it is the work of the force that holds the pin by eq. 6 on whatever creep the engine shows, which
    is none for exact friction. The drive's work is ω times the moment impulse on the pin, and that is taken
    from the pin's motion, not from a friction law: by its angular momentum about the axis,
    ∫M dt = [m·r×v] + β∫r×v dt + C·X0∫y dt. So the residual vanishes only if force and motion belong together:
    friction against the slip and of the magnitude μN, the damping β, the springs, energy neither made nor
    lost by the integrator.

    The integrals are those of a quintic spline through the samples of each phase. Their error falls with the
    sixth power of the distance of samples where slip is well away from zero, and more slowly near it.

    Parameters
    ----------
    trajectory : Trajectory
        Of a pin, at times close enough to resolve the motion.

    Raises
    ------
    ValueError
        If the trajectory has one time only.

    """
    if len(trajectory.times) < 2:
        raise ValueError("the trajectory has one time only: a power balance takes at least two")
    pin, regularisation = trajectory.system, trajectory.solution.regularisation
    m, C, beta, omega, X0 = pin.mass, pin.stiffness, pin.damping, pin.disc_speed, pin.offset
    times, states, integrals = [], [], []
    total = np.zeros(4)
    for kind, t, state in _spans(trajectory):
        x, y, vx, vy = state.T
        wx, wy = vx + omega * y, vy - omega * x
        if kind == "slip":
            slip = np.hypot(wx, wy)
            full = np.maximum(slip, regularisation)
            share = np.divide(slip, full, out=np.zeros_like(slip), where=full > 0.0)
            heating = pin.friction_force * share * slip
        else:
            holding_x = -m * omega**2 * x - beta * omega * y + C * (x - X0)
            holding_y = -m * omega**2 * y + beta * omega * x + C * y
            heating = -(holding_x * wx + holding_y * wy)
        rates = np.column_stack((heating, vx**2 + vy**2, x * vy - y * vx, y))
        growth = _integral(t, rates)
        times.append(t)
        states.append(state)
        integrals.append(total + growth)
        total = total + growth[-1]
    x, y, vx, vy = np.concatenate(states).T
    friction_heat, squared_speed, areal, deflection = np.concatenate(integrals).T
    momentum = m * (x * vy - y * vx)
    impulse = momentum - momentum[0] + beta * areal + C * X0 * deflection
    return PowerBalance(
        times=np.concatenate(times),
        drive_work=omega * impulse,
        friction_heat=friction_heat,
        damper_heat=beta * squared_speed,
        stored_energy=0.5 * m * (vx**2 + vy**2) + 0.5 * C * ((x - X0) ** 2 + y**2),
    )


def _spans(trajectory: Trajectory) -> list[tuple[str, FloatArray, FloatArray]]:
    """Return kind, times and states of each phase, its bounds included."""
    spans: list[tuple[str, FloatArray, FloatArray]] = []
    ends = [phase.initial_state for phase in trajectory.phases[1:]] + [trajectory.at_end]
    for phase, end_state in zip(trajectory.phases, ends, strict=True):
        if phase.end <= phase.start:
            continue
        margin = CROWDED * min(float(np.min(np.diff(trajectory.times))), phase.end - phase.start)
        inside = (trajectory.times > phase.start + margin) & (trajectory.times < phase.end - margin)
        t = np.concatenate(([phase.start], trajectory.times[inside], [phase.end]))
        spans.append((phase.kind, t, np.vstack((phase.initial_state, trajectory.states[inside], end_state))))
    return spans


def _integral(t: FloatArray, rates: FloatArray) -> FloatArray:
    """Return the integrals of ``rates`` (shape (n, k)) from ``t[0]`` to each time."""
    # Interpolation takes an odd degree and more samples than that.
    degree = min(SPLINE_DEGREE, (len(t) - 2) // 2 * 2 + 1)
    antiderivative = make_interp_spline(t - t[0], rates, k=degree).antiderivative()
    result: FloatArray = antiderivative(t - t[0])
    return result
