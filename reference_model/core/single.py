"""One trajectory by the core, interpreted or compiled."""

import functools
import math
import time
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from reference_model.contact.contact_law import Ring, contact_of
from reference_model.core.forces import Law
from reference_model.core.parts import PARTS
from reference_model.core.run import (
    EVALUATIONS,
    FAILS,
    FULL,
    PATIENCE,
    FEW,
    PHASES,
    RECORDED,
    RUNS,
    SLIPS,
    STATUS,
    STEPS,
    advance,
)
from reference_model.motion.disc_equations import DiscMotion
from reference_model.motion.exact import _Frame
from reference_model.motion.nondimensional import Units
from reference_model.motion.pin_equations import SlipMotion
from reference_model.motion.stick import stuck_centre
from reference_model.systems import DiscOnDisc, System, checked_state, checked_times, checked_tolerance
from reference_model.trajectory import SimulationError, Solution, Trajectory, phases_of

METHOD = "DOP853 in stretched time, Radau IIA where it is stiff; closed-form stick phases"

LOCAL, LEAST = 0.05, 3e-14
"""Tolerance of a step as a share of the motion's, and its smallest value."""

MOST_STEPS = 200_000
"""Number of steps of a call, below a second in compiled code."""


@functools.cache
def compiled() -> Callable[..., None]:
    import numba
    from numba.extending import register_jitable

    for function in PARTS:
        register_jitable(error_model="numpy")(function)
    found: Callable[..., None] = numba.njit(error_model="numpy", cache=True, nogil=True)(advance)
    return found


def law_of(system: System, unit: Units) -> Law:
    """Return the scaled law of a pin or a ring."""
    centre = unit.of_pin(SlipMotion.of(system))
    hold, rim, shaft, lag, gyration = centre.friction, 0.0, 0.0, 0.0, 1.0
    if isinstance(system, DiscOnDisc):
        contact = Ring(system.contact_radius)
        motion = unit.of_disc(DiscMotion.of(system, contact))
        rim = system.contact_radius / (motion.gyration * unit.length)
        shaft, lag, gyration = motion.shaft_rate, motion.lag, motion.gyration
        stuck = stuck_centre(motion, contact) if centre.friction > 0.0 else None
        hold = stuck.friction if stuck is not None else -1.0
    support = centre.support
    return Law(
        centre.damping, support.stiffness, support.offset, support.hardening, support.stop_gap,
        support.stop_stiffness, centre.friction, hold, centre.disc_speed, rim, shaft, lag, gyration,
        0.5 * centre.friction,
    )  # fmt: skip


def simulate(
    system: System, initial_state: ArrayLike, times: ArrayLike, *, tolerance: float = 1e-9, code: Any = advance
) -> Trajectory:
    clock = time.perf_counter()
    start, moments = checked_state(system, initial_state), checked_times(times)
    tolerance = checked_tolerance(tolerance)
    contact_of(system, None)
    unit = Units.of(system, start)
    law, frame = law_of(system, unit), _Frame.of(system, unit)
    unknowns = frame.unknowns(start)
    disc = isinstance(system, DiscOnDisc)
    state = np.zeros(7)
    state[:2] = unknowns[:2]
    if disc:
        state[5], state[2:5] = unknowns[2], unknowns[3:6]
    else:
        state[2:4] = unknowns[2:4]
    scaled = (moments - moments[0]) / unit.time
    local = max(tolerance * LOCAL * min(1.0, unit.springs(system) / 0.1), LEAST)
    out, memory, phases = np.zeros((len(moments), 6)), np.zeros(12), np.zeros((64, 8))
    memory[PATIENCE] = FEW
    memory[RECORDED], out[0] = 1.0, [*state[:5], state[5]]
    end = float(scaled[-1])
    while True:
        code(state, memory, local, end, scaled, out, phases, MOST_STEPS, law)
        if memory[STATUS] == FULL:
            phases = np.vstack((phases, np.zeros_like(phases)))
            memory[STATUS] = RUNS
        elif memory[STATUS] != RUNS:
            break
    at = float(moments[0] + state[6] * unit.time)
    if memory[STATUS] == FAILS:
        raise SimulationError(f"the integrator failed after t = {at:g} s; try a larger tolerance than {tolerance:g}")
    columns = [0, 1, 5, 2, 3, 4] if disc else [0, 1, 2, 3]
    states = frame.states(out[:, columns])
    states[0] = start
    begun = [
        ("slip" if row[0] == SLIPS else "stick", float(moments[0] + row[1] * unit.time), frame.states(row[2:][columns]))
        for row in phases[: int(memory[PHASES])]
    ]
    solution = Solution(METHOD, tolerance, int(memory[EVALUATIONS]), int(memory[STEPS]), time.perf_counter() - clock)
    return Trajectory(system, moments, states, phases_of(begun, float(moments[-1])), solution)
