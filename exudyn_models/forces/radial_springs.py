"""Springs that may harden, a stop and a damper between a base and a disc, as user functions for Exudyn.

The force at the deflection w is −K·w − β·ẇ with the secant stiffness K = C + C₃·d² + C_s·(1 − gap/d), d = |w|, the
last term only beyond the gap. ẇ is the slip J(q)·q̇ of ``slip_kinematics``, and Jᵀ applies the full reaction to the
base. Closed forms for a base that only turns about the z-axis cost less.
"""

import math
from collections.abc import Sequence
from functools import partial
from typing import Any, cast

import numpy as np

from exudyn_models.forces.any_pair import Parameters
from exudyn_models.forces.jit import FLOATS, TABLE, KeptOnDisk, as_arrays, compiled, entry_point
from exudyn_models.forces.slip_kinematics import (
    IMAGINARY_STEP,
    NO_MOUNTS,
    PLANAR,
    SIZES,
    TRANSLATIONS,
    Kinds,
    slip_and_place,
)
from exudyn_models.forces.user_functions import ForceFunction, JacobianFunction
from reference_model.systems import FloatArray

Law = tuple[float, float, float, float, float]
"""C (N/m), C₃ (N/m³), gap (m), C_s (N/m) and β (N s/m)."""

Offset = tuple[float, float]
"""Position in m of the relaxed springs, in the axes of the base and from its node."""

ON_GROUND, ON_ROTOR = SIZES[PLANAR], TRANSLATIONS[PLANAR]
"""Numbers of fixed coordinates of a planar base that stands for the ground or a rotor."""


def support_functions(
    hidden: int, kinds: Kinds, reference: FloatArray, offset: Offset, law: Law
) -> tuple[ForceFunction, JacobianFunction]:
    """Return force and Jacobian of a support on the nodes of base and disc.

    ``reference`` contains the reference coordinates of both, shape (n,). The model omits the first ``hidden``
    coordinates, which are zero.
    """
    if kinds[0] == PLANAR and kinds[2] == NO_MOUNTS:
        force = _force_on_flat_base(hidden, reference, offset, law)
    else:
        force = _force_on_any_base(kinds, reference, offset, law)
    return force, _jacobian(hidden, kinds, reference, offset, law)


def _force_on_flat_base(hidden: int, reference: FloatArray, offset: Offset, law: Law) -> ForceFunction:
    xb, yb, angle, x, y, *_ = reference.tolist()
    table = np.array([hidden, len(reference) - hidden, *law, *offset, x - xb, y - yb, angle])
    return partial(entry_point(force_in_the_plane, TABLE, None, None, None, FLOATS, FLOATS), table)


def _force_on_any_base(kinds: Kinds, reference: FloatArray, offset: Offset, law: Law) -> ForceFunction:
    def force(mbs: Any, t: float, item: int, q: Sequence[float], q_t: Sequence[float]) -> list[float]:
        forces = on_nodes(kinds, reference + q, np.array(q_t), offset, law)
        return cast(list[float], forces.tolist())

    return force


def _jacobian(hidden: int, kinds: Kinds, reference: FloatArray, offset: Offset, law: Law) -> JacobianFunction:
    zeros = np.zeros(len(reference))

    def jacobian(
        mbs: Any,
        t: float,
        item: int,
        q: Sequence[float],
        q_t: Sequence[float],
        position_factor: float,
        velocity_factor: float,
    ) -> FloatArray:
        coordinates, velocities, factors = reference.copy(), zeros.copy(), (position_factor, velocity_factor)
        coordinates[hidden:] += q
        velocities[hidden:] = q_t
        derivatives: FloatArray = derivatives_on_nodes(kinds, coordinates, velocities, *factors, offset, law)
        return -derivatives[hidden:, hidden:]  # Exudyn expects derivatives of the negative force

    return jacobian


@compiled
def secant_stiffness(square: float, law: Law) -> float:
    """Return the force of springs and stop divided by the deflection d, in N/m, from d²."""
    stiffness, hardening, gap, stop, _ = law
    result = stiffness + hardening * square
    if square > gap * gap:
        result += stop * (1.0 - gap / math.sqrt(square))
    return result


@compiled
def secant_slope(square: float, law: Law) -> float:
    """Return twice the derivative of ``secant_stiffness`` with respect to d², in N/m³."""
    _, hardening, gap, stop, _ = law
    result = 2.0 * hardening
    if square > gap * gap:
        result += stop * gap / (square * math.sqrt(square))
    return result


