"""Pushes simulated forward: the hand follows its measured path, and the body slides on its feet.

The hand is a point that pushes an edge of the triangle with friction. Two independent codes simulate it:
``reference_model.Pushing`` with exact friction and no inertia, and an Exudyn model with inertia, a stiff edge and
regularised friction.
"""

import cmath
import math
from typing import Any

import numpy as np

from compare.studies.plane.pushes.reduction import Push
from compare.studies.plane.pushes.theory import CENTRE, LEGS, MASS, MM, SLIDING_FORCES, contact_of, surface
from reference_model.contact.pushing import Pushing

HAND = 0.5
"""Friction coefficient of the hand on the edge, which the authors do not state.

Three quarters of the measured forces lean less than 26 degrees from the edge's normal; this coefficient allows
26.6. The median error of the final position is 0.9 to 1.3 mm for coefficients from 0.2 to 0.6, and 2 mm for 0.1
and 0.8.
"""

SPEED = 2.45e-3
"""Speed of the hand in m/s: 16.3 mm in 6.65 s."""

EDGES = ((0.0j, 1j), (0.0j, 1.0 + 0.0j), (LEGS + 0.0j, -(1.0 + 1.0j) / math.sqrt(2.0)))
"""A point on each edge in mm, and the normal into the triangle."""


def path_of(push: Push) -> tuple[complex, complex, complex, complex]:
    """Return start and end of the hand, a point (m) on the edge that faces it, and the normal into the body.

    Positions are relative to the centre of mass, in the body's first pose.
    """
    start = complex(push.start_x, push.start_y)
    half = cmath.exp(0.5j * push.turn)
    end = half * complex(push.x, push.y) + half**2 * complex(push.end_x, push.end_y)
    edge, normal = min(EDGES, key=lambda edge: ((start - edge[0]) * edge[1].conjugate()).real)
    return (start - CENTRE) * MM, (end - CENTRE) * MM, (edge - CENTRE) * MM, normal


def quasi_static(push: Push, steps: int = 5, hand: float = HAND) -> tuple[complex, float]:
    """Return displacement (m) and turn (rad) about the centre of mass for a hand with the coefficient ``hand``."""
    start, end, edge, normal = path_of(push)
    return Pushing(contact_of(push.series), edge, normal, hand).pose(start, end, steps)


def measured_motion(push: Push) -> tuple[complex, float]:
    """Return the measured displacement of the centre of mass (m), in the axes of the first pose, and the turn."""
    half = cmath.exp(0.5j * push.turn)
    return (half * complex(push.x, push.y) + (half**2 - 1.0) * CENTRE) * MM, push.turn


STIFFNESS = 1e6
"""Stiffness in N/m; 4 N press the hand in by 4 µm."""

STEPS = 300


def by_exudyn(push: Push, epsilon: float) -> tuple[complex, float]:
    """Return displacement (m) and turn (rad) about the centre of mass of an Exudyn model.

    ``epsilon`` regularises all friction (m/s).
    """
    import exudyn as exu
    import exudyn.itemInterface

    from exudyn_models import add_ring_friction, solve_dynamic
    from exudyn_models.solver.solver_run import quiet

    items: Any = exudyn.itemInterface  # its type hints do not fit its calls
    start, end, edge, inwards = path_of(push)
    way = end - start
    duration = abs(way) / SPEED
    mbs = exu.SystemContainer().AddSystem()
    node = mbs.AddNode(items.NodeRigidBody2D())
    mbs.AddObject(items.ObjectRigidBody2D(nodeNumber=node, mass=MASS, inertia=MASS * (LEGS * MM) ** 2 / 9.0))
    add_ring_friction(
        mbs,
        None,
        node,
        contact_points=list(contact_of(push.series)),
        friction_coefficient=1.0,
        normal_load=SLIDING_FORCES[surface(push.series)],
        regularisation=epsilon,
    )

    def pressed(mbs: Any, t: float, item: int, q: Any, q_t: Any) -> list[float]:
        turn, arm = cmath.exp(1j * q[2]), start + min(1.0, t / duration) * way - complex(q[0], q[1])
        normal = turn * inwards
        depth = ((arm - turn * edge) * normal.conjugate()).real
        if depth <= 0.0:
            return [0.0, 0.0, 0.0]
        velocity = way / duration - complex(q_t[0], q_t[1]) - 1j * q_t[2] * arm
        along = (velocity * (1j * normal).conjugate()).real
        force = STIFFNESS * depth * normal * (1.0 + 1j * HAND * max(-1.0, min(1.0, along / epsilon)))
        return [force.real, force.imag, (arm.conjugate() * force).imag]

    mbs.AddObject(
        items.ObjectGenericODE2(nodeNumbers=[node], massMatrix=np.zeros((3, 3)), forceUserFunction=pressed)
    )
    mbs.Assemble()
    settings = exu.SimulationSettings()
    settings.solution.file.write = False
    options = settings.timeIntegration
    options.endTime, options.numberOfSteps, options.verboseMode = duration, STEPS, 0
    options.generalizedAlpha.spectralRadius = 0.5
    with quiet():
        solve_dynamic(mbs, settings, exu.DynamicSolverType.GeneralizedAlpha, updateInitialValues=True)
    x, y, angle = mbs.systemData.GetODE2Coordinates()
    return complex(x, y), float(angle)
