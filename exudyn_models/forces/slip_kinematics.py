"""Slip as a linear map of the velocities of two nodes, for all kinds of nodes.

The slip u of the disc's centre on the master, in the master body's axes, and the relative spin S about the master's
axis are J(q)·q̇. A force F and a moment M on the disc have the power F·u + M·S, so the generalised forces on both
nodes are Jᵀ·(F, M): −F and −M − d×F on a master at the distance d. This conserves momentum and angular momentum.

``Mounts`` place a contact anywhere on its bodies; the lever from the disc's node to the contact then enters J.
Without mounts the contact is at the nodes, which is cheaper.

J consists of sums, products, sines and cosines, whose derivatives follow exactly from a step along the imaginary axis
(Squire & Trapp, SIAM Review 40 (1998) 110).

Array elements are assigned one by one, because the error message for a wrong slice would double the compile time.
"""

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from exudyn_models.forces.jit import KeptOnDisk, compiled, inlined
from exudyn_models.forces.laws.tables import number_at

ROTOR, PLANAR, ROTATION_VECTOR, TAIT_BRYAN, GROUND, EULER_PARAMETERS, POINT_2D, POINT = range(8)

KINDS = {
    "1D": ROTOR,
    "RigidBody2D": PLANAR,
    "RigidBodyRotVecLG": ROTATION_VECTOR,
    "RigidBodyRxyz": TAIT_BRYAN,
    "RigidBodyEP": EULER_PARAMETERS,
    "Point2D": POINT_2D,
    "Point": POINT,
}
"""Kinds of nodes, by Exudyn's names."""

SPATIAL = (ROTATION_VECTOR, TAIT_BRYAN, EULER_PARAMETERS)

POINTS = (POINT_2D, POINT)
"""Kinds without rotation."""

TRANSLATIONS = (0, 2, 3, 3, 0, 3, 2, 3)
"""Number of position coordinates of each kind, which precede the rotation."""

SIZES = (1, 3, 6, 6, 0, 7, 2, 3)
"""Number of coordinates of each kind; the ground has none."""

IMAGINARY_STEP = 1e-30

ROUNDING = 1e-12
"""Largest lever in m that counts as a rounding error."""

MOUNT_SIZE = 24

NO_MOUNTS = 0.0

Mounts = float
"""Address (see ``kept``) of place and axes of the contact on master and disc, ``MOUNT_SIZE`` numbers each.

These are two frames, each a position in m and the x, y and z axes. The first is fixed: a rotor turns about its z
axis, and the ground rests in it. The second is the frame of the contact in the axes of the body.
"""

Kinds = tuple[int, int, Mounts]
"""Kinds of the nodes of master and disc, and mounts; ``NO_MOUNTS`` if the contact uses the frames of the nodes.

Rotors and the ground then have the global z axis through the origin.
"""

Floats = Sequence[float]

Array = NDArray[Any]
"""Array of real numbers, or of complex numbers for derivatives."""


Vector = tuple[Any, Any, Any]
"""Components in global axes."""

Axes = tuple[Vector, Vector, Vector]
"""The x, y and z axes of a body."""


@inlined
def slip_and_place(kinds: Kinds, coordinates: Array) -> tuple[Array, Axes, tuple[Any, Any], tuple[Any, Any]]:
    """Return J, shape (3, n), the axes of the contact on the master, and angle and place of the disc in these axes.

    The angle, as cosine and sine, refers to the x axis of the contact on the disc, or to its y axis if its x axis
    lies along the master's z axis. The place is x and y (m) of the contact. ``coordinates``, in m and rad, belong to
    master and disc and include reference values, n in all.
    """
    master, disc, mounts = kinds
    return _slip_and_place(master, disc, mounts, coordinates)


