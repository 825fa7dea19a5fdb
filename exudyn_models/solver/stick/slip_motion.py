"""Slip of a contact, its rate and its friction, compiled for the switching of exact stick."""

import math
from typing import Any, NamedTuple

import numpy as np

from exudyn_models.forces.any_pair import Parameters, contact_of, motion_of, slip_of_nodes
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

ACCURACY = 1e-12
"""Relative rise of the load share in the last iteration, or smallest share of an iteration."""

RESOLVED = 1e-6
"""Smallest slip with a reliable direction, relative to the speeds of both bodies."""


class SlipMotion(NamedTuple):
    """Motion of a contact that sticks exactly.

    ``slip`` is (u, S) in m/s and rad/s, ``rate`` its derivative and ``bias`` this rate without accelerations, J̇·q̇,
    all of shape (3,). ``direction`` contains the derivatives of P by u and by the slip of the rim, zero at rest.
    ``potential`` is P in m/s, ``growth`` its derivative in m/s², ``radius`` the distance of the disc's centre from
    the master's axis in m, and ``rate_potential`` P of the rate in m/s². ``largest_term`` in m/s is the largest speed
    in the sum of the slip. It determines the rounding error.
    """

    slip: FloatArray
    rate: FloatArray
    bias: FloatArray
    direction: tuple[float, float, float]
    potential: float
    growth: float
    radius: float
    rate_potential: float
    largest_term: float

    @property
    def remaining(self) -> float:
        """Time in s until rest if P keeps its present rate; infinite if P grows."""
        return -self.potential / self.growth if self.growth < 0.0 else math.inf

    @property
    def is_resolved(self) -> bool:
        """True if the direction of the slip is accurate enough for Newton's method."""
        return self.potential >= RESOLVED * self.largest_term > 0.0

    def rests_within(self, time: float) -> bool:
        """Return whether the slip vanishes within a ``time`` (s), or decreases but is not resolved."""
        return self.remaining < time or (self.remaining < math.inf and not self.is_resolved)


@compiled
def _slip_motion(
    kinds: Kinds, contact: Contact, rim: float, q: FloatArray, q_t: FloatArray, q_tt: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray, tuple[float, float, float], float, float, float, float, float]:
    to_slip, _, _, (x, y) = slip_and_place(kinds, q)
    stepped = q.astype(np.complex128)
    rates = _coordinate_rates(kinds, q, q_t)
    for k in range(len(q)):
        stepped[k] += 1j * IMAGINARY_STEP * rates[k]
    stepped_map = slip_and_place(kinds, stepped)[0]
    slip, rate, bias = np.zeros(3), np.zeros(3), np.zeros(3)
    largest = 0.0
    for i in range(3):
        length = 1.0 if i < 2 else contact[0]
        for k in range(len(q)):
            slip[i] += to_slip[i, k] * q_t[k]
            largest = max(largest, length * abs(to_slip[i, k] * q_t[k]))
            bias[i] += stepped_map[i, k].imag / IMAGINARY_STEP * q_t[k]
            rate[i] += to_slip[i, k] * q_tt[k]
        rate[i] += bias[i]
    fx, fy, moment = _unit_friction(slip, contact)
    direction = -fx, -fy, -moment / rim
    potential = -(fx * slip[0] + fy * slip[1] + moment * slip[2])
    growth = -(fx * rate[0] + fy * rate[1] + moment * rate[2])
    rate_potential = slip_potential_of_contact(rate[0], rate[1], rate[2], 0.0, contact)
    radius = math.sqrt(x * x + y * y)
    return slip, rate, bias, direction, potential, growth, radius, rate_potential, largest


LINE_SIZE = 15


@compiled
def _line_from(slip: FloatArray, contact: Contact) -> FloatArray:
    """Return a slip, friction per newton there, and its derivatives row by row, shape (``LINE_SIZE``,)."""
    line, unit = np.zeros(LINE_SIZE), _unit_friction(slip, contact)
    by_slip = derivatives_by_slip(slip[0], slip[1], slip[2], 0.0, contact)[2]
    for i in range(3):
        line[i], line[3 + i] = slip[i], unit[i]
        for j in range(3):
            line[6 + 3 * i + j] = by_slip[i, j]
    return line


@compiled
def _on_line(
    line: FloatArray, friction: float, slope: float, slip: tuple[float, float, float]
) -> tuple[float, float, float]:
    """Return the friction under ``friction`` N, linear in the slip with a share ``slope`` of its derivatives."""
    wrench = np.zeros(3)
    for i in range(3):
        wrench[i] = line[3 + i]
        for j in range(3):
            wrench[i] += slope * line[6 + 3 * i + j] * (slip[j] - line[j])
    return friction * wrench[0], friction * wrench[1], friction * wrench[2]


@compiled
def linear_force(
    parameters: Parameters, line: FloatArray, friction: float, slope: float, mbs: Any, t: Any, item: Any, q: Any,
    q_t: Any,
) -> Any:  # fmt: skip
    """Return the generalised forces on both nodes by linear friction, in the memory of ``q_t``."""
    coordinates, velocities = motion_of(parameters, q, q_t)
    to_slip = slip_and_place(contact_of(parameters)[1], coordinates)[0]
    fx, fy, moment = _on_line(line, friction, slope, slip_of_nodes(to_slip, velocities))
    for k in range(len(velocities)):
        velocities[k] = fx * to_slip[0, k] + fy * to_slip[1, k] + moment * to_slip[2, k]
    return q_t


