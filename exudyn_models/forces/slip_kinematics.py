"""Slip as a linear map of the velocities of two nodes, and friction as its transpose, for every kind of node.

The slip u of the disc's centre over the master, in the axes of the master's body, and the relative spin S about the
master's axis are J(q)·q̇. Friction with the force F and the moment M has the power F·u + M·S, so that its generalised
forces on both nodes are Jᵀ·(F, M): −F and −M − d×F on a master at the distance d. That is an exchange of momentum and
angular momentum, however the axes lie, and the derivatives of the forces follow from those of J.

J is made of sums, products, sines and cosines, whose derivatives are found to all digits from a step along the
imaginary axis (Squire & Trapp, SIAM Review 40 (1998) 110).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numba.np.unsafe.ndarray
import numpy as np
from numpy.typing import NDArray

from exudyn_models.forces.friction_laws import (
    CONTACT_SIZE,
    Contact,
    contact_of,
    derivatives_by_slip,
    friction_of_slip,
    slip_potential_of_contact,
)
from exudyn_models.forces.jit import compiled
from reference_model.systems import FloatArray

ROTOR, PLANAR, ROTATION_VECTOR, TAIT_BRYAN = 0, 1, 2, 3

KINDS = {
    "1D": ROTOR,
    "RigidBody2D": PLANAR,
    "RigidBodyRotVecLG": ROTATION_VECTOR,
    "RigidBodyRxyz": TAIT_BRYAN,
}
"""The kinds of nodes by the names that Exudyn gives them."""

TRANSLATIONS = (0, 2, 3, 3)
"""Coordinates of each kind that are a position; those of the rotation follow."""

SIZES = (1, 3, 6, 6)
"""Coordinates of each kind."""

IMAGINARY_STEP = 1e-30

Kinds = tuple[int, int]
"""Of the nodes of master and disc."""

Floats = Sequence[float]

to_tuple: Any = numba.np.unsafe.ndarray.to_fixed_tuple  # unsafe if the array is shorter than it is told to be

Array = NDArray[Any]
"""Of real numbers, or of complex ones where derivatives are asked for."""


@compiled
def slip_jacobian(kinds: Kinds, coordinates: Array) -> tuple[Array, Array, tuple[Any, Any]]:
    """Return J, shape (3, n), the axes of the master, and cosine and sine of the disc's angle in them.

    ``coordinates`` are those of master and disc with their reference values, n in all, in m and rad. A rotor turns
    about the z-axis through the global origin, a planar body about one that is parallel to it.
    """
    master, disc = kinds
    size, before, first = SIZES[master], TRANSLATIONS[master], TRANSLATIONS[disc]
    place, axes, turning = _frame(master, coordinates[:size])
    disc_place, disc_axes, disc_turning = _frame(disc, coordinates[size:])
    result = np.zeros((3, len(coordinates)), coordinates.dtype)
    for i in range(2):
        axis = axes[:, i]
        lever = np.cross(disc_place - place, axis)  # (ω×d)·e = ω·(d×e)
        result[i, :before] = -axis[:before]
        result[i, size : size + first] = axis[:first]
        for k in range(size - before):
            result[i, before + k] = -_product(lever, turning[:, k])
    for k in range(size - before):
        result[2, before + k] = -_product(axes[:, 2], turning[:, k])
    for k in range(SIZES[disc] - first):
        result[2, size + first + k] = _product(axes[:, 2], disc_turning[:, k])
    mark = disc_axes[:, 0]
    return result, axes, (_product(mark, axes[:, 0]), _product(mark, axes[:, 1]))


@compiled
def place_of_disc(kinds: Kinds, coordinates: Array, axes: Array) -> tuple[Any, Any]:
    """Return the place of the disc's node over the axis of the master with ``axes``, in two of these, in m."""
    master, disc = kinds
    x = y = 0.0 * coordinates[0]
    for i in range(max(TRANSLATIONS[master], TRANSLATIONS[disc])):
        apart = 0.0 * coordinates[0]
        if i < TRANSLATIONS[disc]:
            apart += coordinates[SIZES[master] + i]
        if i < TRANSLATIONS[master]:
            apart -= coordinates[i]
        x += apart * axes[i, 0]
        y += apart * axes[i, 1]
    return x, y


