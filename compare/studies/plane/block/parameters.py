"""A block of 1 kg with friction of 1 N, how it is thrown and pulled, and how sharply it is looked at."""

from __future__ import annotations

import cmath
import math
from dataclasses import replace

import numpy as np

from reference_model.systems import FloatArray, PinOnDisc

SOURCE = "assumption: a block of 1 kg with friction of 1 N"

BLOCK = PinOnDisc(mass=1.0, stiffness=0.0, damping=0.0, friction_force=1.0, disc_speed=0.0)
"""Free, on a plane at rest."""

FRICTION = BLOCK.friction_force
DECELERATION = FRICTION / BLOCK.mass
"""g in m/s² of a block that only friction acts on."""

HEADINGS = (0.0, 22.5, 45.0, 67.5)
"""In degrees from the x axis: sides, corners and neither of squares and octagons, however these lie."""

SPEED = 1.0
"""v₀ of a throw in m/s."""

WHILE_SLIDING = np.array([0.0, 0.5, 0.9])
"""When a thrown block is looked at, as fractions of the time in which it stops."""

AT_REST = 1.5
"""When it rests, as such a fraction: a law that is smoothed has come to rest by then too."""

SPRING = replace(BLOCK, stiffness=0.1)
"""On a spring that is stretched by 10 m where it pulls as friction does: its pull changes slowly on the way."""

LOADS = (0.1, 0.5, 0.9, 0.99)
"""Pulls that friction holds, over μN."""

BEYOND = 1.01
"""A pull that it does not hold, over μN."""

HELD = 10.0
"""How long a block is held, in s: as long as it slides beyond the cone."""

MOVED = (BEYOND - 1.0) * FRICTION / SPRING.stiffness
"""Way in m from which on it counts as moved: half of how far it slides beyond the cone."""

SWINGING = replace(BLOCK, stiffness=1e4)
RELEASED = 8.5
"""Where the block on this spring is let go, over μN/C: half swings to 6.5, 4.5, 2.5 and 0.5, and there it rests."""

SWINGS = 4
"""Half swings up to rest."""

DIAGONAL = 45.0
"""Heading of the swings in degrees: between the axes."""

PULL = 1.5
"""Of a spring from afar on a block that is thrown along it, over μN."""

AFAR = replace(BLOCK, stiffness=1e-2)
"""Its spring is stretched by 150 m at the start. Any farther, and places have fewer digits than the motion needs."""

PULLED = np.array([0.0, 1.0, 2.0])
"""In s."""

ACROSS = replace(BLOCK, stiffness=1e-6, offset=1e6)
"""The block at the origin is pulled with μN along x, by a spring whose pull is constant to some 1e-6 of itself."""

TURNING = np.array([0.0, 0.25, 0.5, 1.0, 2.0])
"""When a block that is thrown across the pull is looked at, in s: in the end it has all but turned."""


def direction(degrees: float) -> complex:
    """Return the unit vector of a heading, as x + iy."""
    return cmath.rect(1.0, math.radians(degrees))


def state_of(place: complex, velocity: complex = 0j) -> FloatArray:
    """Return the state of a block, shape (4,), from x + iy in m and vx + ivy in m/s."""
    return np.array([place.real, place.imag, velocity.real, velocity.imag])
