"""Exudyn's own sphere–triangle contact with friction in place of the user function: an independent witness.

Spheres on the disc press on one triangle that turns with the master disc. Bodies of the plane keep their height, so
that the penetration, and with it the normal force, is constant. Exudyn's friction is −μN·v/max(|v|, ε) for the slip v
of the touching points, with the force and moment on both bodies that follow from it: the law of ``add_ring_friction``
for points, in code that is not ours.
"""

from __future__ import annotations

import cmath
import math
from dataclasses import replace
from functools import partial
from typing import Any

import exudyn as exu
import exudyn.itemInterface
import numpy as np
from numpy.typing import ArrayLike

from exudyn_models.forces.friction_laws import CONTINUOUS, point_regularisation
from exudyn_models.forces.load_and_coefficient import checked_not_negative
from exudyn_models.forces.slip_kinematics import PLANAR, ROTOR
from exudyn_models.paper.alternating_solvers import Friction, Part
from exudyn_models.paper.creep import WHOLE, creep_ratios, creeping
from exudyn_models.paper.nondimensional import Units
from exudyn_models.paper.scales import support_energy
from exudyn_models.paper.simulate import simulate
from exudyn_models.parts.ring_friction import checked_contact, checked_kind
from reference_model.systems import (
    DiscOnDisc,
    FloatArray,
    System,
    checked_state,
    checked_times,
    finite_number,
)
from reference_model.trajectory import Trajectory

items: Any = exudyn.itemInterface  # its type hints do not fit its own calls

NORMAL_FORCE = 1.0
"""N of all points together, in N. The discs feel the product μN only, so that μ is what makes it the one asked for.

Rounding tilts the normal by some 1e-15, by which N pushes sideways: it stays small where friction is large, as in the
model of a creeping disc.
"""


def simulate_with_native_contact(
    system: System, initial_state: ArrayLike, times: ArrayLike, *, tolerance: float = 1e-9
) -> Trajectory:
    """Return the motion as ``simulate`` does, with the built-in contact of a pin or of a disc on points.

    Steps, ε and errors follow ``tolerance`` in the same way, but for one: a disc on points that friction holds no
    longer lets go gently, like t², and its stick phase ends when its slip reaches ε, late by some √ε.

    Raises as ``simulate`` does, and ``ValueError`` for a disc on the continuous ring, ``contact_points`` = None.
    """
    state = checked_state(system, initial_state)
    grid = checked_times(times)
    # Friction is added in the units of the motion.
    reach = _reach(system, state, float(grid[-1] - grid[0])) / Units.of(system, state).length
    friction = Friction(partial(_add_friction, reach=reach), _creeping)
    trajectory = simulate(system, state, grid, tolerance=tolerance, friction=friction)
    solution = replace(trajectory.solution, method=f"{trajectory.solution.method}, built-in contact")
    return replace(trajectory, solution=solution)


def _creeping(system: System, state: list[float], epsilon: float) -> Part | None:
    """Return ``WHOLE`` if all points slip with less than δ, else the numbers of those that do, or None.

    A disc that is hardly held any more creeps with some of its points faster than that, under Coulomb friction.
    """
    part = creeping(system, state, epsilon)
    if part is None or not isinstance(system, DiscOnDisc):
        return part
    slow = np.flatnonzero(creep_ratios(system, np.array([state]), epsilon)[0, 1:] < 1.0)
    return WHOLE if len(slow) == system.contact_points else frozenset(slow.tolist()) or None


def _add_friction(
    mbs: Any,
    master_node: Any,
    disc_node: Any,
    *,
    regularisation: float,
    held: Part | None = None,
    **contact: Any,
) -> Any:
    """Add friction of which each point is viscous below δ, as in the law of ``add_ring_friction`` with ε.

    Points that are ``held`` stay viscous all the same: Exudyn keeps to one branch of the law within a step.
    """
    delta = point_regularisation(regularisation, contact.get("contact_points") or 1)
    return add_native_friction(mbs, master_node, disc_node, regularisation=delta, **contact)


def _reach(system: System, state: FloatArray, span: float) -> float:
    """Return a distance in m > 0 from the master's axis that no contact point exceeds within ``span`` (s).

    Friction can raise w of the energy m·w²/2 of centre and support by no more than μN/m a second, and all else only
    lowers it. So |v| <= w takes the centre no further than w·span, and the spring stretches to no more than w/k.
    """
    k = system.natural_frequency
    w = math.sqrt(2.0 * support_energy(system, state) / system.mass)
    w += system.friction_force / system.mass * span
    reach = math.hypot(*state[:2]) + w * span
    if k > 0.0:
        reach = min(reach, abs(system.offset) + w / k)
    if isinstance(system, DiscOnDisc):
        reach += system.contact_radius
    return 1.01 * reach or 1.0  # a pin that can not move needs a triangle all the same


