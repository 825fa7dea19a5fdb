"""Pushes simulated forward: the hand follows its measured path, and the body slides on its feet.

The hand is a point that pushes an edge of the triangle with friction. Two independent codes simulate it. The
quasi-static code has exact friction and no inertia: the body takes the motion of least friction power that the hand
allows (Moreau's principle). The Exudyn model has inertia, a stiff edge and regularised friction.
"""

from __future__ import annotations

import cmath
import math
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from scipy.optimize import minimize, minimize_scalar

from compare.studies.plane.pushes.reduction import Push
from compare.studies.plane.pushes.theory import CENTRE, LEGS, MASS, MM, SLIDING_FORCES, contact_of, surface
from reference_model.systems import FloatArray

HAND = 0.5
"""Friction coefficient of the hand on the edge, which the authors do not state.

Three quarters of the measured forces lean less than 26 degrees from the edge's normal; this coefficient allows
26.6. The median error of the final position is 0.9 to 1.3 mm for coefficients from 0.2 to 0.6, and 2 mm for 0.1
and 0.8.
"""

SPEED = 2.45e-3
"""Speed of the hand in m/s: 16.3 mm in 6.65 s."""

EDGES = {  # points on the edges in mm, and directions into the triangle
    "lower leg": (0.0, 1j),
    "left leg": (0.0, 1.0),
    "hypotenuse": (LEGS, -(1.0 + 1.0j) / math.sqrt(2.0)),
}


@dataclass(frozen=True)
class Path:
    """Path of the hand (m) relative to the centre of mass, in the body's first pose.

    ``normal`` points into the body; ``depth`` is the distance from the edge to the centre of mass.
    """

    start: complex
    end: complex
    normal: complex
    depth: float

    @classmethod
    def of(cls, push: Push) -> Path:
        """Return the path of a push against the edge that faces the hand."""
        start = complex(push.start_x, push.start_y)
        half = cmath.exp(0.5j * push.turn)
        end = half * complex(push.x, push.y) + half**2 * complex(push.end_x, push.end_y)
        point, normal = min(EDGES.values(), key=lambda edge: ((start - edge[0]) * edge[1].conjugate()).real)
        depth = ((CENTRE - point) * complex(normal).conjugate()).real
        return cls((start - CENTRE) * MM, (end - CENTRE) * MM, complex(normal), depth * MM)

    @property
    def way(self) -> complex:
        """Displacement of the hand (m)."""
        return self.end - self.start

    def gap(self, hand: complex, position: complex, angle: float) -> float:
        """Return the distance (m) from the hand to the edge of the moved body."""
        outside = (hand - position) * (cmath.exp(1j * angle) * self.normal).conjugate()
        return -outside.real - self.depth


