"""Slip of a contact, its rate and its friction, compiled for the switching of exact stick."""

import math
from typing import NamedTuple

import numpy as np

from exudyn_models.forces.any_pair import derivatives_on_nodes, slip_of_nodes
from exudyn_models.forces.friction_laws import (
    Contact,
    derivatives_by_slip,
    friction_of_slip,
    slip_potential_of_contact,
)
from exudyn_models.forces.jit import KeptOnDisk, compiled
from exudyn_models.forces.slip_kinematics import (
    IMAGINARY_STEP,
    ROTATION_VECTOR,
    SIZES,
    TRANSLATIONS,
    Kinds,
    slip_and_place,
)
from reference_model.systems import FloatArray

ITERATIONS = 100
"""Largest number of iterations for the slip that a load pulls at."""

ACCURACY = 1e-9
"""Smallest share of an iteration; the load share has an error of second order in the slip."""

RESOLVED = 1e-6
"""Smallest slip with a reliable direction, relative to the speeds of both bodies."""


class SlipMotion(NamedTuple):
    """Motion of a contact that sticks exactly.

    ``slip`` is (u, S) in m/s and rad/s, ``rate`` its derivative and ``bias`` this rate without accelerations, J̇·q̇.
    ``gradient`` contains the derivatives of P with respect to the slip, zero at rest; all have the shape (3,).
    ``potential`` is P in m/s, ``radius`` the distance of the disc's centre from the master's axis in m, and
    ``rate_potential`` P of the rate in m/s². ``largest_term`` in m/s is the largest speed in the sum of the slip. It
    determines the rounding error.
    """

    slip: FloatArray
    rate: FloatArray
    bias: FloatArray
    gradient: FloatArray
    potential: float
    radius: float
    rate_potential: float
    largest_term: float

    @property
    def remaining(self) -> float:
        """Time in s until rest if P keeps its present rate; infinite if P grows."""
        falling = -float(self.gradient @ self.rate)
        return self.potential / falling if falling > 0.0 else math.inf

    @property
    def is_resolved(self) -> bool:
        """True if the direction of the slip is accurate enough for Newton's method."""
        return self.potential >= RESOLVED * self.largest_term > 0.0

    def rests_within(self, time: float) -> bool:
        """Return whether the slip vanishes within a ``time`` (s), or decreases but is not resolved."""
        return self.remaining < time or (self.remaining < math.inf and not self.is_resolved)


@compiled
def _slip_motion(
    kinds: Kinds, contact: Contact, q: FloatArray, q_t: FloatArray, q_tt: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray, float, float, float, float]:
    to_slip, _, _, (x, y) = slip_and_place(kinds, q)
    stepped = q.astype(np.complex128)
    rates = _coordinate_rates(kinds, q, q_t)
    for k in range(len(q)):
        stepped[k] += 1j * IMAGINARY_STEP * rates[k]
    stepped_map = slip_and_place(kinds, stepped)[0]
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
    friction, potential = _unit_friction(slip, contact), 0.0
    for i in range(3):
        gradient[i] = -friction[i]
        potential += gradient[i] * slip[i]
    rate_potential = slip_potential_of_contact(rate[0], rate[1], rate[2], 0.0, contact)
    return slip, rate, bias, gradient, potential, math.sqrt(x * x + y * y), rate_potential, largest


@compiled
def _linear_friction(
    kinds: Kinds,
    contact: Contact,
    q: FloatArray,
    q_t: FloatArray,
    start: FloatArray,
    friction: float,
    slope: float,
    position_factor: float,
    velocity_factor: float,
) -> tuple[FloatArray, FloatArray]:
    """Return the forces on the nodes, linear in the slip from ``start``, and a weighted sum of their derivatives."""
    to_slip, _, turned, _ = slip_and_place(kinds, q)
    slip = slip_of_nodes(to_slip, q_t)
    unit = _unit_friction(start, contact)
    by_slip = slope * friction * derivatives_by_slip(start[0], start[1], start[2], 0.0, contact)[2]
    wrench = np.zeros(3)
    for i in range(3):
        wrench[i] = friction * unit[i]
        for j in range(3):
            wrench[i] += by_slip[i, j] * (slip[j] - start[j])
    force = (wrench[0], wrench[1], wrench[2])
    derivatives, _, forces = derivatives_on_nodes(
        kinds, q, q_t, position_factor, velocity_factor, to_slip, turned, force, by_slip, 0.0
    )
    return forces, derivatives


