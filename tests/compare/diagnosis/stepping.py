"""An engine with Moreau's time stepping, whose friction law can be wrong in one way."""

import cmath
import functools
import math

import numpy as np

from compare.engines import Engine
from reference_model import Trajectory


def stepped(
    system,
    start,
    times,
    *,
    step,
    law=None,
    limit=None,
    smooth=0.0,
    lagging=False,
    static=0.0,
    late=0.0,
    fastest=math.inf,
    slowest=0.0,
    blind=False,
    spring=1.0,
    factor=None,
    push=None,
):
    """Simulate a pin.

    ``law`` maps the impulse that would end the slip to friction's, both relative to the largest one. ``limit`` is the
    factor of μN as a function of the system, the slip speed and the step. ``static`` is the factor at rest if larger,
    ``late`` the delay of a release in s, ``fastest`` the largest speed, ``slowest`` the speed below which
    a body stops, ``spring`` the factor of the springs, and ``blind`` removes slip along the radius. ``factor``
    is the factor of μN at a place and time, and ``push`` a further force as a function of system, place and velocity.
    """
    place, velocity = complex(*start[:2]), complex(*start[2:])
    states, before, held, now = [start], None, 0.0, float(times[0])
    for interval in np.diff(times).tolist():
        number = max(1, math.ceil(interval / step - 1e-9))
        h = interval / number
        for _ in range(number):
            place += 0.5 * h * velocity
            rests = abs(velocity - 1j * system.disc_speed * place) < 1e-14
            pull = -spring * system.stiffness * (place - system.offset) - system.damping * velocity
            pull += push(system, place, velocity) if push is not None else 0.0
            velocity += h * pull / system.mass
            slip = velocity - 1j * system.disc_speed * place
            largest = h * system.friction_force / system.mass
            if limit is not None:
                largest *= limit(system, abs(slip), h)
            if factor is not None:
                largest *= factor(place, now)
            against = slip if before is None or not lagging else cmath.rect(abs(slip), before)
            if blind:
                across = 1j * place / abs(place) if place else 0.0
                against = (against * np.conj(across)).real * across
            before = cmath.phase(slip)
            held = held + h if rests and abs(slip) > largest else 0.0
            if rests and (abs(slip) <= static * largest or (abs(slip) > largest and held <= late)):
                velocity -= slip
            else:
                velocity -= largest * (law or cone)(against / max(largest, smooth, 1e-300))
            if abs(velocity) > fastest:
                velocity *= fastest / abs(velocity)
            if abs(velocity) < slowest:
                velocity = 0j
            place += 0.5 * h * velocity
            now += h
        states.append([place.real, place.imag, velocity.real, velocity.imag])
    return Trajectory(system, np.asarray(times, dtype=float), np.array(states, dtype=float))


def cone(impulse, factor=1.0, turn=0.0):
    """Return the impulse of Coulomb's law, limited to 1."""
    return factor * impulse * cmath.rect(1.0, turn) / max(abs(impulse), 1.0)


def box(impulse, factor=1.0):
    """Return the impulse limited on each axis independently."""
    return complex(*(min(max(part, -factor), factor) for part in (impulse.real, impulse.imag)))


def weaker_along_y(impulse, share=0.98):
    """Return the impulse of an ellipse by maximum dissipation, limited to 1 along x."""
    size = math.hypot(impulse.real, share * impulse.imag)
    return complex(impulse.real, share**2 * impulse.imag) / max(size, 1.0)


def chattering(impulse):
    """Return an impulse of full size at any slip."""
    return impulse / abs(impulse) if impulse else 0j


def pyramid(impulse, sides, tilt=0.0):
    """Return the nearest corner, limited to the impulse."""
    corner = 2.0 * math.pi / sides
    nearest = tilt + corner * round((cmath.phase(impulse) - tilt) / corner)
    return cmath.rect(min(abs(impulse), 1.0), nearest)


def engine(name, step=4e-3, **how):
    """Return an engine of blocks and pins with a step of 4 ms."""
    simulate = functools.partial(stepped, **how)
    return Engine(name, simulate, nonlinear=False, phases=False, step=step)