@compiled
def elastic_energy(square: float, law: Law) -> float:
    """Return the energy in J of springs and stop from d²."""
    stiffness, hardening, gap, stop, _ = law
    beyond = max(0.0, math.sqrt(square) - gap)
    return (stiffness * square + hardening * square * square / 2.0 + stop * beyond * beyond) / 2.0


@compiled
def force_in_the_plane(table: Parameters, mbs: Any, t: float, item: int, q: Any, q_t: Any) -> Any:
    """Return the forces on both nodes, in the memory of ``q_t``, for a base that only turns about the z-axis.

    ``table`` contains the numbers of hidden and of other coordinates, a ``Law``, an ``Offset``, and
    reference values of the disc's relative position and the base's angle.
    """
    disc, size = SIZES[PLANAR] - int(table[0]), int(table[1])
    positions, velocities = as_arrays(q, q_t, size)
    x, y, vx, vy = positions[disc], positions[disc + 1], velocities[disc], velocities[disc + 1]
    angle = spin = 0.0
    if disc > 0:
        angle, spin = positions[disc - 1], velocities[disc - 1]
    if disc > 1:
        x, y, vx, vy = x - positions[0], y - positions[1], vx - velocities[0], vy - velocities[1]
    law = table[2], table[3], table[4], table[5], table[6]
    offset_x, offset_y, angle = table[7], table[8], table[11] + angle
    x, y, cosine, sine = table[9] + x, table[10] + y, math.cos(angle), math.sin(angle)
    wx, wy = x - cosine * offset_x + sine * offset_y, y - sine * offset_x - cosine * offset_y
    secant, damping = secant_stiffness(wx * wx + wy * wy, law), law[4]
    fx, fy = -secant * wx - damping * (vx + spin * y), -secant * wy - damping * (vy - spin * x)
    for i in range(size):
        velocities[i] = 0.0
    velocities[disc], velocities[disc + 1] = fx, fy
    if disc > 0:
        velocities[disc - 1] = y * fx - x * fy
    if disc > 1:
        velocities[0], velocities[1] = -fx, -fy
    return q_t


@compiled
def support_on_nodes(
    kinds: Kinds, coordinates: FloatArray, velocities: FloatArray, offset: Offset, law: Law
) -> FloatArray:
    """Return the generalised forces on both nodes, shape (n,)."""
    to_slip, _, _, (x, y) = slip_and_place(kinds, coordinates)
    wx, wy = x - offset[0], y - offset[1]
    rate = to_slip @ velocities
    secant = secant_stiffness(wx * wx + wy * wy, law)
    fx, fy = -secant * wx - law[4] * rate[0], -secant * wy - law[4] * rate[1]
    forces: FloatArray = fx * to_slip[0] + fy * to_slip[1]
    return forces


@compiled
def support_derivatives_on_nodes(
    kinds: Kinds,
    coordinates: FloatArray,
    velocities: FloatArray,
    position_factor: float,
    velocity_factor: float,
    offset: Offset,
    law: Law,
) -> FloatArray:
    """Return the weighted sum of ∂(generalised forces)/∂(coordinates, velocities), shape (n, n)."""
    to_slip, _, _, place = slip_and_place(kinds, coordinates)
    w = np.array(place) - np.array(offset)
    rate = to_slip @ velocities
    square, damping = w[0] * w[0] + w[1] * w[1], law[4]
    secant, slope = secant_stiffness(square, law), secant_slope(square, law)
    size = len(coordinates)
    result = np.zeros((size, size))
    for j in range(size):
        stepped = coordinates.astype(np.complex128)
        stepped[j] += 1j * IMAGINARY_STEP
        stepped_map, _, _, shifts = slip_and_place(kinds, stepped)
        map_change = position_factor * stepped_map.imag / IMAGINARY_STEP
        rate_change = map_change @ velocities + velocity_factor * to_slip[:, j]
        shift = position_factor / IMAGINARY_STEP * np.array([shifts[0].imag, shifts[1].imag])
        along = slope * (w[0] * shift[0] + w[1] * shift[1])
        for i in range(2):
            change = secant * shift[i] + along * w[i] + damping * rate_change[i]
            result[:, j] -= change * to_slip[i] + (secant * w[i] + damping * rate[i]) * map_change[i]
    return result


on_nodes, derivatives_on_nodes = KeptOnDisk(support_on_nodes), KeptOnDisk(support_derivatives_on_nodes)
