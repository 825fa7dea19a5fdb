"""Event-driven simulation of pin and disc with set-valued Coulomb friction.

- Fast slip is integrated directly, slow slip in slip-polar coordinates, and stiff slip implicitly
  (:mod:`.slip.slide`). Slip that decays forever ends in closed form (:mod:`.bodies`).
- In stick, the body turns with the master disc up to the first root of eq. 7 (:mod:`.stick`).
- The slip of a pin begins with a series (:func:`.stick.slip_from_rest`), that of a disc by collocation
  (:mod:`.slip.breakaway`).
- A disc on single points may also pivot about a resting point (:mod:`.disc_on_points`).
"""

from __future__ import annotations

import math
import time

import numpy as np
from numpy.typing import ArrayLike

from reference_model.contact.contact_law import Contact, IsotropicContact, Pin, contact_of
from reference_model.contact.points import Points
from reference_model.motion.bodies import Body, PinBody, RingBody
from reference_model.motion.disc_equations import DiscMotion
from reference_model.motion.disc_on_points import PointsBody
from reference_model.motion.frame import Frame
from reference_model.motion.nondimensional import Units
from reference_model.motion.pin_equations import SlipMotion
from reference_model.motion.stepper import Run, Thresholds
from reference_model.systems import (
    PinOnDisc,
    System,
    checked_state,
    checked_times,
    checked_tolerance,
)
from reference_model.trajectory import SimulationError, Solution, Trajectory, phases_of

METHOD = (
    "DOP853 in slip phases with slip-polar coordinates near rest, Radau where stiff; closed-form stick phases"
)


def simulate_with(
    thresholds: Thresholds,
    system: System,
    initial_state: ArrayLike,
    times: ArrayLike,
    *,
    tolerance: float = 1e-9,
    contact: Contact | None = None,
    slipping: float = math.inf,
) -> Trajectory:
    """Simulate like :func:`reference_model.simulate`, with explicit thresholds.

    The motion ends early if a slip phase has lasted ``slipping`` s.
    """
    clock = time.perf_counter()
    state = checked_state(system, initial_state)
    moments = checked_times(times)
    tolerance = checked_tolerance(tolerance)
    law = contact_of(system, contact)
    unit = Units.of(system, state)
    run = Run(
        (moments - moments[0]) / unit.time,
        system.state_size,
        lambda t: float(moments[0] + t * unit.time),
        thresholds,
        tolerance,
        unit.springs(system),
        slipping / unit.time,
    )
    frame = Frame.of(system, unit)
    end, y = _body(run, system, law, unit).go(frame.unknowns(state))

    motion = run.motion
    if run.recorded < len(moments):
        moments = np.append(moments[: run.recorded], run.seconds(end))
        motion = np.vstack((motion[: run.recorded], y))
    states = frame.states(motion)
    states[0] = state
    if not np.all(np.isfinite(states)):
        raise SimulationError(
            f"the states are not finite after t = {moments[np.argmin(np.isfinite(states).all(axis=1))]:g} s: "
            "the parameters differ by too many orders of magnitude"
        )
    begun = [(kind, run.seconds(t), frame.states(y)) for kind, t, y in run.phases]
    solution = Solution(
        method=METHOD,
        tolerance=tolerance,
        evaluations=run.evaluations,
        steps=run.steps,
        wall_time=time.perf_counter() - clock,
    )
    return Trajectory(system, moments, states, phases_of(begun, float(moments[-1])), solution)


def _body(run: Run, system: System, contact: IsotropicContact | Points, unit: Units) -> Body:
    if isinstance(system, PinOnDisc):
        return PinBody(run, unit.of_pin(SlipMotion.of(system)))
    motion = unit.of_disc(DiscMotion.of(system, contact))
    if isinstance(contact, Points):
        return PointsBody(run, motion, contact)
    if isinstance(contact, Pin):
        raise ValueError(
            f"contact = {contact}: a disc with point contact never comes to rest; use a PinOnDisc"
        )
    return RingBody(run, motion, contact)
