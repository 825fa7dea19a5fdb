"""Energy balance of a trajectory, which checks any engine without a reference solution."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.interpolate import make_interp_spline

from reference_model.contact.contact_law import Contact, contact_of
from reference_model.support import Support
from reference_model.systems import ComplexArray, DiscOnDisc, FloatArray, System
from reference_model.trajectory import Trajectory

SPLINE_DEGREE = 5

CROWDED = 0.05
"""Distance from the end of a phase, as a share of the sampling interval, below which samples are omitted."""


@dataclass(frozen=True, eq=False)
class PowerBalance:
    """Energy balance of a trajectory; works and heats in J since the start, shape (n,).

    Parameters
    ----------
    times
        Times of the trajectory and bounds of its phases, in s.
    drive_work
        Work of the drive of the (master) disc.
    friction_heat, damper_heat
        Heat of friction and of the dampers, including a friction disc's shaft damper.
    shaft_work
        Work of a friction disc on its shaft behind the damper.
    stored_energy
        Kinetic energy plus energy of the springs.

    """

    times: FloatArray
    drive_work: FloatArray
    friction_heat: FloatArray
    damper_heat: FloatArray
    shaft_work: FloatArray
    stored_energy: FloatArray

    @property
    def residual(self) -> FloatArray:
        """Drive work minus heat, work on the shaft and gain of stored energy: zero for the exact motion."""
        gain = self.stored_energy - self.stored_energy[0]
        return np.asarray(self.drive_work - self.friction_heat - self.damper_heat - self.shaft_work - gain)

    @property
    def drive_power(self) -> float:
        """Mean power of the drive in W."""
        return float(self.drive_work[-1] / (self.times[-1] - self.times[0]))

    @property
    def turned_over(self) -> float:
        """Scale of the residual: all heat plus the largest stored energy."""
        return float(self.friction_heat[-1] + self.damper_heat[-1] + np.max(self.stored_energy))


def power_balance(trajectory: Trajectory, *, contact: Contact | None = None) -> PowerBalance:
    """Return the energy balance of ``trajectory``, whose times must be close enough to resolve the motion.

    In slip phases the friction heat is μN·∫P dt with the mean slip speed P: |w| for a pin, −F·u + M·S (per newton of
    μN) for a disc. In stick phases it is the work of the holding force and moment of eq. 6 on the engine's creep. The
    drive's work is ω times the angular impulse on the body about the axis, ∫M dt = [m·r×v + J·φ̇] + β∫r×v dt + X0∫C·y
    dt + b∫(φ̇ − Ω)dt, where C is the force of the support divided by its deflection. So the residual shows errors in
    any force, and whether the integrator conserves energy.

    The code integrates a quintic spline through the samples of each phase, with an error of sixth order in the
    sampling interval, or lower near zero slip and where a stop begins. Raises ``ValueError`` for a single time.
    """
    if not isinstance(trajectory, Trajectory):
        raise ValueError(f"trajectory = {trajectory!r}: it must be a Trajectory, such as simulate() returns")
    if len(trajectory.times) < 2:
        raise ValueError("times has one entry: a power balance needs at least two")
    body = trajectory.system
    m, beta, omega, X0 = body.mass, body.damping, body.disc_speed, body.offset
    support = Support.of(body)
    inertia, b, Omega = _shaft_of(body)
    times, states, integrals = _integrals(trajectory, contact_of(body, contact))
    z, _, v, spin = _motion(body, states)
    friction_heat, squared_speed, areal, across, lag, squared_lag = integrals.T
    momentum = m * (z.conj() * v).imag + inertia * spin
    impulse = momentum - momentum[0] + beta * areal + X0 * across + b * lag
    return PowerBalance(
        times=times,
        drive_work=omega * impulse,
        friction_heat=friction_heat,
        damper_heat=beta * squared_speed + b * squared_lag,
        shaft_work=b * Omega * lag,
        stored_energy=0.5 * m * abs(v) ** 2
        + 0.5 * inertia * spin**2
        + _of_deflection(support.energy, z - X0),
    )


def _shaft_of(body: System) -> tuple[float, float, float]:
    if isinstance(body, DiscOnDisc):
        return body.polar_inertia, body.shaft_damping, body.shaft_speed
    return 0.0, 0.0, 0.0


def _integrals(trajectory: Trajectory, law: Contact) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return times (n,), states (n, 4 or 6) and the integrals of :func:`_rates` (n, 6)."""
    times, states, integrals = [], [], []
    total = np.zeros(6)
    for kind, t, state in _spans(trajectory):
        growth = _integral(t, _rates(trajectory, law, kind, state))
        times.append(t)
        states.append(state)
        integrals.append(total + growth)
        total = total + growth[-1]
    return np.concatenate(times), np.concatenate(states), np.concatenate(integrals)


def _rates(trajectory: Trajectory, law: Contact, kind: str, state: FloatArray) -> FloatArray:
    """Return friction power, |v|², r×v, C·y, φ̇ − Ω and its square in a phase, shape (n, 6)."""
    body = trajectory.system
    omega, X0 = body.disc_speed, body.offset
    _, b, Omega = _shaft_of(body)
    z, angle, v, spin = _motion(body, state)
    u = v - 1j * omega * z
    springs = _of_deflection(Support.of(body).secant, z - X0)
    if kind == "stick":
        holding = -body.mass * omega**2 * z + 1j * body.damping * omega * z + springs * (z - X0)
        heating: FloatArray = b * (omega - Omega) * (omega - spin) - (holding.conj() * u).real
    else:
        slip = _mean_slip(law, u, omega - spin, angle)
        full = np.maximum(slip, trajectory.solution.regularisation)
        share = np.divide(slip, full, out=np.zeros_like(slip), where=full > 0.0)
        heating = body.friction_force * share * slip
    lag = spin - Omega
    return np.column_stack((heating, abs(v) ** 2, (z.conj() * v).imag, springs * z.imag, lag, lag**2))


def _of_deflection(function: Callable[[float], float], w: ComplexArray) -> FloatArray:
    return np.array([function(d) for d in abs(w).tolist()])


def _motion(body: System, state: FloatArray) -> tuple[ComplexArray, FloatArray, ComplexArray, FloatArray]:
    places, velocities = np.split(state, 2, axis=1)
    z, v = (pair[:, 0] + 1j * pair[:, 1] for pair in (places, velocities))
    if isinstance(body, DiscOnDisc):
        return z, places[:, 2], v, velocities[:, 2]
    return z, np.zeros(len(z)), v, np.zeros(len(z))


def _mean_slip(law: Contact, u: ComplexArray, relative_spin: FloatArray, angle: FloatArray) -> FloatArray:
    states = zip(u.tolist(), relative_spin.tolist(), angle.tolist(), strict=True)
    force, moment = np.transpose([law.force_and_moment(*state) for state in states])
    return np.asarray(moment.real * relative_spin - (force.conj() * u).real)


def _spans(trajectory: Trajectory) -> list[tuple[str, FloatArray, FloatArray]]:
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
    # A spline needs an odd degree and more samples than its degree.
    degree = min(SPLINE_DEGREE, (len(t) - 2) // 2 * 2 + 1)
    antiderivative = make_interp_spline(t - t[0], rates, k=degree).antiderivative()
    result: FloatArray = antiderivative(t - t[0])
    return result