@compiled
def linear_jacobian(
    parameters: Parameters, line: FloatArray, friction: float, slope: float, mbs: Any, t: Any, item: Any, q: Any,
    q_t: Any, position_factor: float, velocity_factor: float,
) -> FloatArray:  # fmt: skip
    """Return the weighted sum of the derivatives of minus these forces, shape (n, n).

    Bodies turn too little in a step for the derivatives of J to matter.
    """
    coordinates, _ = motion_of(parameters, q, q_t)
    to_slip = slip_and_place(contact_of(parameters)[1], coordinates)[0]
    size, factor = len(coordinates), -velocity_factor * slope * friction
    result, by_velocities = np.zeros((size, size)), np.zeros((3, size))
    for i in range(3):
        for j in range(3):
            for k in range(size):
                by_velocities[i, k] += factor * line[6 + 3 * i + j] * to_slip[j, k]
    for i in range(3):
        for k in range(size):
            for j in range(size):
                result[k, j] += to_slip[i, k] * by_velocities[i, j]
    return result


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
def _potential_along_locks(
    slip: FloatArray, rim: float, contact: Contact
) -> tuple[float, FloatArray, FloatArray]:
    """Return the same for a slip whose third component, if any, is the slip of the rim (m/s)."""
    count, whole = len(slip), np.zeros(3)
    for i in range(count):
        whole[i] = slip[i] if i < 2 else slip[i] / rim
    potential, gradient, curvature = _potential_terms(whole, contact)
    gradient[2] /= rim
    for i in range(3):
        curvature[i, 2] /= rim
        curvature[2, i] /= rim
    return potential, gradient[:count], curvature[:count, :count]


@compiled
def _resisted_slip(
    load: FloatArray, columns: FloatArray, start: FloatArray, contact: Contact
) -> tuple[float, FloatArray]:
    """Return the greatest load·w/P(w) of slips w in the span of ``columns``, and this w with P(w) = 1 m/s.

    Newton's method finds the greatest load·w − P(w)²/2, from a slip ``start``, or along the load if that is zero.
    """
    count = columns.shape[1]
    gram, pull, x = np.zeros((count, count)), np.zeros(count), np.zeros(count)
    for i in range(count):
        for k in range(3):
            pull[i] += columns[k, i] * load[k]
            x[i] += columns[k, i] * start[k]
            for j in range(count):
                gram[i, j] += columns[k, i] * columns[k, j]
    if not pull.any():
        return 0.0, np.zeros(3)
    tried = _solved(gram.copy(), x)
    if not _product(pull, tried) > 0.0:
        tried = _solved(gram, pull.copy())
    change, greatest, share = np.zeros(count), 0.0, 1.0
    for _ in range(ITERATIONS):
        potential, gradient, slopes = _potential_in(columns, tried, contact)
        found = _product(pull, tried) / potential
        if found > greatest:
            x, greatest, share = (
                tried * (found / potential),
                found,
                1.0,
            )  # the greatest value in this direction
            error = pull - found * gradient
            change = _solved(slopes, error.copy())
            if _product(error, change) <= ACCURACY * found * found:
                x += change
                break
        else:
            share *= 0.5
            if share <= ACCURACY:
                break
        tried = x + share * change
    potential = _potential_in(columns, x, contact)[0]
    return _product(pull, x) / potential, _combined(columns, x) / potential


@compiled
def _potential_in(
    columns: FloatArray, x: FloatArray, contact: Contact
) -> tuple[float, FloatArray, FloatArray]:
    """Return P of a combination of ``columns``, and the derivatives of P and of P²/2 (two) by its factors."""
    potential, along, curvature = _potential_terms(_combined(columns, x), contact)
    count = len(x)
    gradient, slopes = np.zeros(count), np.zeros((count, count))
    for i in range(count):
        for k in range(3):
            gradient[i] += columns[k, i] * along[k]
    for i in range(count):
        for j in range(count):
            slopes[i, j] = gradient[i] * gradient[j]
            for k in range(3):
                for m in range(3):
                    slopes[i, j] += columns[k, i] * curvature[k, m] * columns[m, j]
    return potential, gradient, slopes


@compiled
def _combined(columns: FloatArray, factors: FloatArray) -> FloatArray:
    result = np.zeros(3)
    for i in range(3):
        result[i] = _product(columns[i], factors)
    return result


@compiled
def _product(one: FloatArray, other: FloatArray) -> float:
    result = 0.0
    for k in range(len(one)):
        result += one[k] * other[k]
    return result


@compiled
def _solved(matrix: FloatArray, right: FloatArray) -> FloatArray:
    """Solve equations with a positive matrix in its memory and that of the ``right`` side; return the solution."""
    size = len(right)
    for i in range(size):
        for j in range(i + 1, size):
            factor = matrix[j, i] / matrix[i, i]
            right[j] -= factor * right[i]
            for k in range(i, size):
                matrix[j, k] -= factor * matrix[i, k]
    for i in range(size - 1, -1, -1):
        for k in range(i + 1, size):
            right[i] -= matrix[i, k] * right[k]
        right[i] /= matrix[i, i]
    return right


slip_motion, line_from = KeptOnDisk(_slip_motion), KeptOnDisk(_line_from)
unit_friction, resisted_slip = KeptOnDisk(_unit_friction), KeptOnDisk(_resisted_slip)
potential_along_locks = KeptOnDisk(_potential_along_locks)
rate_of_rotation_vector = KeptOnDisk(_rate_of_rotation_vector)
