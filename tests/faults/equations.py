"""Equations of motion of the plain engine: eqs. 1 and 19 for velocities relative to the master disc."""

import math

import numpy as np

from faults.friction import contact
from faults.jit import compiled


@compiled
def slip_of(y, numbers, make):
    """Return the velocity of the centre and the spin that friction opposes."""
    half = len(y) // 2
    slip = complex(y[half], y[half + 1])
    spin = y[5] if half == 3 else 0.0
    if make.relative != 1.0:
        slip += (1.0 - make.relative) * 1j * numbers.omega * complex(y[0], y[1])
        spin += (1.0 - make.relative) * numbers.omega
    if make.about_anchor:
        slip += 1j * numbers.omega * numbers.offset
    return slip, spin


@compiled
def support(t, z, v, numbers, make):
    """Return the force of springs, stop and dampers."""
    anchor = complex(numbers.offset, 0.0)
    if make.anchor_turns:
        anchor *= complex(math.cos(numbers.omega * t), math.sin(numbers.omega * t))
    deflection = z - anchor
    d = abs(deflection)
    pull = numbers.stiffness
    if d > 0.0:
        pull += numbers.hardening * d**make.hardening_power
        if (make.stop_pulls or d > numbers.stop_gap) and not (
            make.stop_on_one_side and deflection.real < 0.0
        ):
            pull += numbers.stop_stiffness * (d - numbers.stop_gap) / d
    damped = v - 1j * numbers.omega * z if make.damping_on_slip else v
    unlike = make.stiffer_in_y * numbers.stiffness * deflection.imag
    return -pull * deflection - complex(0.0, unlike) - numbers.damping * damped


@compiled
def rates(t, y, width, strength, numbers, make):
    """Return the right-hand side of (1) or (19) for x, y, (φ,) and the velocities relative to the master disc."""
    half = len(y) // 2
    z, u = complex(y[0], y[1]), complex(y[half], y[half + 1])
    v = u + 1j * numbers.omega * z
    slip, turning = slip_of(y, numbers, make)
    angle = y[2] - make.points_lag * (y[5] + numbers.omega) if half == 3 else 0.0
    force, moment, _ = contact(slip, turning, angle, width, strength, numbers, make)
    if abs(z.imag) > z.real:
        force *= 1.0 + make.stronger_beside
    friction = make.friction * numbers.friction
    a = (friction * force + support(t, z, v, numbers, make)) / numbers.mass
    if make.energy_gain > 0.0:
        a += make.energy_gain / (2.0 * math.pi) * math.sqrt(numbers.stiffness / numbers.mass) * v
    square = z.real * z.real + z.imag * z.imag
    if make.coriolis != 1.0 and square > 0.0:
        v_polar = z.conjugate() * v  # ρ·(ρ̇ + iρψ̇)
        a += (1.0 - make.coriolis) * 2.0 * v_polar.real * v_polar.imag / square**2 * 1j * z
    a -= 1j * numbers.omega * v
    result = np.empty_like(y)
    result[0], result[1], result[half], result[half + 1] = v.real, v.imag, a.real, a.imag
    if half == 3:
        spin = y[5] + numbers.omega
        shaft = -numbers.shaft_damping * (spin - numbers.shaft_speed)
        result[2] = spin
        result[5] = (make.moment * friction * moment + shaft) / numbers.inertia
    return result


@compiled
def rotated(x, turn, base):
    """Return the unknowns from the displacement ``x`` since ``base``, given in axes that rotated by ``turn``."""
    half = len(x) // 2
    e = complex(math.cos(turn), math.sin(turn))
    z, u = (complex(base[0] + x[0], base[1] + x[1])) * e, complex(x[half], x[half + 1]) * e
    y = x.copy()
    y[0], y[1], y[half], y[half + 1] = z.real, z.imag, u.real, u.imag
    if half == 3:
        y[2] += base[2] + turn
    return y


@compiled
def turning_rates(t, x, start, base, width, strength, numbers, make):
    """Return the rates of ``x`` in ``rotated``, which are small during stick."""
    half, turn = len(x) // 2, numbers.omega * (t - start)
    result = rates(t, rotated(x, turn, base), width, strength, numbers, make)
    a = complex(result[half], result[half + 1]) * complex(math.cos(turn), -math.sin(turn))
    a -= 1j * numbers.omega * complex(x[half], x[half + 1])
    result[:half] = x[half:]
    result[half], result[half + 1] = a.real, a.imag
    return result


@compiled
def slip_speed(y, numbers, make):
    """Return the slip speed of the contact."""
    slip, turning = slip_of(y, numbers, make)
    return contact(slip, turning, y[2] if len(y) == 6 else 0.0, 1.0, 1.0, numbers, make)[2]


def carried(places, omega):
    """Return the velocities of a body that turns with the master disc; ``places`` has shape (..., 2) or (..., 3)."""
    velocities = np.full_like(places, omega)
    velocities[..., 0], velocities[..., 1] = -omega * places[..., 1], omega * places[..., 0]
    return velocities


@compiled
def fixed_steps(times, start, width, numbers, make):
    """Return the states at ``times`` by Euler's method or the classical Runge-Kutta method."""
    states = np.empty((len(times), len(start)))
    states[0] = start
    y = start.copy()
    for i in range(1, len(times)):
        span = times[i] - times[i - 1]
        n = math.ceil(span / make.step - 1e-9)
        h = span / n
        for j in range(n):
            t = times[i - 1] + j * h
            k1 = rates(t, y, width, 1.0, numbers, make)
            if make.order == 1:
                y = y + h * k1
                continue
            k2 = rates(t + 0.5 * h, y + 0.5 * h * k1, width, 1.0, numbers, make)
            k3 = rates(t + 0.5 * h, y + 0.5 * h * k2, width, 1.0, numbers, make)
            k4 = rates(t + h, y + h * k3, width, 1.0, numbers, make)
            y = y + h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4)
        states[i] = y
    return states