@compiled
def radius_of_disc(kinds: Kinds, coordinates: Array, axes: Array) -> Any:
    """Return the distance in m of the disc's node from the axis of the master with ``axes``, across it."""
    x, y = place_of_disc(kinds, coordinates, axes)
    return np.sqrt(x * x + y * y)


@compiled
def friction_on_nodes(
    kinds: Kinds, coordinates: FloatArray, velocities: FloatArray, contact: Contact
) -> tuple[FloatArray, float, float]:
    """Return the generalised forces on both nodes, shape (n,), the disc's radius in m, and P in m/s."""
    to_slip, axes, (cosine, sine) = slip_jacobian(kinds, coordinates)
    ux, uy, spin = to_slip @ velocities
    angle = math.atan2(sine, cosine)
    fx, fy, moment = friction_of_slip(ux, uy, spin, angle, contact)
    forces = fx * to_slip[0] + fy * to_slip[1] + moment * to_slip[2]
    radius = radius_of_disc(kinds, coordinates, axes)
    return forces, radius, slip_potential_of_contact(ux, uy, spin, angle, contact)


@compiled
def friction_derivatives_on_nodes(
    kinds: Kinds,
    coordinates: FloatArray,
    velocities: FloatArray,
    position_factor: float,
    velocity_factor: float,
    contact: Contact,
) -> tuple[FloatArray, FloatArray]:
    """Return the derivatives of the generalised forces, shape (n, n), and of radius and slip speed, shape (2, n).

    They are weighted sums of those by the coordinates and by the velocities.
    """
    to_slip, _, (cosine, sine) = slip_jacobian(kinds, coordinates)
    ux, uy, spin = to_slip @ velocities
    angle = math.atan2(sine, cosine)
    force = np.array(friction_of_slip(ux, uy, spin, angle, contact))
    _, _, by_slip = derivatives_by_slip(ux, uy, spin, angle, contact)
    # Friction is −μN·∂P/∂(u, S), or P/ε of that; P does not change if slip and disc are turned alike.
    speed = slip_potential_of_contact(ux, uy, spin, angle, contact)
    creep = min(1.0, speed / contact[3])
    slope = -1.0 / (contact[2] * creep) if creep > 0.0 else 0.0
    size = len(coordinates)
    by_nodes, motion_by_nodes = np.zeros((size, size)), np.zeros((2, size))
    for j in range(size):
        stepped = coordinates.astype(np.complex128)
        stepped[j] += 1j * IMAGINARY_STEP
        stepped_map, stepped_axes, (stepped_cosine, stepped_sine) = slip_jacobian(kinds, stepped)
        stepped_radius = radius_of_disc(kinds, stepped, stepped_axes)
        motion_by_nodes[0, j] = position_factor * stepped_radius.imag / IMAGINARY_STEP
        map_change = position_factor * stepped_map.imag / IMAGINARY_STEP
        turn = cosine * stepped_sine.imag - sine * stepped_cosine.imag
        turn *= position_factor / IMAGINARY_STEP / (cosine * cosine + sine * sine)
        slip_change = map_change @ velocities + velocity_factor * to_slip[:, j]
        force_change = by_slip[:, :3].copy() @ slip_change + by_slip[:, 3] * turn
        for i in range(3):
            by_nodes[:, j] += force[i] * map_change[i] + force_change[i] * to_slip[i]
            motion_by_nodes[1, j] += slope * force[i] * slip_change[i]
        motion_by_nodes[1, j] -= slope * (force[1] * ux - force[0] * uy) * turn
    return by_nodes, motion_by_nodes


