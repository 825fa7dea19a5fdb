"""Simulation of one trajectory, in NumPy or by compiled code."""

from numpy.typing import ArrayLike

from reference_model.contact.contact_law import Contact
from reference_model.motion.exact import simulate_with
from reference_model.motion.stepper import Thresholds
from reference_model.systems import System, require_flag
from reference_model.trajectory import Trajectory


def simulate(
    system: System,
    initial_state: ArrayLike,
    times: ArrayLike,
    *,
    tolerance: float = 1e-9,
    contact: Contact | None = None,
    compiled: bool | None = False,
) -> Trajectory:
    """Return the motion of a pin or a disc under exact Coulomb friction (eq. 1 and 6, eq. 19 to 21).

    Raises ``ValueError`` if an argument is invalid or compiled code does not support the contact, and
    ``SimulationError`` if the integrator fails.

    Parameters
    ----------
    system
        Parameters.
    initial_state : array-like of shape (4,) or (6,)
        State at ``times[0]``: x, y in m and vx, vy in m/s for a pin; x, y, angle in rad, vx, vy and spin in rad/s
        for a disc. A state that turns with the master disc sticks if friction can hold it.
    times : array-like of shape (n,)
        Increasing times in s.
    tolerance
        Target relative accuracy, from 1e-14 to 1e-2, of the angle in rad and of lengths and velocities in
        :class:`motion.nondimensional.Units`. With damping or rest, errors in random motions stay within 13
        tolerances. Otherwise they accumulate, to some 40 times after 10,000 steps.
    contact
        Friction law of a disc; None for the law of the parameters.
    compiled
        Whether to use compiled code; the first call on a machine compiles it. It supports pins, rings, contact
        points and annuli under uniform pressure. None: use it if ``contact`` is None.

    """
    if compiled is not None:
        require_flag("compiled", compiled)
    if not (contact is None if compiled is None else compiled):
        return simulate_with(Thresholds(), system, initial_state, times, tolerance=tolerance, contact=contact)
    # Imported here so that simulations in NumPy start without the compiler.
    from reference_model.core.single import simulate_compiled

    return simulate_compiled(system, initial_state, times, tolerance=tolerance, contact=contact)
