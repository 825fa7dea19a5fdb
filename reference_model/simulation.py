"""The door to a simulation: plain, or compiled where speed matters."""

from __future__ import annotations

from numpy.typing import ArrayLike

from reference_model.contact.contact_law import Contact
from reference_model.motion.exact import simulate_with
from reference_model.motion.stepper import Thresholds
from reference_model.systems import System
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

    Parameters
    ----------
    system : PinOnDisc or DiscOnDisc
        The parameters.
    initial_state : array-like of shape (4,) or (6,)
        At ``times[0]``: of a pin x, y in m and vx, vy in m/s; of a disc x, y, angle in rad, vx, vy and the spin in
        rad/s. A state that turns with the master disc starts stuck if friction can hold it.
    times : array-like of shape (n,)
        Increasing, in s.
    tolerance : float
        Relative accuracy to aim at, from 1e-14 to 1e-2: of places as a share of a length L, of velocities, and of the
        spin times the radius of gyration, as a share of L/T, of the angle in rad. T is 1/ω or that of the springs,
        whichever is less; L the largest of X0 and, at the start, distance from the axis, speed times T and friction
        over mass times T² (:class:`motion.nondimensional.Units`). It is meant at all times alike, at ends of steps
        and between them. A step may err by a twentieth of it. A motion that forgets, by damping or by rest, keeps to
        it but for a small factor, by which the errors of steps add up until they are forgotten: of random ones the
        worst had 13, compiled 68, a pin on a disc 45 times as fast as its swings, which forgets in a thousand steps.
        In one that does not forget, errors add up: to some 40 times the tolerance after 10,000 steps. What parts by
        itself parts by that growth.
    contact : Contact or None
        The law of friction of a disc if it is not that of its parameters.
    compiled : bool or None
        Whether the compiled kernel of :mod:`ensemble` is to do it, where speed matters. It is another implementation
        of the same physics, for linear supports and the laws of the parameters; the first run of a kind of contact
        on a machine waits for the compiler. None: wherever it can.

    Returns
    -------
    Trajectory

    Raises
    ------
    ValueError
        For a state, times, tolerance or contact that are not as above, or a system that compiled code does not know.
    SimulationError
        If the integrator gives up.

    """
    if compiled is None:
        from reference_model.ensemble.simulate import is_known

        compiled = contact is None and is_known(system)
    if compiled:
        # Here, since the plain one is to start without the compiler.
        from reference_model.ensemble.single_run import simulate_compiled

        return simulate_compiled(system, initial_state, times, tolerance=tolerance, contact=contact)
    return simulate_with(Thresholds(), system, initial_state, times, tolerance=tolerance, contact=contact)