@compiled
def _coordinate_rates(kinds: Kinds, q: FloatArray, q_t: FloatArray) -> FloatArray:
    rates = q_t.copy()
    start = 0
    for kind in kinds[:2]:
        if kind == ROTATION_VECTOR:
            at = start + TRANSLATIONS[kind]
            rates[at : at + 3] = _rate_of_rotation_vector(q[at : at + 3].copy(), q_t[at : at + 3].copy())
        start += SIZES[kind]
    return rates


@compiled
def _rate_of_rotation_vector(vector: FloatArray, spin: FloatArray) -> FloatArray:
    """Return v̇ = ω + v×ω/2 + (1 − θ/2·cot(θ/2))/θ²·v×(v×ω) with θ = |v| and ω in the body's axes."""
    once, angle = np.cross(vector, spin), math.sqrt(vector @ vector)
    factor = (1.0 - 0.5 * angle / math.tan(0.5 * angle)) / angle**2 if angle > 1e-3 else 1.0 / 12.0
    return spin + 0.5 * once + factor * np.cross(vector, once)


@compiled
def _unit_friction(slip: FloatArray, contact: Contact) -> tuple[float, float, float]:
    return friction_of_slip(slip[0], slip[1], slip[2], 0.0, contact)


@compiled
def _potential_terms(slip: FloatArray, contact: Contact) -> tuple[float, FloatArray, FloatArray]:
    """Return P, its gradient, and P times its second derivatives; at rest the derivatives in the direction of x."""
    size = math.sqrt(slip[0] ** 2 + slip[1] ** 2 + (contact[0] * slip[2]) ** 2)
    along = (
        slip / size if size > 0.0 else np.array([1.0, 0.0, 0.0])
    )  # both results depend on the direction only
    gradient, curvature, potential = np.zeros(3), np.zeros((3, 3)), 0.0
    friction = _unit_friction(along, contact)
    by_slip = derivatives_by_slip(along[0], along[1], along[2], 0.0, contact)[2]
    for i in range(3):
        gradient[i] = -friction[i]
        potential += gradient[i] * along[i]
    for i in range(3):
        for j in range(3):
            curvature[i, j] = -potential * by_slip[i, j]
    return potential * size, gradient, curvature


@compiled
def _resisted_slip(load: FloatArray, columns: FloatArray, contact: Contact) -> FloatArray:
    """Return the slip w in the span of ``columns`` with the greatest load·w − P(w)²/2, by Newton's method.

    P(w) is then the greatest load·w/P(w).
    """
    pull = columns.T @ load
    x, value = np.zeros(len(pull)), 0.0
    change = np.linalg.solve(columns.T @ columns, pull)
    for _ in range(ITERATIONS):
        share = 1.0
        while share > ACCURACY:
            tried = x + share * change
            potential, gradient, curvature = _potential_terms(columns @ tried, contact)
            if pull @ tried - 0.5 * potential**2 > value:
                break
            share *= 0.5
        if share <= ACCURACY:
            break
        x, value = tried, float(pull @ tried - 0.5 * potential**2)
        slopes = columns.T @ (np.outer(gradient, gradient) + curvature) @ columns
        change = np.linalg.solve(slopes, pull - potential * (columns.T @ gradient))
    return columns @ x


slip_motion, linear_friction = KeptOnDisk(_slip_motion), KeptOnDisk(_linear_friction)
unit_friction, resisted_slip = KeptOnDisk(_unit_friction), KeptOnDisk(_resisted_slip)
potential_terms = KeptOnDisk(_potential_terms)
rate_of_rotation_vector = KeptOnDisk(_rate_of_rotation_vector)
