"""Short motions that reveal the friction force: a sliding block, a loaded block and a rotating slip.

The change of momentum gives the friction force without a friction law or an exact solution. A block that slides
straight on a plane at rest is decelerated by a constant force. Steps then have no error, so any step distinguishes
cone, box and pyramid.
"""

from __future__ import annotations

import cmath
from dataclasses import replace

import numpy as np
from scipy.integrate import simpson

from compare.engines import Engine
from reference_model.systems import FloatArray, PinOnDisc

HEADINGS = np.radians(np.arange(4.0, 364.0, 15.0))
"""Directions of slip in rad; no direction is equally close to two axes of a polygon with up to 16 sides."""

FRICTION = 0.2
"""μN in N for a mass of 1 kg."""

WEAK = 1e-5
"""Stiffness in N/m: its force is small compared with friction, and the momentum balance accounts for it.

It is not smaller because engines may derive a characteristic speed from μN and the natural frequency.
"""

SLIDE = PinOnDisc(mass=1.0, stiffness=WEAK, damping=0.0, friction_force=FRICTION, disc_speed=0.0, offset=0.0)

SPEED = 1.0
"""Speed of sliding blocks, in m/s."""

SETTLES_FOR = 0.05
"""Time in s before friction is measured: MuJoCo's soft contact takes 0.04 s to reach its steady force."""

SLIDES_FOR = 0.1
"""Duration in s: friction removes 1/50 of the speed, less than the smallest component across an axis."""

PULLS = (0.25, 0.5, 0.75, 0.9)
"""Loads on blocks that should stick, as fractions of μN."""

PULLED_FOR = 4.0
"""Duration in s; the creep speed is measured in the second half."""

TURN = PinOnDisc(mass=1.0, stiffness=WEAK, damping=0.0, friction_force=0.02, disc_speed=1.0, offset=0.0)

TURNS_FOR = 1.0
"""Duration in s. The slip of a pin that leaves the axis radially rotates as the speed of the disc under it grows."""

PANELS = 32
"""Number of intervals for the integral of friction."""


def forces(engine: Engine, tolerance: float) -> FloatArray:
    """Return F_x and F_y over μN and the slip direction of blocks that slide along ``HEADINGS``, shape (n, 4).

    Both are means over ``SLIDES_FOR``. The slip direction is a unit vector, which a transverse force rotates.
    """
    velocities = [cmath.rect(SPEED, heading) for heading in HEADINGS.tolist()]
    times = (0.0, SETTLES_FOR, SETTLES_FOR + SLIDES_FOR)
    runs = engine.simulate_many(
        [(SLIDE, (0.0, 0.0, v.real, v.imag), times) for v in velocities], tolerance=tolerance
    )
    found = []
    for run in runs:
        (place, before), (end, after) = run.states[1:, ::2] + 1j * run.states[1:, 1::2]
        force = ((after - before) * SLIDE.mass / SLIDES_FOR + WEAK * (place + end) / 2.0) / FRICTION
        slip = (before + after) / abs(before + after)
        found.append([force.real, force.imag, slip.real, slip.imag])
    return np.array(found)


def creep(engine: Engine, tolerance: float) -> FloatArray:
    """Return the creep speed in m/s of a block under each of ``PULLS``, shape (n,)."""
    # an offset so large that a displacement of 1 m hardly changes the load
    blocks = [replace(SLIDE, offset=share * FRICTION / WEAK) for share in PULLS]
    times = np.array([0.0, 0.5, 1.0]) * PULLED_FOR
    runs = engine.simulate_many([(block, np.zeros(4), times) for block in blocks], tolerance=tolerance)
    return np.array([(run.states[2, 0] - run.states[1, 0]) / (times[2] - times[1]) for run in runs])


def lag(engine: Engine, tolerance: float) -> float:
    """Return the delay in s of the friction direction behind the slip; 0 for Coulomb friction.

    It is the missing momentum over the change of momentum due to a shift in time, along the direction of the latter.
    """
    times = np.linspace(0.0, TURNS_FOR, PANELS + 1)
    states = engine.simulate(TURN, (0.0, 0.0, SPEED, 0.0), times, tolerance=tolerance).states
    z, v = states[:, :2] @ (1.0, 1j), states[:, 2:] @ (1.0, 1j)
    slip = v - 1j * TURN.disc_speed * z
    direction = slip / np.abs(slip)
    turning = (np.gradient(np.unwrap(np.angle(slip)), times, edge_order=2)) * 1j * direction
    expected, shifted = (TURN.friction_force * simpson(each, x=times) for each in (direction, turning))
    # m·Δv = −∫C·z − ∫μN·(direction − lag·turning)
    missing = TURN.mass * (v[-1] - v[0]) + WEAK * simpson(z, x=times) + expected
    return float((missing * np.conj(shifted)).real / abs(shifted) ** 2)
