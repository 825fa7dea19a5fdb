"""Friction on any pair of nodes: generalised forces by the transposed slip Jacobian, and their derivatives."""

from __future__ import annotations

import math
from typing import Any

import numba.np.unsafe.ndarray
import numpy as np

from exudyn_models.forces.friction_laws import (
    CONTACT_SIZE,
    Contact,
    contact_of,
    derivatives_by_slip,
    friction_of_slip,
    slip_potential_of_contact,
)
from exudyn_models.forces.jit import KeptOnDisk, compiled
from exudyn_models.forces.laws.product import Law, friction_force_under
from exudyn_models.forces.slip_kinematics import (
    IMAGINARY_STEP,
    MOUNTS_SIZE,
    Floats,
    Kinds,
    Mounts,
    slip_and_place,
)
from reference_model.systems import FloatArray

to_tuple: Any = numba.np.unsafe.ndarray.to_fixed_tuple  # unsafe for a shorter array


@compiled
def friction_derivatives_on_nodes(
    kinds: Kinds,
    coordinates: FloatArray,
    velocities: FloatArray,
    position_factor: float,
    velocity_factor: float,
    contact: Contact,
) -> tuple[FloatArray, FloatArray, tuple[FloatArray, float, float, float]]:
    """Return the derivatives of the generalised forces, shape (n, n), and of radius, P and S, shape (3, n).

    They are weighted sums of the derivatives by coordinates and by velocities. Also returns the generalised forces,
    shape (n,), the disc's radius in m, P in m/s and S in rad/s.
    """
    to_slip, _, turned, (x, y) = slip_and_place(kinds, coordinates)
    ux, uy, spin = slip_of_nodes(to_slip, velocities)
    angle = math.atan2(turned[1], turned[0])
    force = friction_of_slip(ux, uy, spin, angle, contact)
    _, _, by_slip = derivatives_by_slip(ux, uy, spin, angle, contact)
    # Friction is −μN·∂P/∂(u, S), times P/ε if viscous; rotating slip and disc together does not change P.
    speed = slip_potential_of_contact(ux, uy, spin, angle, contact)
    creep = min(1.0, speed / contact[3])
    slope = -1.0 / (contact[2] * creep) if creep > 0.0 else 0.0
    by_nodes, motion_by_nodes, forces = derivatives_on_nodes(
        kinds,
        coordinates,
        velocities,
        position_factor,
        velocity_factor,
        to_slip,
        turned,
        force,
        by_slip,
        slope,
    )
    return by_nodes, motion_by_nodes, (forces, math.sqrt(x * x + y * y), speed, spin)