@compiled
def force_on_any(parameters: Floats, mbs: Any, t: float, item: int, q: Floats, q_t: Floats) -> Floats:
    """Return the generalised forces on both nodes, as a function for Exudyn behind its ``parameters``.

    These are the numbers of ``Contact`` and ``Kinds`` and the reference coordinates of both nodes.
    """
    contact, kinds, coordinates, velocities = _state(parameters, q, q_t)
    forces, _, _ = friction_on_nodes(kinds, coordinates, velocities, contact)
    result: Floats = to_tuple(forces, len(q))
    return result


@compiled
def jacobian_on_any(
    parameters: Floats,
    mbs: Any,
    t: float,
    item: int,
    q: Floats,
    q_t: Floats,
    position_factor: float,
    velocity_factor: float,
) -> FloatArray:
    """Return the derivatives of the left-hand side, where the force stands with a minus, shape (n, n)."""
    contact, kinds, coordinates, velocities = _state(parameters, q, q_t)
    return -friction_derivatives_on_nodes(
        kinds, coordinates, velocities, position_factor, velocity_factor, contact
    )[0]


@compiled
def _state(parameters: Floats, q: Floats, q_t: Floats) -> tuple[Contact, Kinds, FloatArray, FloatArray]:
    contact, kinds = contact_of(parameters)
    coordinates, velocities = np.empty(len(q)), np.empty(len(q))
    for i in range(len(q)):
        coordinates[i] = parameters[CONTACT_SIZE + 2 + i] + q[i]
        velocities[i] = q_t[i]
    return contact, (int(kinds[0]), int(kinds[1])), coordinates, velocities


@compiled
def _frame(kind: int, q: Array) -> tuple[Array, Array, Array]:
    """Return position and axes of a body, and the columns that turn rates of its coordinates into ω."""
    place, axes, turning = np.zeros(3, q.dtype), np.zeros((3, 3), q.dtype), np.zeros((3, 3), q.dtype)
    first = TRANSLATIONS[kind]
    place[:first] = q[:first]
    if kind == ROTATION_VECTOR:
        _rotate_by_vector(q[3:], axes)
        turning[:] = axes  # the velocities are ω in the body's axes
    elif kind == TAIT_BRYAN:
        cx, cy, cz = np.cos(q[3:])
        sx, sy, sz = np.sin(q[3:])
        axes[0, 0], axes[0, 1], axes[0, 2] = cy * cz, -cy * sz, sy
        axes[1, 0], axes[1, 1], axes[1, 2] = cx * sz + sx * sy * cz, cx * cz - sx * sy * sz, -sx * cy
        axes[2, 0], axes[2, 1], axes[2, 2] = sx * sz - cx * sy * cz, sx * cz + cx * sy * sz, cx * cy
        turning[0, 0] = 1.0
        turning[1, 1], turning[2, 1] = cx, sx
        turning[:, 2] = axes[:, 2]
    else:
        c, s = np.cos(q[first]), np.sin(q[first])
        axes[0, 0], axes[0, 1] = c, -s
        axes[1, 0], axes[1, 1] = s, c
        axes[2, 2] = turning[2, 0] = 1.0
    return place, axes, turning


@compiled
def _rotate_by_vector(v: Array, axes: Array) -> None:
    """Fill ``axes``, all zero, by Rodrigues' formula, 1 + sin(θ)/θ·[v] + (1 − cos(θ))/θ²·[v]²."""
    square = _product(v, v)
    theta = np.sqrt(square)
    # Half angles keep the digits of 1 − cos(θ).
    linear = np.sin(theta) / theta if theta != 0.0 else theta + 1.0
    half = np.sin(theta / 2.0) / theta if theta != 0.0 else theta + 0.5
    quadratic = 2.0 * half * half
    for i in range(3):
        for j in range(3):
            axes[i, j] += quadratic * v[i] * v[j]
        axes[i, i] += 1.0 - quadratic * square
        j, k = (i + 1) % 3, (i + 2) % 3
        axes[k, j] += linear * v[i]
        axes[j, k] -= linear * v[i]


@compiled
def _product(a: Array, b: Array) -> Any:
    """Return a·b without the complex conjugate."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