@compiled
def _slip_and_place(
    master: int, disc: int, mounts: Mounts, coordinates: Array
) -> tuple[Array, Axes, tuple[Any, Any], tuple[Any, Any]]:
    size, before, first = SIZES[master], TRANSLATIONS[master], TRANSLATIONS[disc]
    place, axes, turning = frame(master, coordinates, 0)
    disc_place, disc_axes, disc_turning = frame(disc, coordinates, size)
    start, centre = place, disc_place
    if mounts != NO_MOUNTS:
        place, start, axes, turning = _mounted(master, mounts, 0, place, axes, turning)
        disc_place, centre, disc_axes, disc_turning = _mounted(
            disc, mounts, MOUNT_SIZE, disc_place, disc_axes, disc_turning
        )
    result = np.zeros((3, len(coordinates)), coordinates.dtype)
    for i in range(2):
        axis = axes[i]
        lever = _lever(place, centre, axis)  # (ω×d)·e = ω·(d×e)
        for k in range(before):
            result[i, k] = -axis[k]
        for k in range(first):
            result[i, size + k] = axis[k]
        for k in range(size - before):
            result[i, before + k] = -_product(lever, turning[k])
        if mounts != NO_MOUNTS:
            lever = _lever(disc_place, centre, axis)
            for k in range(SIZES[disc] - first):
                result[i, size + first + k] = _product(lever, disc_turning[k])
    for k in range(size - before):
        result[2, before + k] = -_product(axes[2], turning[k])
    for k in range(SIZES[disc] - first):
        result[2, size + first + k] = _product(axes[2], disc_turning[k])
    cosine, sine = _product(disc_axes[0], axes[0]), _product(disc_axes[0], axes[1])
    if abs(cosine * cosine + sine * sine) < 0.5:
        cosine, sine = _product(disc_axes[1], axes[0]), _product(disc_axes[1], axes[1])
    d = (centre[0] - start[0], centre[1] - start[1], centre[2] - start[2])
    return result, axes, (cosine, sine), (_product(d, axes[0]), _product(d, axes[1]))


@compiled
def _mounted(
    kind: int,
    mounts: Mounts,
    mount: int,
    place: Vector,
    axes: Axes,
    turning: tuple[Vector, Vector, Vector, Vector],
) -> tuple[Vector, Vector, Axes, tuple[Vector, Vector, Vector, Vector]]:
    """Return positions of a node and of the contact, the contact's axes, and how ω depends on the rates."""
    if TRANSLATIONS[kind] == 0:  # a rotor or the ground
        fixed = _axes_at(mounts, mount + 3)
        x, y, z = _vector_at(mounts, mount)
        place = (place[0] + x, place[1] + y, place[2] + z)
        axes = (_turned(axes[0], fixed), _turned(axes[1], fixed), _turned(axes[2], fixed))
        turning = (_turned(turning[0], fixed), turning[1], turning[2], turning[3])
    arm = _turned(_vector_at(mounts, mount + 12), axes)
    own = _axes_at(mounts, mount + 15)
    centre = (place[0] + arm[0], place[1] + arm[1], place[2] + arm[2])
    return place, centre, (_turned(own[0], axes), _turned(own[1], axes), _turned(own[2], axes)), turning


@compiled
def _axes_at(mounts: Mounts, at: int) -> Axes:
    return _vector_at(mounts, at), _vector_at(mounts, at + 3), _vector_at(mounts, at + 6)


@compiled
def _vector_at(mounts: Mounts, at: int) -> Vector:
    return number_at(mounts, at), number_at(mounts, at + 1), number_at(mounts, at + 2)


@compiled
def _turned(vector: Vector, axes: Axes) -> Vector:
    a, b, c = vector
    x, y, z = axes
    return a * x[0] + b * y[0] + c * z[0], a * x[1] + b * y[1] + c * z[1], a * x[2] + b * y[2] + c * z[2]


