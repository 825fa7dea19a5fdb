"""Eq. 1 integrated as plainly as can be, in real coordinates, to judge the reference and its checks by."""

import math

import numpy as np
from plain_slip import slide
from scipy.optimize import brentq

from reference_model import plain
from reference_model.systems import PinOnDisc
from reference_model.trajectory import Phase, Solution, Trajectory

TIGHTEST = 3e-14


def slip_velocity(pin, state):
    x, y, vx, vy = state
    return np.array([vx + pin.disc_speed * y, vy - pin.disc_speed * x])


def support_force(pin, state):
    """Force of springs, stop and dampers on the pin."""
    return pin.mass * rates(pin, state, np.zeros_like)[2:]


def stuck_state(pin, x, y):
    return np.array([x, y, -pin.disc_speed * y, pin.disc_speed * x])


def turned_with_disc(pin, state, time):
    """State of a stuck pin after ``time``."""
    c, s = math.cos(pin.disc_speed * time), math.sin(pin.disc_speed * time)
    x, y = state[0], state[1]
    return stuck_state(pin, c * x - s * y, s * x + c * y)


def pull_on_stuck_pin(pin, state):
    """Force in N that friction must balance for the pin to turn with the disc (6)."""
    return support_force(pin, state) + pin.mass * pin.disc_speed**2 * np.asarray(state[:2])


def rates(pin, state, friction):
    """Right side of (1) with the friction force ``friction(slip_velocity)`` in N."""
    return np.array(plain.rates(pin, of_vector(friction), state))


def of_vector(friction):
    """Friction as ``plain`` has it, of a force that is a function of the slip velocity in m/s, shape (2,)."""
    return lambda slip_x, slip_y, *_: (*friction(np.array([slip_x, slip_y])), 0.0)


def coulomb(pin):
    return lambda slip: -pin.friction_force * slip / math.hypot(*slip)


def stick_time_bounds(pin, state, start, longest, slip=2e-10):
    """Earliest and latest time at which slip that began at ``start`` ends, and time and state just before.

    Just before, at the slip speed ``slip``, the integration stops. From there slip speed falls at a rate between
    (μN − pull)/m and (μN + pull)/m, whatever its direction, so what is left has bounds.
    """

    def slow(_, s):
        return math.hypot(*slip_velocity(pin, s)) - slip

    slow.terminal, slow.direction = True, -1.0
    run = slide(pin, state, [start, start + longest], events=slow, t_eval=None)
    state = run.y[:, -1]
    pull = math.hypot(*pull_on_stuck_pin(pin, state))
    left = [pin.mass * slip / (pin.friction_force + sign * pull) for sign in (1.0, -1.0)]
    return run.t[-1] + left[0], run.t[-1] + left[1], run.t[-1], state


def release_after(pin, state, longest):
    """Time until friction can no longer hold a stuck pin, from a fine grid and a bracketed root."""

    def excess(time):
        return math.hypot(*pull_on_stuck_pin(pin, turned_with_disc(pin, state, time))) - pin.friction_force

    grid = np.linspace(0.0, longest, 2001)
    first = next((i for i, time in enumerate(grid) if excess(time) > 0.0), 0)
    return brentq(excess, grid[first - 1], grid[first], xtol=1e-15) if first else 0.0


def just_released(pin, state, delay):
    """State ``delay`` after friction let go at ``state``: slip grows like ½κt² along the pull."""

    def strength(time):
        return math.hypot(*pull_on_stuck_pin(pin, turned_with_disc(pin, state, time)))

    growth = (strength(1e-4) - strength(-1e-4)) / 2e-4 / pin.mass
    later = turned_with_disc(pin, state, delay)
    pull = pull_on_stuck_pin(pin, later)
    later[2:] += 0.5 * growth * delay**2 * pull / math.hypot(*pull)
    return later


def as_trajectory(pin, times, states, regularisation=0.0):
    states = np.array(states)
    phase = Phase("slip", float(times[0]), float(times[-1]), states[0].copy())
    solution = Solution("plain", TIGHTEST, 0, 0, 0.0, regularisation)
    return Trajectory(pin, np.array(times), states, (phase,), solution)


def integrate(pin, state, times, friction, regularisation=0.0, method="DOP853", tolerance=1e-12):
    """Trajectory under any friction law, judged as one of ``pin``."""
    run = slide(pin, state, times, of_vector(friction), method=method, rtol=tolerance, atol=tolerance * 1e-2)
    return as_trajectory(pin, times, run.y.T, regularisation)


def in_units(pin, mass, length, time):
    """``pin`` in units that are smaller by these factors: the same motion in other numbers."""
    return PinOnDisc(
        mass=pin.mass * mass,
        stiffness=pin.stiffness * mass / time**2,
        damping=pin.damping * mass / time,
        friction_force=pin.friction_force * mass * length / time**2,
        disc_speed=pin.disc_speed / time,
        offset=pin.offset * length,
        hardening=pin.hardening * mass / time**2 / length**2,
        stop_gap=pin.stop_gap * length,
        stop_stiffness=pin.stop_stiffness * mass / time**2,
    )


def growth(pin, elapsed):
    """Factor by which two motions of ``pin`` can part at most, over a time in s, sticking and grazing included.

    With w the slip, ż = w + iωz and ẇ = c₀z − (β/m + iω)w + const − (μN/m)·w/|w|, c₀ = ω² − k² − iωβ/m. The last
    term never drives two motions apart: (w₁ − w₂)·(w₁/|w₁| − w₂/|w₂|) >= 0. So in the norm √(|rz|² + |w|²) they
    part at most like exp(λt), λ the larger eigenvalue of the Hermitian part of the rest. r = √|c₀| makes it small.
    The factor is for positions in units of any length and velocities in that times max(k, |ω|).
    """
    k, omega, rate = pin.natural_frequency, pin.disc_speed, pin.damping / pin.mass
    unit = max(k, abs(omega)) or rate or 1.0
    c0 = complex(omega**2 - k**2, -omega * rate)
    r = max(math.sqrt(abs(c0)), 0.5 * unit)
    exponent = -rate / 2.0 + math.hypot(rate / 2.0, abs(r + c0 / r) / 2.0)
    # From one norm to the other and back, and from w to the velocity w + iωz.
    return 2.0 * math.sqrt(2.0) * max(r / unit, unit / r) * math.exp(exponent * elapsed)


def error_bound(pin, elapsed, tolerance):
    """Largest error of a simulation in units of the motion's size, by the tolerance that was asked for.

    A step may be wrong by 0.06 of the tolerance, and there are up to some 16 in a unit of time.
    """
    unit = max(pin.natural_frequency, abs(pin.disc_speed)) or pin.damping / pin.mass or 1.0
    return tolerance * (1.0 + unit * elapsed) * growth(pin, elapsed)
