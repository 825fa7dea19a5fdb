"""Motions so short and simple that they tell a force: a block that slides, one that is pulled, and a turning slip.

The force of friction is read off the change of momentum, which needs no law of friction and no exact solution. What
slides straight on a plane at rest is retarded by a constant force: there no step has an error, so that cone, box and
pyramid part at any step.
"""

from __future__ import annotations

import cmath
from dataclasses import replace

import numpy as np
from scipy.integrate import simpson

from compare.engines import Engine
from reference_model.systems import FloatArray, PinOnDisc

HEADINGS = np.radians(np.arange(4.0, 364.0, 15.0))
"""In rad. No two axes of a polygon with up to 16 sides are as near to one of them as each other."""

FRICTION = 0.2
"""μN in N, of a mass of 1 kg."""

WEAK = 1e-5
"""Stiffness in N/m: its force is next to none beside friction, and is left out of what is read off the momentum.

It is not less, since engines may take μN over the natural frequency for a speed that matters.
"""

SLIDE = PinOnDisc(mass=1.0, stiffness=WEAK, damping=0.0, friction_force=FRICTION, disc_speed=0.0, offset=0.0)

SPEED = 1.0
"""Of what slides, in m/s."""

SETTLES_FOR = 0.05
"""Time in s before friction is measured: MuJoCo's soft contact takes 0.04 s to reach its steady force."""

SLIDES_FOR = 0.1
"""In s: friction takes a fiftieth of the speed, and less than the nearest heading has across an axis."""

PULLS = (0.25, 0.5, 0.75, 0.9)
"""Of what does not slide, as fractions of μN."""

PULLED_FOR = 4.0
"""In s; the speed in the second half counts."""

TURN = PinOnDisc(mass=1.0, stiffness=WEAK, damping=0.0, friction_force=0.02, disc_speed=1.0, offset=0.0)

TURNS_FOR = 1.0
"""In s. A pin that leaves the axis along a spoke has a slip that turns as the disc carries more of it along."""

PANELS = 32
"""Of a motion along which friction is integrated."""


def forces(engine: Engine, tolerance: float) -> FloatArray:
    """Return what acts on blocks that slide along ``HEADINGS``, shape (n, 4): F_x and F_y over μN, and the slip.

    Both are means over ``SLIDES_FOR``. The slip is given as a unit vector, which a force across it turns.
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
    """Return the speed in m/s at which a block creeps that ``PULLS`` do not set in motion, shape (n,)."""
    # so far that a metre changes next to nothing
    blocks = [replace(SLIDE, offset=share * FRICTION / WEAK) for share in PULLS]
    times = np.array([0.0, 0.5, 1.0]) * PULLED_FOR
    runs = engine.simulate_many([(block, np.zeros(4), times) for block in blocks], tolerance=tolerance)
    return np.array([(run.states[2, 0] - run.states[1, 0]) / (times[2] - times[1]) for run in runs])


def lag(engine: Engine, tolerance: float) -> float:
    """Return by how many s friction acts along the slip of an earlier time; 0 is Coulomb's.

    From the change of momentum across the slip, which turns, over what a shift in time would change of it.
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
