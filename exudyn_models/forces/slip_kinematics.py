"""Slip as a linear map of the velocities of two nodes, for every kind of node.

The slip u of the disc's centre over the master, in the axes of the master's body, and the relative spin S about the
master's axis are J(q)·q̇. A force F and a moment M on the disc have the power F·u + M·S, so that their generalised
forces on both nodes are Jᵀ·(F, M): −F and −M − d×F on a master at the distance d. That is an exchange of momentum and
angular momentum, however the axes lie, and the derivatives of the forces follow from those of J.

J is made of sums, products, sines and cosines, whose derivatives are found to all digits from a step along the
imaginary axis (Squire & Trapp, SIAM Review 40 (1998) 110).

Numbers are put into arrays one by one: for a slice numba would compile the text of an error of shapes, which takes as
long as all the rest.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from exudyn_models.forces.jit import compiled

ROTOR, PLANAR, ROTATION_VECTOR, TAIT_BRYAN, GROUND, EULER_PARAMETERS = 0, 1, 2, 3, 4, 5

KINDS = {
    "1D": ROTOR,
    "RigidBody2D": PLANAR,
    "RigidBodyRotVecLG": ROTATION_VECTOR,
    "RigidBodyRxyz": TAIT_BRYAN,
    "RigidBodyEP": EULER_PARAMETERS,
}
"""The kinds of nodes by the names that Exudyn gives them."""

SPATIAL = (ROTATION_VECTOR, TAIT_BRYAN, EULER_PARAMETERS)

TRANSLATIONS = (0, 2, 3, 3, 0, 3)
"""Coordinates of each kind that are a position; those of the rotation follow."""

SIZES = (1, 3, 6, 6, 0, 7)
"""Coordinates of each kind; the ground has none."""

IMAGINARY_STEP = 1e-30

Kinds = tuple[int, int]
"""Of the nodes of master and disc."""

Floats = Sequence[float]

Array = NDArray[Any]
"""Of real numbers, or of complex ones where derivatives are asked for."""


@compiled
def slip_jacobian(kinds: Kinds, coordinates: Array) -> tuple[Array, Array, tuple[Any, Any]]:
    """Return J, shape (3, n), the axes of the master, and cosine and sine of the disc's angle in them.

    ``coordinates`` are those of master and disc with their reference values, n in all, in m and rad. A rotor turns
    about the z-axis through the global origin, where the ground rests, a planar body about one parallel to it.
    """
    master, disc = kinds
    size, before, first = SIZES[master], TRANSLATIONS[master], TRANSLATIONS[disc]
    place, axes, turning = _frame(master, coordinates[:size])
    disc_place, disc_axes, disc_turning = _frame(disc, coordinates[size:])
    result = np.zeros((3, len(coordinates)), coordinates.dtype)
    for i in range(2):
        axis = axes[:, i]
        lever = _lever(place, disc_place, axis)  # (ω×d)·e = ω·(d×e)
        for k in range(before):
            result[i, k] = -axis[k]
        for k in range(first):
            result[i, size + k] = axis[k]
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
def _frame(kind: int, q: Array) -> tuple[Array, Array, Array]:
    """Return position and axes of a body, and the columns that turn rates of its coordinates into ω."""
    place, axes, turning = np.zeros(3, q.dtype), np.zeros((3, 3), q.dtype), np.zeros((3, 4), q.dtype)
    first = TRANSLATIONS[kind]
    for i in range(first):
        place[i] = q[i]
    if kind == ROTATION_VECTOR:
        _rotate_by_vector(q[3:], axes)
        for i in range(3):
            for j in range(3):
                turning[i, j] = axes[i, j]  # the velocities are ω in the body's axes
    elif kind == TAIT_BRYAN:
        cx, cy, cz = np.cos(q[3]), np.cos(q[4]), np.cos(q[5])
        sx, sy, sz = np.sin(q[3]), np.sin(q[4]), np.sin(q[5])
        axes[0, 0], axes[0, 1], axes[0, 2] = cy * cz, -cy * sz, sy
        axes[1, 0], axes[1, 1], axes[1, 2] = cx * sz + sx * sy * cz, cx * cz - sx * sy * sz, -sx * cy
        axes[2, 0], axes[2, 1], axes[2, 2] = sx * sz - cx * sy * cz, sx * cz + cx * sy * sz, cx * cy
        turning[0, 0] = 1.0
        turning[1, 1], turning[2, 1] = cx, sx
        for i in range(3):
            turning[i, 2] = axes[i, 2]
    elif kind == EULER_PARAMETERS:
        _rotate_by_euler_parameters(q[3:], axes, turning)
    elif kind == GROUND:
        for i in range(3):
            axes[i, i] = 1.0
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
def _rotate_by_euler_parameters(p: Array, axes: Array, turning: Array) -> None:
    """Fill ``axes`` and ``turning``, all zero: ω = 2·(p₀·ṗ − ṗ₀·p + p×ṗ), with p₀ and the vector p.

    Both are those of Exudyn, quadratic and linear in parameters whose norm is 1 but for the error of Newton's method.
    """
    for i in range(3):
        j, k = (i + 1) % 3, (i + 2) % 3
        axes[i, i] = p[0] * p[0] + p[1 + i] * p[1 + i] - p[1 + j] * p[1 + j] - p[1 + k] * p[1 + k]
        axes[i, j] = 2.0 * (p[1 + i] * p[1 + j] - p[0] * p[1 + k])
        axes[i, k] = 2.0 * (p[1 + i] * p[1 + k] + p[0] * p[1 + j])
        turning[i, 0], turning[i, 1 + i] = -2.0 * p[1 + i], 2.0 * p[0]
        turning[i, 1 + j], turning[i, 1 + k] = -2.0 * p[1 + k], 2.0 * p[1 + j]


@compiled
def _lever(start: Array, end: Array, axis: Array) -> tuple[Any, Any, Any]:
    """Return the cross product of what is between two places and an axis."""
    x, y, z = end[0] - start[0], end[1] - start[1], end[2] - start[2]
    return y * axis[2] - z * axis[1], z * axis[0] - x * axis[2], x * axis[1] - y * axis[0]


@compiled
def _product(a: Array | tuple[Any, Any, Any], b: Array) -> Any:
    """Return a·b without the complex conjugate."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
