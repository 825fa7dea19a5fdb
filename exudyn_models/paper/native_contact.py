"""The paper's pin and disc with Exudyn's own contact: the same motion by independent code."""

from __future__ import annotations

import math
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from exudyn_models.forces.laws.places import point_regularisation
from exudyn_models.paper.alternating_solvers import Friction, Part
from exudyn_models.paper.creep import WHOLE, RegularisedContact
from exudyn_models.paper.joint import simulate_joint
from exudyn_models.paper.scales import support_energy
from exudyn_models.paper.simulate import METHODS, Run
from exudyn_models.parts.native_contact import add_native_friction
from exudyn_models.parts.ring_friction import checked_contact
from reference_model.systems import (
    DiscOnDisc,
    FloatArray,
    System,
    checked_state,
    checked_times,
    checked_tolerance,
)
from reference_model.systems.joint import AnySystem, FrictionJoint
from reference_model.trajectory import Trajectory


def simulate_with_native_contact(
    system: AnySystem, initial_state: ArrayLike, times: ArrayLike, *, tolerance: float = 1e-9
) -> Trajectory:
    """Return the motion like ``simulate``, with Exudyn's built-in contact of a pin or of a disc on points.

    A joint has Exudyn's built-in friction of a coordinate, see ``simulate_joint``.

    A stick phase ends when the slip reaches ε. After release the slip of a disc on points grows like t², so the phase
    ends about √ε late. Raises as ``simulate``, and ``ValueError`` for a disc on the continuous ring.
    """
    if isinstance(system, FrictionJoint):
        return simulate_joint(system, initial_state, times, tolerance=tolerance, native=True)
    state = checked_state(system, initial_state)
    grid = checked_times(times)
    run = Run.of(system, state, grid, checked_tolerance(tolerance), None)
    reach = _reach(system, state, float(grid[-1] - grid[0])) / run.units.length
    friction = Friction(partial(_add_friction, reach=reach), _creeping)
    return run.trajectory(f"{METHODS['explicit']}, built-in contact", run.explicit(), friction)


def _creeping(contact: RegularisedContact, state: list[float]) -> Part | None:
    """Return the indices of the points that slip slower than δ, ``WHOLE`` if all do, or None."""
    part, system = contact.creeping(state), contact.system
    if part is None or not isinstance(system, DiscOnDisc):
        return part
    slow = np.flatnonzero(contact.slip_ratios(np.array([state]))[0, 1:] < 1.0)
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
    """Add friction whose points are viscous below δ, as in the law of ``add_ring_friction`` with ε.

    Exudyn keeps to one branch of the law within a step, so ``held`` makes no difference.
    """
    _, places, _ = checked_contact(
        regularisation, contact["contact_radius"], contact.get("contact_points") or 1
    )
    delta = point_regularisation(regularisation, places or ())
    return add_native_friction(mbs, master_node, disc_node, regularisation=delta, **contact)


def _reach(system: System, state: FloatArray, span: float) -> float:
    """Return a distance in m > 0 from the master's axis that no contact point exceeds within ``span`` (s).

    The energy of centre and support is m·w²/2. Friction can increase w by at most μN/m per second, and everything
    else decreases it. So |v| <= w moves the centre by at most w·span, and stretches the spring by at most w/k.
    """
    k = system.natural_frequency
    w = math.sqrt(2.0 * support_energy(system, state) / system.mass)
    w += system.friction_force / system.mass * span
    reach = math.hypot(*state[:2]) + w * span
    if k > 0.0:
        reach = min(reach, abs(system.offset) + w / k)
    if isinstance(system, DiscOnDisc):
        reach += system.contact_radius
    return 1.01 * reach or 1.0  # a pin that cannot move also needs a triangle
