"""Simulation of one trajectory, interpreted or compiled."""

from numpy.typing import ArrayLike

from reference_model.contact.contact_law import Contact, contact_of
from reference_model.core.run import follow
from reference_model.core.single import compiled_core, is_compilable, is_compiled, simulate_by
from reference_model.formulas.joint import simulate_joint
from reference_model.systems import (
    PinOnDisc,
    checked_state,
    checked_times,
    checked_tolerance,
    require_flag,
)
from reference_model.systems.joint import AnySystem, FrictionJoint
from reference_model.trajectory import Trajectory

COMPILATION = 30.0
"""Time in s that the interpreted runs of a process may take until it compiles, about as long as that takes."""

_interpreted = 0.0


def prepare() -> None:
    """Compile now, unless this machine has the compiled code; call this before many simulations."""
    if not is_compiled():
        pin = PinOnDisc(mass=1.0, stiffness=1.0, damping=0.0, friction_force=0.0, disc_speed=0.0)
        simulate(pin, [0.0] * pin.state_size, [0.0], compiled=True)


def simulate(
    system: AnySystem,
    initial_state: ArrayLike,
    times: ArrayLike,
    *,
    tolerance: float = 1e-9,
    contact: Contact | None = None,
    compiled: bool | None = None,
) -> Trajectory:
    """Return the motion of a pin, a disc or a joint under exact Coulomb friction (eq. 1 and 6, eq. 19 to 21).

    Raises ``ValueError`` if an argument is invalid or compiled code does not support the contact, and
    ``SimulationError`` if the integrator fails.

    Parameters
    ----------
    system
        Parameters.
    initial_state : array-like of shape (4,) or (6,)
        State at ``times[0]``: x, y in m and vx, vy in m/s for a pin; x, y, angle in rad, vx, vy and spin in rad/s
        for a disc; angle and spin for a joint. A state that turns with the master disc sticks if friction can hold
        it.
    times : array-like of shape (n,)
        Increasing times in s.
    tolerance
        Target relative accuracy, from 1e-14 to 1e-2, of the angle in rad and of lengths and velocities in
        :class:`reference_model.core.units.Units`. With damping or rest, errors in random motions stay within 13
        tolerances. Otherwise they accumulate, to some 40 times after 10,000 steps.
    contact
        Friction law of a disc; None for the law of the parameters.
    compiled
        Whether to use compiled code. The result is the same, and the first call on a machine compiles. The code
        supports pins, rings, contact points and annuli under uniform pressure. None: use it if this machine has it,
        or if runs of this process in Python have taken as long as compiling would.

    """
    global _interpreted
    if compiled is not None:
        require_flag("compiled", compiled)
    if isinstance(system, FrictionJoint):
        if contact is not None:
            raise ValueError(f"contact = {contact}: a joint has no contact law; omit it")
        return simulate_joint(system, initial_state, times, tolerance)
    start, moments = checked_state(system, initial_state), checked_times(times)
    tolerance = checked_tolerance(tolerance)
    law = contact_of(system, contact)
    if compiled and not is_compilable(law):
        raise ValueError(
            f"contact = {contact}: compiled code supports a Ring, Points, and an Annulus under uniform pressure that "
            "is not very thin; omit compiled=True"
        )
    avoidable = compiled is None and is_compilable(law)
    if compiled or (avoidable and (_interpreted > COMPILATION or is_compiled())):
        return simulate_by(compiled_core(), system, law, start, moments, tolerance)
    trajectory = simulate_by(follow, system, law, start, moments, tolerance)
    if avoidable:
        _interpreted += trajectory.solution.wall_time
    return trajectory