@compiled
def derivatives_on_nodes(
    kinds: Kinds,
    coordinates: FloatArray,
    velocities: FloatArray,
    position_factor: float,
    velocity_factor: float,
    to_slip: FloatArray,
    turned: tuple[float, float],
    force: tuple[float, float, float],
    by_slip: FloatArray,
    slope: float,
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return derivatives on the nodes of friction given as a function of the slip, and the forces on the nodes.

    The first results are those of ``friction_derivatives_on_nodes``. ``force`` (F_x, F_y, M) has the derivatives
    ``by_slip``, shape (3, 4), by slip and angle; the gradient of P is ``slope`` times the force.
    """
    cosine, sine = turned
    ux, uy, _ = slip_of_nodes(to_slip, velocities)
    size = len(coordinates)
    by_nodes, motion_by_nodes = np.zeros((size, size)), np.zeros((3, size))
    map_change, slip_change = np.zeros((3, size)), np.zeros(3)
    for j in range(size):
        stepped = coordinates.astype(np.complex128)
        stepped[j] += 1j * IMAGINARY_STEP
        stepped_map, _, (stepped_cosine, stepped_sine), (stepped_x, stepped_y) = slip_and_place(
            kinds, stepped
        )
        stepped_radius = np.sqrt(stepped_x * stepped_x + stepped_y * stepped_y)
        motion_by_nodes[0, j] = position_factor * stepped_radius.imag / IMAGINARY_STEP
        turn = cosine * stepped_sine.imag - sine * stepped_cosine.imag
        turn *= position_factor / IMAGINARY_STEP / (cosine * cosine + sine * sine)
        for i in range(3):
            slip_change[i] = velocity_factor * to_slip[i, j]
            for k in range(size):
                map_change[i, k] = position_factor * stepped_map[i, k].imag / IMAGINARY_STEP
                slip_change[i] += map_change[i, k] * velocities[k]
        for i in range(3):
            force_change = by_slip[i, 3] * turn
            for k in range(3):
                force_change += by_slip[i, k] * slip_change[k]
            for k in range(size):
                by_nodes[k, j] += force[i] * map_change[i, k] + force_change * to_slip[i, k]
            motion_by_nodes[1, j] += slope * force[i] * slip_change[i]
        motion_by_nodes[2, j] = slip_change[2]
        motion_by_nodes[1, j] -= slope * (force[1] * ux - force[0] * uy) * turn
    forces = np.zeros(size)
    for k in range(size):
        for i in range(3):
            forces[k] += force[i] * to_slip[i, k]
    return by_nodes, motion_by_nodes, forces


@compiled
def force_on_any(
    parameters: Floats, law: Law | None, mbs: Any, t: float, item: int, q: Floats, q_t: Floats
) -> Floats:
    """Return the generalised forces on both nodes.

    ``parameters`` are the numbers of ``Contact``, both kinds and the reference coordinates of both nodes. ``law``
    gives a friction force that is not constant; the contact then contains 1 N. The other arguments are Exudyn's.
    """
    result: Floats = to_tuple(_forces(parameters, None, law, t, q, q_t), len(q))
    return result


@compiled
def force_on_mounted(
    parameters: Floats, law: Law | None, mbs: Any, t: float, item: int, q: Floats, q_t: Floats
) -> Floats:
    """Return the same for a contact with ``Mounts``, whose numbers precede all other ``parameters``."""
    forces = _forces(parameters[MOUNTS_SIZE:], parameters[:MOUNTS_SIZE], law, t, q, q_t)
    result: Floats = to_tuple(forces, len(q))
    return result


@compiled
def _forces(
    parameters: Floats, mounts: Mounts | None, law: Law | None, t: float, q: Floats, q_t: Floats
) -> FloatArray:
    contact, kinds, coordinates, velocities = _state(parameters, mounts, q, q_t)
    to_slip, _, (cosine, sine), (x, y) = slip_and_place(kinds, coordinates)
    ux, uy, spin = slip_of_nodes(to_slip, velocities)
    angle = math.atan2(sine, cosine)
    fx, fy, moment = friction_of_slip(ux, uy, spin, angle, contact)
    if law is not None:
        radius = math.sqrt(x * x + y * y)
        speed = slip_potential_of_contact(ux, uy, spin, angle, contact)
        friction = friction_force_under(law, contact[3], t, radius, speed, spin)
        fx, fy, moment = friction * fx, friction * fy, friction * moment
    for k in range(len(q)):
        velocities[k] = fx * to_slip[0, k] + fy * to_slip[1, k] + moment * to_slip[2, k]
    return velocities


@compiled
def slip_of_nodes(to_slip: FloatArray, velocities: FloatArray) -> tuple[float, float, float]:
    """Return their product, faster than a library for such small arrays."""
    ux = uy = spin = 0.0
    for k in range(len(velocities)):
        ux += to_slip[0, k] * velocities[k]
        uy += to_slip[1, k] * velocities[k]
        spin += to_slip[2, k] * velocities[k]
    return ux, uy, spin


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
    """Return the derivatives of the negative forces, shape (n, n)."""
    contact, kinds, coordinates, velocities = _state(parameters, None, q, q_t)
    return friction_derivatives_on_nodes(
        kinds, coordinates, velocities, -position_factor, -velocity_factor, contact
    )[0]


@compiled
def jacobian_on_mounted(
    parameters: Floats,
    mbs: Any,
    t: float,
    item: int,
    q: Floats,
    q_t: Floats,
    position_factor: float,
    velocity_factor: float,
) -> FloatArray:
    """Return the same for a contact with ``Mounts``, whose numbers precede all other ``parameters``."""
    rest, mounts = parameters[MOUNTS_SIZE:], parameters[:MOUNTS_SIZE]
    contact, kinds, coordinates, velocities = _state(rest, mounts, q, q_t)
    return friction_derivatives_on_nodes(
        kinds, coordinates, velocities, -position_factor, -velocity_factor, contact
    )[0]


@compiled
def _state(
    parameters: Floats, mounts: Mounts | None, q: Floats, q_t: Floats
) -> tuple[Contact, Kinds, FloatArray, FloatArray]:
    contact, kinds = contact_of(parameters)
    coordinates, velocities = np.empty(len(q)), np.empty(len(q))
    for i in range(len(q)):
        coordinates[i] = parameters[CONTACT_SIZE + 2 + i] + q[i]
        velocities[i] = q_t[i]
    return contact, (int(kinds[0]), int(kinds[1]), mounts), coordinates, velocities


@compiled
def slip_in_step(
    kinds: Kinds,
    contact: Contact,
    start: FloatArray,
    rates: FloatArray,
    end: FloatArray,
    end_rates: FloatArray,
) -> tuple[float, float, float, float, float]:
    """Return P (m/s) at both ends of a step and of the change in between, and S and radius at the end."""
    to_slip, _, (cosine, sine), (x, y) = slip_and_place(kinds, end)
    angle = math.atan2(sine, cosine)
    ux, uy, spin = slip_of_nodes(to_slip, end_rates)
    vx, vy, before = slip_of_nodes(slip_and_place(kinds, start)[0], rates)
    return (
        slip_potential_of_contact(vx, vy, before, angle, contact),
        slip_potential_of_contact(ux, uy, spin, angle, contact),
        slip_potential_of_contact(ux - vx, uy - vy, spin - before, angle, contact),
        spin,
        math.sqrt(x * x + y * y),
    )


change_of_slip = KeptOnDisk(slip_in_step)
