"""An engine with Moreau's time stepping, whose friction law can be wrong in one way."""

import cmath
import functools
import math

import numpy as np

from compare.engines import Engine
from reference_model import Trajectory


def stepped(system, start, times, *, step, law=None, smooth=0.0, lagging=False):
    """Simulate a pin; ``law`` maps the impulse that would end the slip, over the largest one, to that of friction."""
    place, velocity = complex(*start[:2]), complex(*start[2:])
    states, before = [start], None
    for interval in np.diff(times).tolist():
        number = max(1, math.ceil(interval / step - 1e-9))
        h = interval / number
        largest = h * system.friction_force / system.mass
        for _ in range(number):
            place += 0.5 * h * velocity
            pull = -system.stiffness * (place - system.offset) - system.damping * velocity
            velocity += h * pull / system.mass
            slip = velocity - 1j * system.disc_speed * place
            against = slip if before is None or not lagging else cmath.rect(abs(slip), before)
            before = cmath.phase(slip)
            velocity -= largest * (law or cone)(against / max(largest, smooth, 1e-300))
            place += 0.5 * h * velocity
        states.append([place.real, place.imag, velocity.real, velocity.imag])
    return Trajectory(system, np.asarray(times, dtype=float), np.array(states, dtype=float))


def cone(impulse, factor=1.0, turn=0.0):
    """Return the impulse of Coulomb's law, limited to 1."""
    return factor * impulse * cmath.rect(1.0, turn) / max(abs(impulse), 1.0)


def box(impulse):
    """Return the impulse limited on each axis independently."""
    return complex(*(min(max(part, -1.0), 1.0) for part in (impulse.real, impulse.imag)))


def pyramid(impulse, sides, tilt=0.0):
    """Return the nearest corner, limited to the impulse."""
    corner = 2.0 * math.pi / sides
    nearest = tilt + corner * round((cmath.phase(impulse) - tilt) / corner)
    return cmath.rect(min(abs(impulse), 1.0), nearest)


def engine(name, **how):
    """Return an engine of blocks and pins with a step of 4 ms."""
    simulate = functools.partial(stepped, **how)
    return Engine(name, simulate, nonlinear=False, phases=False, step=4e-3)
