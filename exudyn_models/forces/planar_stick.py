"""Exact stick of a pin, circle or annulus between bodies that may also slide sideways.

While the contact is locked, constraints hold the slip (u, S) of ``slip_kinematics`` at zero. Their multipliers are
the force and moment of friction, which must stay within the limit surface. A sliding contact obeys Coulomb's law
without regularisation, so no step may pass its rest. ``solver.switching`` limits the steps for that reason.

Joints may leave the contact only some directions of slip. With such a basis B, shape (3, k), the slip is B·v, and the
k constraints are B⁺·J·q̇ = 0. The joints carry an undetermined share of the load, so the contact holds if any share
lies within the limit surface. This is the limit surface of the potential P(B·v).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any, NamedTuple

import exudyn as exu
import numpy as np

from exudyn_models.forces.axial_pairs import AxialStick, Mode
from exudyn_models.forces.friction_laws import Contact, derivatives_by_slip, friction_of_slip, mean_radius
from exudyn_models.forces.jit import KeptOnDisk, compiled
from exudyn_models.forces.slip_kinematics import (
    IMAGINARY_STEP,
    ROTATION_VECTOR,
    SIZES,
    TRANSLATIONS,
    Kinds,
    radius_of_disc,
    slip_jacobian,
)
from reference_model.systems import FloatArray

ITERATIONS = 100
"""Largest number of iterations for the direction of slip on the limit surface."""

ACCURACY = 1e-9
"""Angle in rad to which this direction is found; the error of the load share is of its square."""

NEGLIGIBLE = 1e-9
"""Largest singular value of possible slips, or change of a direction, that counts as zero."""


SPIN = np.array([[0.0], [0.0], [1.0]])
"""Basis of the slip on one axis."""


RESOLVED = 1e-6
"""Smallest ratio of slip to the speeds whose difference it is at which friction has a direction."""


class SlipMotion(NamedTuple):
    """Motion of a contact that sticks exactly.

    Parameters
    ----------
    slip, rate : array of shape (3,)
        (u, S) in m/s and rad/s, and its rate of change in m/s² and rad/s².
    bias : array of shape (3,)
        Rate of change without accelerations, J̇·q̇.
    gradient : array of shape (3,)
        Derivatives of P by the slip, zero at rest.
    radius : float
        Distance of the disc's centre from the axis of the master, in m.
    rate_potential : float
        P of the rate, in m/s².
    largest_term : float
        Largest speed in m/s whose differences are the slip, which determines its rounding error.

    """

    slip: FloatArray
    rate: FloatArray
    bias: FloatArray
    gradient: FloatArray
    radius: float
    rate_potential: float
    largest_term: float

    @property
    def potential(self) -> float:
        """Slip potential P in m/s."""
        return float(self.gradient @ self.slip)

    @property
    def remaining(self) -> float:
        """Time in s after which the contact would rest at the present rate of P, infinite if P grows."""
        falling = -float(self.gradient @ self.rate)
        return self.potential / falling if falling > 0.0 else math.inf

    def rests_within(self, time: float) -> bool:
        """Return whether the slip decreases and vanishes within a ``time`` (s), or is as small as its rounding error.

        The direction of friction must be accurate enough for Newton's method.
        """
        return self.remaining < time or (
            self.remaining < math.inf and self.potential < RESOLVED * self.largest_term
        )


@dataclass(eq=False)
class PlanarStick(AxialStick):
    """Friction between any two bodies, which sticks exactly; the joints of the model may hold them on one axis.

    Parameters
    ----------
    sliding : tuple of callable
        User functions for force and Jacobian of Coulomb friction.
    on_axis : bool
        Whether joints hold both bodies on one axis, so that it is an ``AxialStick``.
    basis : array of shape (3, k)
        Directions of slip (m/s, m/s, rad/s) that joints and other locked contacts allow.
    direction : array of shape (3,)
        Slip with P = 1 m/s at which the load has released the contact, normal to the limit surface.

    """

    sliding: tuple[Callable[..., Any], ...] = ()
    on_axis: bool = True
    basis: FloatArray = field(default_factory=lambda: SPIN)
    direction: FloatArray = field(default_factory=lambda: np.zeros(3))
    frozen: bool = False
    """Whether friction stays that at the start of the step, within which the slip vanishes."""
    predicts: bool = False
    """Whether friction is linear about the start of the step, until Newton's method has made its first iteration.

    Exudyn's first iterate has no acceleration at the end of the step, so it may slip in any direction.
    """

    def __post_init__(self) -> None:
        self.set_basis(self.basis)

    @property
    def mean_radius(self) -> float:
        """P over |S| of a disc that turns in place, in m."""
        return mean_radius(self.factors.geometry)

    def allow(self, slips: FloatArray) -> None:
        """Set the basis to the span of possible ``slips``, shape (3, n); a pin does not resist spin."""
        radius = self.mean_radius
        axes, sizes, _ = np.linalg.svd(slips * np.array([1.0, 1.0, radius])[:, None])
        count = np.count_nonzero(sizes > NEGLIGIBLE)
        self.set_basis(axes[:, :count] / np.array([1.0, 1.0, radius or 1.0])[:, None])

    def set_basis(self, basis: FloatArray) -> None:
        """Lock the slip in the directions of ``basis``, shape (3, k), from now on."""
        self.basis, self._to_basis = basis, np.linalg.pinv(basis)
        self._evaluated: tuple[list[float], FloatArray] = [], np.empty((3, 0))

    def rows(self, coordinates: FloatArray) -> FloatArray:
        """Return the gradients of the locked slips, shape (k, n), at ``coordinates`` with reference values."""
        return np.asarray(self._to_basis @ self.slip_map(coordinates))

    def slip_map(self, coordinates: FloatArray) -> FloatArray:
        """Return J, the map of the nodes' velocities to the slip, shape (3, n)."""
        return np.asarray(jacobian_of_slip(self.kinds, coordinates)[0])

    def motion(self, q: FloatArray, q_t: FloatArray, q_tt: FloatArray) -> SlipMotion:
        """Return the motion for coordinates without reference values, and their derivatives."""
        return SlipMotion(*slip_motion(self.kinds, self.factors.geometry, self.reference + q, q_t, q_tt))

    def bias(self, state: tuple[FloatArray, FloatArray, FloatArray]) -> FloatArray:
        """Return the rates of the locked slips in such a ``state`` without accelerations, shape (k,)."""
        return np.asarray(self._to_basis @ self.motion(*state).bias)

    def potential_of(self, slip: FloatArray) -> float:
        """Return P in m/s of a ``slip``, shape (3,)."""
        return float(potential(slip, self.factors.geometry))

    def held_wrench(self, mbs: Any) -> FloatArray:
        """Return force (N) and moment (N m) of the constraints on the disc, in the master's axes, shape (3,)."""
        count = self.basis.shape[1]
        forces = [mbs.GetObjectOutput(lock, exu.OutputVariableType.Force) for lock in self.locks[:count]]
        return np.asarray(-self._to_basis.T @ np.array(forces, dtype=float))

    def load_share(self, wrench: FloatArray, friction: float) -> tuple[float, FloatArray]:
        """Return the share of ``friction`` (N) that a ``wrench`` on the disc needs, and the slip that it resists.

        The slip has P = 1 m/s.
        """
        contact, radius, load, columns = self.factors.geometry, self.mean_radius, -wrench, self.basis
        if columns.shape[1] == (3 if radius else 2):  # the slip of the centre has the direction of the force
            force = math.hypot(load[0], load[1])
            along = [load[0] / force, load[1] / force, 0.0] if force else [1.0, 0.0, 0.0]
            columns = np.array([along, [0.0, 0.0, 1.0 / radius]] if radius else [along]).T
        if columns.shape[1] == 1:
            slip = columns[:, 0] * math.copysign(1.0, load @ columns[:, 0])
        else:
            slip = resisted_slip(load, np.ascontiguousarray(columns), contact)
        slip = slip / potential(slip, contact)
        return float(load @ slip) / friction, slip

    def holding_force(self, t: float) -> float:
        """Return the static friction in N at the time t (s)."""
        return self.static_ratio * self.factors.friction_force(t, 0.0, 0.0, 0.0)

    def capacity_share(self, mbs: Any, t: float) -> float:
        """Return the load over the largest one: 1 while the contact slides, 0 while it is open."""
        if self.on_axis or self.mode != Mode.LOCKED:
            return super().capacity_share(mbs, t)
        return self.load_share(self.held_wrench(mbs), self.holding_force(t))[0]

    def wrench(self, mbs: Any, t: float, slip: FloatArray, radius: float) -> FloatArray:
        """Return force (N) and moment (N m) on the disc in the current motion, in the master's axes, shape (3,)."""
        if self.on_axis:
            return super().wrench(mbs, t, slip, radius)
        if self.mode == Mode.LOCKED:
            return self.held_wrench(mbs)
        if not self.slides:
            return np.zeros(3)
        return self.sliding_wrench(t, self.direction if self.idle else slip, radius)

    def force(self, mbs: Any, t: float, item: int, q: Sequence[float], q_t: Sequence[float]) -> Any:
        """Return the generalised forces on the nodes, as the user function of the connector."""
        if self.on_axis or not self.running:
            return super().force(mbs, t, item, q, q_t)
        if self.idle:
            wrench = self.sliding_wrench(t, self.direction, 0.0)
            return (self.slip_map(self.reference + q).T @ wrench).tolist()
        if not self.slides:
            return [0.0] * len(q)
        if not self.predicts and not self.frozen:
            return self.sliding[0](mbs, t, item, q, q_t)
        return self._linear(t, q, q_t)[0].tolist()

    def start_step(self, q: FloatArray, q_t: FloatArray) -> None:
        """Prepare the first iteration of a step that starts at these coordinates and velocities."""
        self.predicts = self.slides and not self.idle
        if self.predicts:
            self._start = self.motion(q, q_t, np.zeros(len(q)))

    def _linear(self, t: float, q: Sequence[float], q_t: Sequence[float]) -> Any:
        """Return friction that is linear in the slip since the start of the step, and its derivatives."""
        start, contact = self._start, self.factors.geometry
        friction = self.factors.friction_force(t, start.radius, start.potential, float(start.slip[2]))
        coordinates = self.reference + q
        slope = 0.0 if self.frozen else 1.0
        return linear_friction(self.kinds, contact, coordinates, np.array(q_t), start.slip, friction, slope)

    def sliding_wrench(self, t: float, slip: FloatArray, radius: float) -> FloatArray:
        """Return the force and moment on the disc that slides at the time t (s), in the master's axes, shape (3,)."""
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
        """Return the derivatives of minus the generalised forces, as the user function of the connector."""
        if self.on_axis:
            return super().jacobian(mbs, t, item, q, q_t, position_factor, velocity_factor)
        if self.idle or not self.slides:
            return np.zeros((len(q), len(q)))
        if self.predicts or self.frozen:
            self.predicts = False
            _, by_position, by_velocity = self._linear(t, q, q_t)
            return np.asarray(-position_factor * by_position - velocity_factor * by_velocity)
        found: FloatArray = self.sliding[1](mbs, t, item, q, q_t, position_factor, velocity_factor)
        return found

    def constraint(
        self, lock: int, mbs: Any, t: float, item: int, q: Sequence[float], q_t: Sequence[float], level: bool
    ) -> list[float]:
        """Return the slip that the constraint number ``lock`` keeps at zero, as its user function.

        In contrast to a connector's, its coordinates ``q`` contain the reference values.
        """
        return [float(self._row(lock, q) @ q_t)]

    def constraint_jacobian(
        self, lock: int, mbs: Any, t: float, item: int, q: Sequence[float], q_t: Sequence[float], level: bool
    ) -> FloatArray:
        """Return the derivatives of that slip by the velocities, shape (1, n), as the constraint's user function."""
        return self._row(lock, q)[None]

    def _row(self, lock: int, q: Sequence[float]) -> FloatArray:
        if q != self._evaluated[0]:  # Exudyn asks for one row after the other
            rows = np.zeros((3, len(q)))
            rows[: self.basis.shape[1]] = self.rows(np.array(q))
            self._evaluated = list(q), rows
        return np.asarray(self._evaluated[1][lock])


