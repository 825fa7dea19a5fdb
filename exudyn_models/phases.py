"""When the pin slips and when it sticks, read from the motion under the regularised law."""

from __future__ import annotations

import numpy as np

from exudyn_models.dense_output import states_at
from exudyn_models.solving import Steps
from reference_model.systems import FloatArray, PinOnDisc
from reference_model.trajectory import Phase


def phases(pin: PinOnDisc, steps: Steps, regularisation: float) -> tuple[Phase, ...]:
    """Return the slip and stick phases from the first to the last step, without gaps.

    Under the regularised law a pin that sticks creeps with a slip speed below ε while friction is able to hold it.
    *Sticking starts* where the slip speed, which falls linearly until it is ε, would be zero if it went on falling
    like that. It *ends* where the force that is needed to turn the pin with the disc, eq. 6 evaluated on Exudyn's
    own motion, reaches μN. Both times have errors of first order in ε.
    """
    slip_speed, decay = _slip(pin, steps)
    margin = pin.friction_force - _holding_force(pin, steps.states)
    stuck = (slip_speed < regularisation) & (margin > 0.0)
    edges = np.flatnonzero(np.diff(np.concatenate(([False], stuck, [False])).astype(int)))
    found: list[Phase] = []
    time = float(steps.times[0])
    last = float(steps.times[-1])
    for first, beyond in edges.reshape(-1, 2):
        start, end = time, last
        if first > 0:
            before = first - 1
            if slip_speed[before] >= regularisation and decay[before] > 0.0:
                start = steps.times[before] + slip_speed[before] / decay[before]
            else:
                start = _root(steps.times, margin, before)
        if beyond < len(stuck):
            end = steps.times[beyond] if margin[beyond] > 0.0 else _root(steps.times, margin, beyond - 1)
        start, end = float(max(start, time)), float(min(end, last))
        if not start < end:
            continue
        if start > time:
            found.append(_phase("slip", time, start, steps))
        found.append(_phase("stick", start, end, steps))
        time = end
    if time < last or not found:
        found.append(_phase("slip", time, last, steps))
    return tuple(found)


def _phase(kind: str, start: float, end: float, steps: Steps) -> Phase:
    state = states_at(steps, np.array([start]))[0]
    return Phase("stick" if kind == "stick" else "slip", start, end, state)


def _slip(pin: PinOnDisc, steps: Steps) -> tuple[FloatArray, FloatArray]:
    """Return the slip speed in m/s and the rate at which it falls in m/s², both of shape (n,)."""
    x, y, vx, vy = steps.states.T
    ax, ay = steps.accelerations.T
    omega = pin.disc_speed
    ux, uy = vx + omega * y, vy - omega * x
    speed = np.hypot(ux, uy)
    rate = ux * (ax + omega * vy) + uy * (ay - omega * vx)
    return speed, -rate / np.where(speed > 0.0, speed, 1.0)


def _holding_force(pin: PinOnDisc, states: FloatArray) -> FloatArray:
    """Return the force in N that friction must provide so that the pin turns with the disc, shape (n,)."""
    x, y = states[:, 0], states[:, 1]
    omega = pin.disc_speed
    fx = -pin.mass * omega**2 * x - pin.damping * omega * y + pin.stiffness * (x - pin.offset)
    fy = -pin.mass * omega**2 * y + pin.damping * omega * x + pin.stiffness * y
    return np.hypot(fx, fy)


def _root(times: FloatArray, values: FloatArray, left: int) -> float:
    """Return the time between steps ``left`` and ``left + 1`` at which ``values`` pass zero."""
    share = values[left] / (values[left] - values[left + 1])
    return float(times[left] + share * (times[left + 1] - times[left]))
