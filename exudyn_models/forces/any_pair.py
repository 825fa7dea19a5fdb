"""Friction on any pair of nodes: generalised forces by the transposed slip Jacobian, and their derivatives."""

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from exudyn_models.forces.friction_laws import (
    CONTACT_SIZE,
    Contact,
    derivatives_by_slip,
    friction_of_slip,
    slip_potential_of_contact,
)
from exudyn_models.forces.jit import LONGEST, KeptOnDisk, as_arrays, compiled
from exudyn_models.forces.slip_kinematics import IMAGINARY_STEP, SIZES, Kinds, slip_and_place
from reference_model.systems import FloatArray

Parameters = FloatArray
"""A ``Contact``, ``Kinds`` and reference coordinates in one table."""

KINDS_AT, REFERENCE_AT = CONTACT_SIZE, CONTACT_SIZE + 3
PLACES_AT = REFERENCE_AT + LONGEST


def parameters_of(contact: Contact, kinds: Kinds, reference: FloatArray) -> Parameters:
    """Return the parameters of a force function; ``reference``, shape (n,), contains the nodes' coordinates.

    The contact contains 1 N if the friction force is not constant.
    """
    return np.array([*contact, *kinds, *reference])


@compiled
def contact_of(table: Parameters) -> tuple[Contact, Kinds]:
    """Return contact and kinds from the table of ``parameters_of``."""
    contact = table[0], int(table[1]), table[2], table[3], int(table[4]), table[5]
    return contact, (int(table[KINDS_AT]), int(table[KINDS_AT + 1]), table[KINDS_AT + 2])


@compiled
def motion_of(table: Parameters, q: Any, q_t: Any) -> tuple[FloatArray, FloatArray]:
    """Return coordinates with reference values, and velocities, in the memory of the lists ``q`` and ``q_t``."""
    size = SIZES[int(table[KINDS_AT])] + SIZES[int(table[KINDS_AT + 1])]
    coordinates, velocities = as_arrays(q, q_t, size)
    for i in range(size):
        coordinates[i] += table[REFERENCE_AT + i]
    return coordinates, velocities


@compiled
def slip_on_any(parameters: Parameters, q: Any, q_t: Any) -> tuple[float, float, float]:
    """Return radius (m), slip speed (m/s) and relative spin (rad/s) for load and coefficient."""
    contact, kinds = contact_of(parameters)
    coordinates, velocities = motion_of(parameters, q, q_t)
    to_slip, _, (cosine, sine), (x, y) = slip_and_place(kinds, coordinates)
    ux, uy, spin = slip_of_nodes(to_slip, velocities)
    speed = slip_potential_of_contact(ux, uy, spin, math.atan2(sine, cosine), contact)
    return math.sqrt(x * x + y * y), speed, spin


@compiled
def locked_slips(
    parameters: Parameters, rim: float, mbs: Any, t: Any, item: Any, q: Any, q_t: Any, level: Any
) -> tuple[float, float, float]:
    """Return the slip (m/s), with ``rim`` (m) times the spin, for a constraint at velocity level."""
    coordinates, velocities = motion_of(parameters, q, q_t)
    ux, uy, spin = slip_of_nodes(slip_and_place(contact_of(parameters)[1], coordinates)[0], velocities)
    return ux, uy, rim * spin


@compiled
def locked_slips_of_pin(
    parameters: Parameters, rim: float, mbs: Any, t: Any, item: Any, q: Any, q_t: Any, level: Any
) -> tuple[float, float]:
    """Return the slip (m/s) for a constraint at velocity level."""
    return locked_slips(parameters, rim, mbs, t, item, q, q_t, level)[:2]


@compiled
def gradients_of_locked_slips(
    parameters: Parameters, rim: float, mbs: Any, t: Any, item: Any, q: Any, q_t: Any, level: Any
) -> FloatArray:
    """Return the derivatives of ``locked_slips``, shape (3, n), or of ``locked_slips_of_pin`` if ``rim`` is zero."""
    coordinates, _ = motion_of(parameters, q, q_t)
    to_slip = slip_and_place(contact_of(parameters)[1], coordinates)[0]
    for k in range(len(coordinates)):
        to_slip[2, k] *= rim
    return to_slip[: 3 if rim > 0.0 else 2]


@compiled
def force_on_any(parameters: Parameters, factor: float, mbs: Any, t: Any, item: Any, q: Any, q_t: Any) -> Any:
    """Return the generalised forces on both nodes, in the memory of ``q_t``, times ``factor``.

    All arguments but the first two are Exudyn's.
    """
    contact, kinds = contact_of(parameters)
    coordinates, velocities = motion_of(parameters, q, q_t)
    to_slip, _, (cosine, sine), _ = slip_and_place(kinds, coordinates)
    ux, uy, spin = slip_of_nodes(to_slip, velocities)
    fx, fy, moment = friction_of_slip(ux, uy, spin, math.atan2(sine, cosine), contact)
    for k in range(len(velocities)):
        velocities[k] = factor * (fx * to_slip[0, k] + fy * to_slip[1, k] + moment * to_slip[2, k])
    return q_t