@compiled
def _slip_motion(
    kinds: Kinds, contact: Contact, q: FloatArray, q_t: FloatArray, q_tt: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray, float, float, float]:
    """Return the components of a ``SlipMotion``."""
    to_slip, axes, _ = slip_jacobian(kinds, q)
    stepped = q.astype(np.complex128)
    rates = _coordinate_rates(kinds, q, q_t)
    for k in range(len(q)):
        stepped[k] += 1j * IMAGINARY_STEP * rates[k]
    stepped_map = slip_jacobian(kinds, stepped)[0]
    slip, rate, bias, gradient = np.zeros(3), np.zeros(3), np.zeros(3), np.zeros(3)
    largest = 0.0
    for i in range(3):
        length = 1.0 if i < 2 else contact[0]
        for k in range(len(q)):
            slip[i] += to_slip[i, k] * q_t[k]
            largest = max(largest, length * abs(to_slip[i, k] * q_t[k]))
            bias[i] += stepped_map[i, k].imag / IMAGINARY_STEP * q_t[k]
            rate[i] += to_slip[i, k] * q_tt[k]
        rate[i] += bias[i]
    friction = _unit_friction(slip, contact)
    for i in range(3):
        gradient[i] = -friction[i]
    return slip, rate, bias, gradient, radius_of_disc(kinds, q, axes), _potential(rate, contact), largest