@compiled
def frame(kind: int, q: Array, at: int) -> tuple[Vector, Axes, tuple[Vector, Vector, Vector, Vector]]:
    """Return position and axes of a body with coordinates from ``q[at]`` on, and how ω depends on their rates."""
    zero = 0.0 * q[0]
    one, none = zero + 1.0, (zero, zero, zero)
    place, angle = none, at + TRANSLATIONS[kind]
    if TRANSLATIONS[kind] > 0:
        place = (q[at], q[at + 1], q[at + 2] if TRANSLATIONS[kind] == 3 else zero)
    if kind == ROTATION_VECTOR:
        axes = _rotated_by_vector(q[angle], q[angle + 1], q[angle + 2])
        return place, axes, (axes[0], axes[1], axes[2], none)  # the velocities are ω in the body's axes
    if kind == TAIT_BRYAN:
        (cx, sx), (cy, sy), (cz, sz) = (
            _cosine_and_sine(q[angle]), _cosine_and_sine(q[angle + 1]), _cosine_and_sine(q[angle + 2]),
        )  # fmt: skip
        x = (cy * cz, cx * sz + sx * sy * cz, sx * sz - cx * sy * cz)
        y = (-cy * sz, cx * cz - sx * sy * sz, sx * cz + cx * sy * sz)
        z = (sy, -sx * cy, cx * cy)
        return place, (x, y, z), ((one, zero, zero), (zero, cx, sx), z, none)
    if kind == EULER_PARAMETERS:
        return place, *_rotated_by_euler_parameters(q[angle], q[angle + 1], q[angle + 2], q[angle + 3])
    c, s, turning = one, zero, none
    if SIZES[kind] > TRANSLATIONS[kind]:
        (c, s), turning = _cosine_and_sine(q[angle]), (zero, zero, one)
    return place, ((c, s, zero), (-s, c, zero), (zero, zero, one)), (turning, none, none, none)


@compiled
def _cosine_and_sine(angle: Any) -> tuple[Any, Any]:
    return np.cos(angle), np.sin(angle)


@compiled
def _rotated_by_vector(x: Any, y: Any, z: Any) -> Axes:
    """Return the axes by Rodrigues' formula, 1 + sin(θ)/θ·[v] + (1 − cos(θ))/θ²·[v]²."""
    square = x * x + y * y + z * z
    theta = np.sqrt(square)
    # Half angles avoid cancellation in 1 − cos(θ).
    (cosine_of_half, sine_of_half) = _cosine_and_sine(theta / 2.0)
    half = sine_of_half / theta if theta != 0.0 else theta + 0.5
    linear, quadratic = 2.0 * cosine_of_half * half, 2.0 * half * half
    xy, yz, zx = quadratic * x * y, quadratic * y * z, quadratic * z * x
    x_turned, y_turned, z_turned = linear * x, linear * y, linear * z
    cosine = 1.0 - quadratic * square
    return (
        (cosine + quadratic * x * x, xy + z_turned, zx - y_turned),
        (xy - z_turned, cosine + quadratic * y * y, yz + x_turned),
        (zx + y_turned, yz - x_turned, cosine + quadratic * z * z),
    )


@compiled
def _rotated_by_euler_parameters(
    p: Any, x: Any, y: Any, z: Any
) -> tuple[Axes, tuple[Vector, Vector, Vector, Vector]]:
    """Return the axes and the contribution of each rate to ω = 2·(p·v̇ − ṗ·v + v×v̇), with v = (x, y, z).

    As in Exudyn, both are polynomials in the parameters, whose norm is 1 up to the error of Newton's method.
    """
    pp, xx, yy, zz = p * p, x * x, y * y, z * z
    axes = (
        (pp + xx - yy - zz, 2.0 * (x * y + p * z), 2.0 * (x * z - p * y)),
        (2.0 * (x * y - p * z), pp - xx + yy - zz, 2.0 * (y * z + p * x)),
        (2.0 * (x * z + p * y), 2.0 * (y * z - p * x), pp - xx - yy + zz),
    )
    p, x, y, z = 2.0 * p, 2.0 * x, 2.0 * y, 2.0 * z
    return axes, ((-x, -y, -z), (p, z, -y), (-z, p, x), (y, -x, p))


@compiled
def _lever(start: Vector, end: Vector, axis: Vector) -> Vector:
    """Return (end − start) × axis."""
    x, y, z = end[0] - start[0], end[1] - start[1], end[2] - start[2]
    return y * axis[2] - z * axis[1], z * axis[0] - x * axis[2], x * axis[1] - y * axis[0]


@compiled
def _product(a: Vector, b: Vector) -> Any:
    """Return a·b without complex conjugation."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


slip_and_place_of_nodes = KeptOnDisk(slip_and_place)