@dataclass(frozen=True, eq=False)
class QuasiStatic:
    """Motion of least friction power under a hand with the friction coefficient ``hand``."""

    push: Push
    hand: float = HAND

    @cached_property
    def path(self) -> Path:
        """Path of the hand."""
        return Path.of(self.push)

    @cached_property
    def _arms(self) -> Any:
        return np.array(contact_of(self.push.series).arms(0.0))

    @cached_property
    def _shares(self) -> FloatArray:
        return np.array(contact_of(self.push.series).shares)

    def motion(self, steps: int = 5) -> tuple[complex, float]:
        """Return the displacement of the centre of mass (m) and the turn (rad) after ``steps`` midpoint steps."""
        path = self.path
        forward = -(path.way * path.normal.conjugate()).real
        if forward >= 0.0:  # the hand moves away
            return 0.0j, 0.0
        touched = min(1.0, path.gap(path.start, 0.0j, 0.0) / -forward)
        position, angle = 0.0j, 0.0
        for i in range(steps):
            step = (1.0 - touched) / steps
            progress = touched + i * step
            slip, spin = self._rates(progress, position, angle)
            middle = position + 0.5 * step * slip, angle + 0.5 * step * spin
            slip, spin = self._rates(progress + 0.5 * step, *middle)
            position, angle = position + step * slip, angle + step * spin
        return position, angle

    def _rates(self, progress: float, position: complex, angle: float) -> tuple[complex, float]:
        back = cmath.exp(-1j * angle)
        arm = (self.path.start + progress * self.path.way - position) * back  # in the frame of the body
        velocity, normal = self.path.way * back, self.path.normal
        if (velocity * normal.conjugate()).real <= 0.0:
            return 0.0j, 0.0
        slip, spin, force = self._sticking(arm, velocity)
        across = math.atan(self.hand)
        lean = cmath.phase(force / normal)
        if abs(lean) > across:
            slip, spin = self._sliding(arm, velocity, normal * cmath.exp(1j * math.copysign(across, lean)))
        return slip / back, spin

    def _sticking(self, arm: complex, velocity: complex) -> tuple[complex, float, complex]:
        """Return slip, spin and the force of a hand that sticks."""
        size = abs(velocity) / (LEGS * MM)

        def power(spin: float) -> float:
            return float(self._shares @ abs(velocity + 1j * spin * (self._arms - arm)))

        spin = float(minimize_scalar(power, bracket=(-size, size), tol=1e-10).x)
        slips = velocity + 1j * spin * (self._arms - arm)
        force = complex(self._shares @ (slips / np.maximum(abs(slips), 1e-300)))
        return velocity - 1j * spin * arm, spin, force

    def _sliding(self, arm: complex, velocity: complex, force: complex) -> tuple[complex, float]:
        """Return slip and spin for a hand that slides and pushes in the direction of ``force``."""
        lever = LEGS * MM

        def power(free: FloatArray) -> tuple[float, FloatArray]:
            slips = force * (1.0 + 1j * free[0]) + 1j * free[1] / lever * (self._arms - arm)
            sizes = np.maximum(abs(slips), 1e-300)
            unit = self._shares * slips.conjugate() / sizes
            gradient = [
                (unit @ np.full(len(sizes), 1j * force)).real,
                (unit @ (1j * (self._arms - arm))).real / lever,
            ]
            return float(self._shares @ sizes), np.array(gradient)

        across, turn = minimize(power, np.zeros(2), jac=True, method="BFGS", options={"gtol": 1e-9}).x
        touching = force * (1.0 + 1j * across)
        normal = self.path.normal.conjugate()
        scale = (velocity * normal).real / (touching * normal).real
        spin = scale * turn / lever
        return scale * touching - 1j * spin * arm, spin


def measured_motion(push: Push) -> tuple[complex, float]:
    """Return the measured displacement of the centre of mass (m), in the axes of the first pose, and the turn."""
    half = cmath.exp(0.5j * push.turn)
    return (half * complex(push.x, push.y) + (half**2 - 1.0) * CENTRE) * MM, push.turn


STIFFNESS = 1e6
"""Stiffness in N/m; 4 N press the hand in by 4 µm."""

STEPS = 300


def by_exudyn(push: Push, epsilon: float) -> tuple[complex, float]:
    """Return the displacement of the centre of mass (m) and the turn (rad) of an Exudyn model.

    ``epsilon`` regularises all friction (m/s).
    """
    import exudyn as exu
    import exudyn.itemInterface

    from exudyn_models import add_ring_friction, solve_dynamic
    from exudyn_models.solver.solver_run import quiet

    items: Any = exudyn.itemInterface  # its type hints do not fit its calls
    path, contact = Path.of(push), contact_of(push.series)
    duration = abs(path.way) / SPEED
    mbs = exu.SystemContainer().AddSystem()
    node = mbs.AddNode(items.NodeRigidBody2D())
    mbs.AddObject(items.ObjectRigidBody2D(nodeNumber=node, mass=MASS, inertia=MASS * (LEGS * MM) ** 2 / 9.0))
    add_ring_friction(
        mbs,
        None,
        node,
        contact_points=list(contact),
        friction_coefficient=1.0,
        normal_load=SLIDING_FORCES[surface(push.series)],
        regularisation=epsilon,
    )

    def pressed(mbs: Any, t: float, item: int, q: Any, q_t: Any) -> list[float]:
        at = path.start + min(1.0, t / duration) * path.way
        position, angle = complex(q[0], q[1]), q[2]
        depth = -path.gap(at, position, angle)
        if depth <= 0.0:
            return [0.0, 0.0, 0.0]
        normal, arm = cmath.exp(1j * angle) * path.normal, at - position
        velocity = path.way / duration - complex(q_t[0], q_t[1]) - 1j * q_t[2] * arm
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
