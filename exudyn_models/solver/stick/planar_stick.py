"""Exact stick of a pin, circle or annulus between bodies that may also slide sideways.

In stick, constraints hold the slip (u, S) of ``slip_kinematics`` at zero. Their multipliers, the force and moment of
friction, must stay within the limit surface. A sliding contact obeys Coulomb's law without regularisation, so
``stick.switching`` lets no step pass its rest.

Joints may leave only some directions of slip, with the basis B, shape (3, k). The joints carry an undetermined share
of the load, so the contact holds if any share lies within the limit surface of the potential P(B·v).
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import cached_property, partial
from typing import Any, cast

import numpy as np

from exudyn_models.forces.any_pair import parameters_of
from exudyn_models.forces.axial_pairs import AxialStick, Mode
from exudyn_models.forces.jit import FLOATS, TABLE, entry_point
from exudyn_models.forces.slip_kinematics import slip_and_place_of_nodes
from exudyn_models.forces.user_functions import constraint_and_gradients, force_and_jacobian
from exudyn_models.solver.stick.slip_motion import (
    SlipMotion,
    line_from,
    linear_force,
    linear_jacobian,
    potential_along_locks,
    resisted_slip,
    slip_motion,
    unit_friction,
)
from reference_model.systems import FloatArray

NEGLIGIBLE = 1e-9
"""Largest singular value of possible slips, or change of a direction, that counts as zero."""

MOST_SHARE, TINY = 1e30, float(np.finfo(float).tiny)
"""Load share of a contact whose friction vanishes, and least friction in N: shares stay finite."""


@dataclass(eq=False)
class PlanarStick(AxialStick):
    """Friction between two bodies that sticks exactly; joints may hold them on one axis.

    Its locks hold the slip along x and y and of the rim (m/s), or the spin (rad/s) on one axis.
    Joints, and locks of others while it slides, leave the slips (m/s, m/s, rad/s) in ``allowed``, shape (3, k), free.
    ``direction``, shape (3,), is the slip at its release with P = 1 m/s.
    """

    allowed: FloatArray = field(default_factory=lambda: np.empty((3, 0)))
    direction: FloatArray = field(default_factory=lambda: np.zeros(3))
    resisted: FloatArray = field(default_factory=lambda: np.zeros(3))
    """Latest slip that a load pulls at, where the next search for it starts."""
    radius: float = 0.0
    """Distance of the disc's centre from the master's axis in m, constant in stick."""
    frozen: bool = False
    """True in the last step before rest: friction keeps its value from the start of the step."""
    predicts: bool = False
    """True in the first iteration of Newton's method: friction is linear about the start of the step.

    Exudyn's first iterate has no acceleration at the end of the step, so its slip may have any direction.
    """

    def __post_init__(self) -> None:
        self._evaluated: tuple[list[float], FloatArray] = [], np.empty((0, 0))
        self._motion: tuple[tuple[bytes, ...], SlipMotion] | None = None
        self.renew()

    def renew(self) -> None:
        """Use the present load and coefficient from now on."""
        self._sliding = force_and_jacobian(self.kinds, self.reference, self.factors)
        self._parameters = parameters_of(self.factors.geometry, self.kinds, self.reference)

    @cached_property
    def _linear_functions(self) -> tuple[Callable[..., Any], Callable[..., Any]]:
        known = TABLE, TABLE, float, float, None, None, None, FLOATS, FLOATS
        return entry_point(linear_force, *known), entry_point(linear_jacobian, *known, float, float)

    @property
    def most_locks(self) -> int:
        """Largest number of constraints that hold the contact."""
        return 3 if self.mean_radius > 0.0 else 2

    @property
    def lock_count(self) -> int:
        """Number of constraints: one for each direction, then one for all directions of a contact in the plane."""
        return self.most_locks + (self.most_locks > 1)

    @cached_property
    def _together(self) -> tuple[Callable[..., Any], Callable[..., Any]]:
        return constraint_and_gradients(self.kinds, self.factors, self.mean_radius)

    def lock_options(self, lock: int) -> dict[str, Any]:
        """Return the number of equations of a constraint, as Exudyn's scaling, and its user functions."""
        count, functions = lock, self._together
        if lock < self.most_locks:
            count, functions = 1, (partial(self.constraint, lock), partial(self.constraint_jacobian, lock))
        names = "constraintUserFunction", "jacobianUserFunction"
        return {"scalingMarker0": np.zeros((count, 1)), **dict(zip(names, functions, strict=True))}

    @cached_property
    def scales(self) -> FloatArray:
        """Lengths in m, or 1, that turn a slip into one along the directions of its locks, shape (k,)."""
        return np.array([1.0, 1.0, self.mean_radius])[: self.most_locks]

    def rows(self, coordinates: FloatArray) -> FloatArray:
        """Return the gradients of the locked slips, shape (k, n)."""
        values = coordinates.tolist()
        found: FloatArray = self._together[1](None, 0.0, 0, values, values, True)
        return found[2:] / self.mean_radius if self.on_axis else found

    def to_locked(self, coordinates: FloatArray) -> FloatArray:
        """Return the map from the slip to the slips that locks hold, shape (k, 3)."""
        return np.eye(3)[2:] if self.on_axis else np.diag([1.0, 1.0, self.mean_radius])[: self.most_locks]

    def gradient(self, q: Any) -> list[float]:
        """Return the gradient of the slip on one axis."""
        row: list[float] = self.rows(self.reference + q)[0].tolist()
        return row

    @property
    def constant_forces(self) -> None:
        """None, because the forces turn with the bodies."""
        return

    def slip_map(self, coordinates: FloatArray) -> FloatArray:
        """Return J, the map from the nodes' velocities to the slip, shape (3, n)."""
        return np.asarray(slip_and_place_of_nodes(self.kinds, coordinates)[0])

    def motion(self, q: FloatArray, q_t: FloatArray, q_tt: FloatArray) -> SlipMotion:
        """Return the motion for coordinates without reference values."""
        state = q.tobytes(), q_t.tobytes(), q_tt.tobytes()
        if self._motion is None or state != self._motion[0]:  # each step starts where the last one has ended
            found = slip_motion(
                self.kinds, self.factors.geometry, self.mean_radius or 1.0, self.reference + q, q_t, q_tt
            )
            self._motion = state, SlipMotion(*found)
        return self._motion[1]

    def bias(self, state: tuple[FloatArray, FloatArray, FloatArray]) -> FloatArray:
        """Return the rates of the locked slips without accelerations, shape (k,)."""
        return np.asarray(self.to_locked(self.reference + state[0]) @ self.motion(*state).bias)

    def potential_along_locks(self, slip: FloatArray) -> tuple[float, FloatArray, FloatArray]:
        """Return P (m/s) of a slip along the directions of the locks, shape (k,), its gradient and curvature."""
        found = potential_along_locks(slip, self.mean_radius or 1.0, self.factors.geometry)
        return cast(tuple[float, FloatArray, FloatArray], found)

    def potential_of(self, slip: FloatArray) -> float:
        """Return P in m/s."""
        return float(-np.array(unit_friction(slip, self.factors.geometry)) @ slip)

    def held_wrench(self) -> FloatArray:
        """Return force (N) and moment (N m) on the disc at rest, in the master's axes, shape (3,)."""
        wrench = np.zeros(3)
        wrench[: self.most_locks] = self.scales * self.held_forces()
        return wrench

    def load_share(self, wrench: FloatArray, friction: float) -> tuple[float, FloatArray]:
        """Return the share of ``friction`` (N) that a ``wrench`` needs, and the resisted slip with P = 1 m/s."""
        needed, self.resisted = resisted_slip(-wrench, self.allowed, self.resisted, self.factors.geometry)
        return needed / max(friction, needed / MOST_SHARE, TINY), self.resisted

    def holding_force(self, t: float) -> float:
        """Return the static friction in N."""
        return self.static_ratio * self.factors.friction_force(t, self.radius, 0.0, 0.0)

    def capacity_share(self, mbs: Any, t: float, angle: float = 0.0) -> float:
        """Return load divided by capacity: 1 while the contact slides, 0 while it is open."""
        if self.on_axis or self.mode != Mode.LOCKED:
            return super().capacity_share(mbs, t)
        return self.load_share(self.held_wrench(), self.holding_force(t))[0]

    def wrench(self, mbs: Any, t: float, slip: FloatArray, radius: float, angle: float) -> FloatArray:
        """Return force (N) and moment (N m) on the disc, in the master's axes, shape (3,)."""
        if self.on_axis:
            return super().wrench(mbs, t, slip, radius, angle)
        if self.mode == Mode.LOCKED:
            return self.held_wrench()
        return self.sliding_wrench(t, slip, radius) if self.slides else np.zeros(3)

    def force(self, mbs: Any, t: float, item: int, q: Sequence[float], q_t: Sequence[float]) -> Any:
        """Return the generalised forces on the nodes (user function of the connector)."""
        if self.on_axis or not self.running:
            return super().force(mbs, t, item, q, q_t)
        if not self.slides:
            return [0.0] * len(q)
        if not self.predicts and not self.frozen:
            return self._sliding[0](mbs, t, item, q, q_t)
        return self._linear(self._linear_functions[0], t, mbs, t, item, q, q_t)

    def start_step(self, state: tuple[FloatArray, FloatArray, FloatArray]) -> None:
        """Prepare the first iteration of a step that slides."""
        start, self.predicts = self.motion(*state), True
        # A prescribed motion begins without slip.
        self._start = start if start.potential > 0.0 else start._replace(slip=NEGLIGIBLE * self.direction)
        self._line = line_from(self._start.slip, self.factors.geometry)

    def _linear(self, function: Callable[..., Any], t: float, *arguments: Any) -> Any:
        start, slope = self._start, 0.0 if self.frozen else 1.0
        friction = self.factors.friction_force(t, start.radius, start.potential, float(start.slip[2]))
        return function(self._parameters, self._line, friction, slope, *arguments)

    def sliding_wrench(self, t: float, slip: FloatArray, radius: float) -> FloatArray:
        """Return force (N) and moment (N m) on the sliding disc, in the master's axes, shape (3,)."""
        unit = np.array(unit_friction(slip, self.factors.geometry))
        return unit * self.factors.friction_force(t, radius, float(-unit @ slip), float(slip[2]))

    def jacobian(
        self,
        mbs: Any,
        t: float,
        item: int,
        q: Sequence[float],
        q_t: Sequence[float],
        position_factor: float,
        velocity_factor: float,
    ) -> FloatArray:
        """Return the derivatives of minus the forces (user function of the connector)."""
        if self.on_axis:
            return super().jacobian(mbs, t, item, q, q_t, position_factor, velocity_factor)
        if not self.slides:
            return np.zeros((len(q), len(q)))
        if self.predicts or self.frozen:
            self.predicts = False
            arguments = mbs, t, item, q, q_t, position_factor, velocity_factor
            return np.asarray(self._linear(self._linear_functions[1], t, *arguments))
        found: FloatArray = self._sliding[1](mbs, t, item, q, q_t, position_factor, velocity_factor)
        return found

    def constraint(
        self, lock: int, mbs: Any, t: float, item: int, q: Sequence[float], q_t: Sequence[float], level: bool
    ) -> list[float]:
        """Return the slip that the constraint ``lock`` keeps at zero (its user function).

        Its coordinates ``q`` contain the reference values, unlike the coordinates of a connector.
        """
        return [float(self._row(lock, q) @ q_t)]

    def constraint_jacobian(
        self, lock: int, mbs: Any, t: float, item: int, q: Sequence[float], q_t: Sequence[float], level: bool
    ) -> FloatArray:
        """Return the derivatives of that slip, shape (1, n) (user function of the constraint)."""
        return self._row(lock, q)[None]

    def _row(self, lock: int, q: Sequence[float]) -> FloatArray:
        if q != self._evaluated[0]:  # Exudyn asks for one row after another
            self._evaluated = list(q), self.rows(np.array(q))
        return np.asarray(self._evaluated[1][lock])