@compiled
def _linear_friction(
    kinds: Kinds,
    contact: Contact,
    q: FloatArray,
    q_t: FloatArray,
    start: FloatArray,
    friction: float,
    slope: float,
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return the forces on the nodes, linear in the slip from ``start``, and their derivatives by q and q_t.

    With a ``slope`` of 0 instead of 1 they do not depend on the slip.
    """
    size = len(q)
    to_slip = slip_jacobian(kinds, q)[0]
    by_slip = slope * friction * derivatives_by_slip(start[0], start[1], start[2], 0.0, contact)[2]
    unit = _unit_friction(start, contact)
    wrench, slip_by_q = np.zeros(3), np.zeros((3, size))
    for i in range(3):
        wrench[i] = friction * unit[i]
        for j in range(3):
            slip = -start[j]
            for k in range(size):
                slip += to_slip[j, k] * q_t[k]
            wrench[i] += by_slip[i, j] * slip
    by_q, by_q_t = np.zeros((size, size)), np.zeros((size, size))
    forces = np.zeros(size)
    for n in range(size):
        stepped = q.astype(np.complex128)
        stepped[n] += 1j * IMAGINARY_STEP
        change = slip_jacobian(kinds, stepped)[0]
        for i in range(3):
            forces[n] += to_slip[i, n] * wrench[i]
            for k in range(size):
                slip_by_q[i, n] += change[i, k].imag / IMAGINARY_STEP * q_t[k]
                by_q[k, n] += change[i, k].imag / IMAGINARY_STEP * wrench[i]
    for k in range(size):
        for n in range(size):
            for i in range(3):
                for j in range(3):
                    by_q[k, n] += to_slip[i, k] * by_slip[i, j] * slip_by_q[j, n]
                    by_q_t[k, n] += to_slip[i, k] * by_slip[i, j] * to_slip[j, n]
    return forces, by_q, by_q_t


@compiled
def _coordinate_rates(kinds: Kinds, q: FloatArray, q_t: FloatArray) -> FloatArray:
    """Return the derivatives of coordinates, which for a rotation vector v are not ω in the body's axes.

    With θ = |v|, v̇ = ω + v×ω/2 + (1 − θ/2·cot(θ/2))/θ²·v×(v×ω).
    """
    rates = q_t.copy()
    start = 0
    for kind in kinds:
        if kind == ROTATION_VECTOR:
            at = start + TRANSLATIONS[kind]
            vector, spin = q[at : at + 3].copy(), q_t[at : at + 3].copy()
            once = np.cross(vector, spin)
            angle = math.sqrt(vector @ vector)
            factor = 1.0 / 12.0
            if angle > 1e-3:
                factor = (1.0 - 0.5 * angle / math.tan(0.5 * angle)) / angle**2
            twice = np.cross(vector, once)
            for i in range(3):
                rates[at + i] = spin[i] + 0.5 * once[i] + factor * twice[i]
        start += SIZES[kind]
    return rates


@compiled
def _unit_friction(slip: FloatArray, contact: Contact) -> tuple[float, float, float]:
    """Return force and moment per newton of μN of a circle or an annulus."""
    return friction_of_slip(slip[0], slip[1], slip[2], 0.0, contact)


@compiled
def _potential(slip: FloatArray, contact: Contact) -> float:
    fx, fy, moment = _unit_friction(slip, contact)
    power: float = -(fx * slip[0] + fy * slip[1] + moment * slip[2])
    return power


@compiled
def _resisted_slip(load: FloatArray, columns: FloatArray, contact: Contact) -> FloatArray:
    """Return the slip w in the span of two ``columns`` with the greatest load·w/P(w).

    The quotient has one maximum between the directions without power, because P is convex. The Illinois method finds
    the zero of its derivative (Dowell & Jarratt, BIT 11 (1971) 168).
    """
    first, second = columns[:, 0].copy(), columns[:, 1].copy()
    middle = math.atan2(load @ second, load @ first)
    low, high = middle - 0.5 * math.pi, middle + 0.5 * math.pi
    below, above = -1.0, 1.0
    side, angle = 0, middle
    for i in range(ITERATIONS):
        slip = math.cos(angle) * first + math.sin(angle) * second
        turn = math.cos(angle) * second - math.sin(angle) * first
        fx, fy, moment = _unit_friction(slip, contact)
        potential = -(fx * slip[0] + fy * slip[1] + moment * slip[2])
        change = -(fx * turn[0] + fy * turn[1] + moment * turn[2])
        slope = change * (load @ slip) - potential * (load @ turn)
        if slope == 0.0 or high - low < ACCURACY:
            break
        if slope < 0.0:
            low, below, above, side = angle, slope, above if side >= 0 else above / 2.0, -1
        else:
            high, above, below, side = angle, slope, below if side <= 0 else below / 2.0, 1
        share = 0.5 if i % 4 == 3 or i == 0 else below / (below - above)
        angle = min(max(low + share * (high - low), low + ACCURACY / 2.0), high - ACCURACY / 2.0)
    return slip


slip_motion, linear_friction = KeptOnDisk(_slip_motion), KeptOnDisk(_linear_friction)
unit_friction, potential = KeptOnDisk(_unit_friction), KeptOnDisk(_potential)
resisted_slip, jacobian_of_slip = KeptOnDisk(_resisted_slip), KeptOnDisk(slip_jacobian)