def add_native_friction(
    mbs: Any,
    master_node: Any,
    disc_node: Any,
    *,
    contact_radius: float,
    friction_coefficient: float,
    normal_load: float,
    regularisation: float,
    contact_points: int | None = None,
    reach: float,
) -> list[Any]:
    """Add friction as ``add_ring_friction`` does, by one built-in contact a point; return their ``ObjectIndex``.

    Sizes perpendicular to the plane are free. They are those of the triangle, because the normal is tilted by
    rounding like size over penetration. What is left of rounding is a slip of 1e-15 times spin times ``reach``.

    Parameters
    ----------
    mbs : exudyn MainSystem
        Not yet assembled, with both nodes and their bodies.
    master_node, disc_node : NodeIndex
        A rotor's or a planar body's, and a planar body's.
    contact_radius : float
        R in m, >= 0; the contact is a pin if it is 0.
    friction_coefficient : float
        μ >= 0. Only its product with N counts.
    normal_load : float
        N in N of all points together, >= 0.
    regularisation : float
        ε in m/s, > 0.
    contact_points : int
        n >= 1. There is no built-in contact of a whole circle.
    reach : float
        In m, > 0. A point further away than that from the master's node may leave the triangle.

    Raises
    ------
    ValueError
        If a number is out of its range or a node is of a kind that can't be used.

    """
    radius, points, epsilon = checked_contact(regularisation, contact_radius, contact_points)
    friction = checked_not_negative("friction_coefficient", friction_coefficient, "") * checked_not_negative(
        "normal_load", normal_load, " N"
    )
    if points == CONTINUOUS:
        raise ValueError(
            f"contact_points = {contact_points}: Exudyn's built-in contact has single points only; it must be a "
            "whole number, for instance 6"
        )
    reach = finite_number("reach", reach)
    if reach <= 0.0:
        raise ValueError(f"reach = {reach:g} m: it must be > 0")
    checked_kind("master_node", mbs, master_node, (ROTOR, PLANAR))
    checked_kind("disc_node", mbs, disc_node, (PLANAR,))
    size = 2.0 * reach  # from the middle to a corner; the circle that fits in has half of that
    penetration = size / 2.0
    height = penetration - size
    vectors: Any = exu.Vector3DList  # as of items
    triangle = vectors([[*_plane(cmath.rect(size, math.tau * i / 3)), height] for i in range(3)])
    master_marker = _marker(mbs, master_node, 0j)
    contacts = []
    for i in range(points):
        arm = cmath.rect(radius, math.tau * i / points)
        # Within a step Exudyn keeps to one branch of the law, in the first step that of the slip speed given here.
        data = mbs.AddNode(
            items.NodeGenericData(
                initialCoordinates=[
                    -penetration,
                    _initial_slip_speed(mbs, master_node, disc_node, arm),
                    0.0,
                    0.0,
                ],
                numberOfDataCoordinates=4,
            )
        )
        contacts.append(
            mbs.AddObject(
                items.ObjectContactSphereTriangle(
                    markerNumbers=[_marker(mbs, disc_node, arm), master_marker],
                    nodeNumber=data,
                    sphereRadius=size,
                    trianglePoints=triangle,
                    includeEdges=0,
                    dynamicFriction=friction / NORMAL_FORCE,
                    frictionProportionalZone=epsilon,
                    contactStiffness=NORMAL_FORCE / points / penetration,
                )
            )
        )
    return contacts


def _plane(vector: complex) -> tuple[float, float]:
    return vector.real, vector.imag


def _marker(mbs: Any, node: Any, arm: complex) -> Any:
    """Add a marker at ``arm`` (m) of the body to which ``node`` belongs; return its ``MarkerIndex``."""
    numbers = range(mbs.systemData.NumberOfObjects())
    body = next(i for i in numbers if int(mbs.GetObject(i).get("nodeNumber", -1)) == int(node))
    return mbs.AddMarker(items.MarkerBodyRigid(bodyNumber=body, localPosition=[*_plane(arm), 0.0]))


def _initial_slip_speed(mbs: Any, master_node: Any, disc_node: Any, arm: complex) -> float:
    """Return the speed in m/s with which the point at ``arm`` of the disc slips over the master at the start."""
    master, _, master_velocity, master_spin = _initial_motion(mbs, master_node)
    disc, angle, disc_velocity, disc_spin = _initial_motion(mbs, disc_node)
    arm *= cmath.exp(1j * angle)
    velocity = disc_velocity + 1j * disc_spin * arm
    return abs(velocity - master_velocity - 1j * master_spin * (disc + arm - master))


def _initial_motion(mbs: Any, node: Any) -> tuple[complex, float, complex, float]:
    """Return position (m), angle (rad), velocity (m/s) and spin (rad/s) of the node of a disc or a rotor."""
    reference, initial, rates = (
        mbs.GetNodeParameter(node, name).tolist()
        for name in ("referenceCoordinates", "initialCoordinates", "initialVelocities")
    )
    *place, angle = (a + b for a, b in zip(reference, initial, strict=True))
    *velocity, spin = rates
    return (complex(*place), angle, complex(*velocity), spin)
