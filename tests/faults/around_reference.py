"""The reference with a fault outside its solver: in its output, its input or the time of release."""

import cmath
import math
from dataclasses import replace

import numpy as np

from faults.equations import carried
from faults.reference import simulate
from reference_model.contact.contact_law import ThreeTermRing
from reference_model.formulas.pin import release_time
from reference_model.support import Support
from reference_model.systems import ANGLE, DiscOnDisc, PinOnDisc


def with_output(change, system, start, times, *, tolerance=1e-9):
    """Simulate ``system`` and return ``change(trajectory)`` as its states."""
    trajectory = simulate(system, start, times, tolerance=tolerance)
    return replace(trajectory, states=change(trajectory))


def in_single_precision(trajectory):
    return trajectory.states.astype(np.float32).astype(float)


def with_angle_wrapped(trajectory):
    """Return angles between −π and π."""
    states = trajectory.states.copy()
    if isinstance(trajectory.system, DiscOnDisc):
        states[:, ANGLE] = np.angle(np.exp(1j * states[:, ANGLE]))
    return states


def without_end(trajectory):
    """Return states with NaN at the end."""
    states = trajectory.states.copy()
    states[-1] = np.nan
    return states


def with_relative_velocities(trajectory):
    """Return velocities relative to the master disc."""
    states, half = trajectory.states.copy(), trajectory.system.state_size // 2
    states[:, half:] -= carried(states[:, :half], trajectory.system.disc_speed)
    return states


def with_velocities_by_differences(trajectory):
    """Return velocities from differences of positions between samples; the first velocity is unchanged."""
    states, half = trajectory.states.copy(), trajectory.system.state_size // 2
    steps = np.diff(trajectory.times)[:, np.newaxis]
    states[1:, half:] = np.diff(states[:, :half], axis=0) / steps
    return states


def three_terms(system, start, times, *, tolerance=1e-9):
    """Simulate a ring under (23)."""
    ring = isinstance(system, DiscOnDisc) and system.contact_points is None
    law = ThreeTermRing(system.contact_radius) if ring else None
    return simulate(system, start, times, tolerance=tolerance, contact=law)


def output_late(system, start, times, *, tolerance=1e-9):
    """Return the states 1e-7 s before the requested times, except the first."""
    times = np.asarray(times, dtype=float)
    early = np.append(times[0], np.maximum(times[1:] - 1e-7, times[0]))
    return replace(simulate(system, start, early, tolerance=tolerance), times=times)


def phases_late(system, start, times, *, tolerance=1e-9):
    """Return the right states, with all switches between phases 1 ms late."""
    trajectory = simulate(system, start, times, tolerance=tolerance)
    begin, end = trajectory.times[0], trajectory.times[-1]

    def late(time):
        return min(time + 1e-3, end) if time > begin else time

    phases = (replace(one, start=late(one.start), end=late(one.end)) for one in trajectory.phases)
    return replace(trajectory, phases=tuple(phases))


def without_centripetal_term(system, start, times, *, tolerance=1e-9):
    """Simulate a pin whose release ignores the inertia force.

    If the release is too early, the pin sticks again at once.
    """
    trajectory = simulate(system, start, times, tolerance=tolerance)
    if not isinstance(system, PinOnDisc) or not Support.of(system).linear:
        return trajectory
    massless = replace(system, mass=1e-12 * system.mass)
    times = trajectory.times
    for i, phase in enumerate(trajectory.phases):
        if phase.kind != "stick":
            continue
        z = complex(*phase.initial_state[:2])
        until = min(phase.start + release_time(massless, abs(z), cmath.phase(z)), float(times[-1]))
        if until > phase.end:
            held, after = (times > phase.end) & (times <= until), times > until
            states = trajectory.states.copy()
            states[held] = [_carried_on(phase, system.disc_speed, t) for t in times[held]]
            phases = [*trajectory.phases[:i], replace(phase, end=until)]
            if np.any(after):
                let_go = _carried_on(phase, system.disc_speed, until)
                later = without_centripetal_term(system, let_go, [until, *times[after]], tolerance=tolerance)
                states[after] = later.states[1:]
                phases += later.phases
            return replace(trajectory, states=states, phases=tuple(phases))
    return trajectory


def _carried_on(phase, speed, time):
    """Return the state of a pin that still sticks at ``time``."""
    turn = cmath.exp(1j * speed * (time - phase.start))
    z, v = (complex(*pair) * turn for pair in np.split(phase.initial_state, 2))
    return np.array([z.real, z.imag, v.real, v.imag])


def half_a_pitch_on(system, start, times, *, tolerance=1e-9):
    """Simulate a disc with points at φ + 2π(i + ½)/n."""
    points = system.contact_points if isinstance(system, DiscOnDisc) else None
    if points is None:
        return simulate(system, start, times, tolerance=tolerance)
    turn = np.zeros(system.state_size)
    turn[ANGLE] = math.pi / points
    trajectory = simulate(system, np.asarray(start) + turn, times, tolerance=tolerance)
    return replace(trajectory, states=trajectory.states - turn)


def from_rest(system, start, times, *, tolerance=1e-9):
    """Simulate from the initial positions with zero velocities."""
    places, velocities = np.split(np.asarray(start, dtype=float), 2)
    return simulate(system, [*places, *(0.0 * velocities)], times, tolerance=tolerance)