@compiled
def jacobian_on_any(
    parameters: Parameters,
    factor: float,
    by_radius: float,
    by_speed: float,
    by_spin: float,
    mbs: Any,
    t: Any,
    item: Any,
    q: Any,
    q_t: Any,
    position_factor: float,
    velocity_factor: float,
) -> FloatArray:
    """Return the weighted sum of the derivatives of the negative forces by ``q`` and ``q_t``, shape (n, n).

    The derivatives of ``factor`` with respect to the results of ``slip_on_any`` follow it.
    """
    contact, kinds = contact_of(parameters)
    coordinates, velocities = motion_of(parameters, q, q_t)
    to_slip, _, turned, _ = slip_and_place(kinds, coordinates)
    ux, uy, spin = slip_of_nodes(to_slip, velocities)
    angle = math.atan2(turned[1], turned[0])
    force = friction_of_slip(ux, uy, spin, angle, contact)
    _, _, by_slip = derivatives_by_slip(ux, uy, spin, angle, contact)
    # Friction is −μN·∂P/∂(u, S), times P/ε if viscous; rotating slip and disc together does not change P.
    creep = min(1.0, slip_potential_of_contact(ux, uy, spin, angle, contact) / contact[3])
    slope = -1.0 / (contact[2] * creep) if creep > 0.0 else 0.0
    result, by_motion, forces = derivatives_on_nodes(
        kinds,
        coordinates,
        velocities,
        -position_factor,
        -velocity_factor,
        to_slip,
        turned,
        force,
        by_slip,
        slope,
    )
    for j in range(len(forces)):
        change = by_radius * by_motion[0, j] + by_speed * by_motion[1, j] + by_spin * by_motion[2, j]
        for i in range(len(forces)):
            result[i, j] = factor * result[i, j] + forces[i] * change
    return result


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

    The derivatives by coordinates and by velocities are added with weights: the derivatives of the forces, shape (n,
    n), and of radius (m), P (m/s) and S (rad/s), shape (3, n). ``force`` (F_x, F_y, M) has the derivatives
    ``by_slip``, shape (3, 4), in slip and angle; the gradient of P is ``slope`` times the force.
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
def slip_of_nodes(to_slip: FloatArray, velocities: FloatArray) -> tuple[float, float, float]:
    """Return their product, faster than a library for such small arrays."""
    ux = uy = spin = 0.0
    for k in range(len(velocities)):
        ux += to_slip[0, k] * velocities[k]
        uy += to_slip[1, k] * velocities[k]
        spin += to_slip[2, k] * velocities[k]
    return ux, uy, spin


@compiled
def slip_in_step(
    kinds: Kinds,
    contact: Contact,
    start: FloatArray,
    rates: FloatArray,
    end: FloatArray,
    end_rates: FloatArray,
) -> tuple[float, float, float, float, float]:
    """Return P (m/s) at both ends of a step and P of the change in between, and S and radius at the end."""
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


@compiled
def losses_on_any(tables: FloatArray, q: FloatArray, q_t: FloatArray) -> FloatArray:
    """Return for each contact its lost power (W) and the results of ``slip_on_any``, shape (k, 4).

    ``tables`` are those of ``tables_of``; ``q`` and ``q_t`` of the model exclude reference values.
    """
    result = np.empty((len(tables), 4))
    for i in range(len(tables)):
        contact, kinds = contact_of(tables[i])
        size = SIZES[kinds[0]] + SIZES[kinds[1]]
        coordinates, velocities = np.empty(size), np.empty(size)
        for k in range(size):
            place = int(tables[i, PLACES_AT + k])
            coordinates[k] = tables[i, REFERENCE_AT + k] + q[place]
            velocities[k] = q_t[place]
        to_slip, _, (cosine, sine), (x, y) = slip_and_place(kinds, coordinates)
        ux, uy, spin = slip_of_nodes(to_slip, velocities)
        angle = math.atan2(sine, cosine)
        fx, fy, moment = friction_of_slip(ux, uy, spin, angle, contact)
        result[i, 0] = -(fx * ux + fy * uy + moment * spin)
        result[i, 1] = math.sqrt(x * x + y * y)
        result[i, 2] = slip_potential_of_contact(ux, uy, spin, angle, contact)
        result[i, 3] = spin
    return result


def tables_of(parameters: Sequence[Parameters], places: Sequence[Sequence[int]]) -> FloatArray:
    """Return parameters of contacts, and the places of their coordinates in the model, as rows of one array."""
    tables = np.zeros((len(parameters), PLACES_AT + LONGEST))
    for table, row, own in zip(tables, parameters, places, strict=True):
        table[: len(row)] = row
        table[PLACES_AT : PLACES_AT + len(own)] = own
    return tables


change_of_slip = KeptOnDisk(slip_in_step)
