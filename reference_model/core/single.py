"""One trajectory by the core, interpreted or compiled."""

import functools
import math
import time
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import ArrayLike
from scipy.optimize import brentq

from reference_model.contact.annulus import Annulus
from reference_model.contact.contact_law import Contact, Ring, contact_of
from reference_model.contact.points import Points
from reference_model.core.forces.contact import shares
from reference_model.core.forces.points import around_of
from reference_model.core.memory import (
    EVALUATIONS,
    FAILS,
    FULL,
    PATIENCE,
    PHASES,
    RECORDED,
    RUNS,
    SLOTS,
    STATUS,
    STEP,
    STEPS,
)
from reference_model.core.parts import compiled
from reference_model.core.run import advance
from reference_model.motion.frame import Frame
from reference_model.motion.nondimensional import Units
from reference_model.motion.stepper import Kind
from reference_model.support import Support
from reference_model.systems import (
    DiscOnDisc,
    FloatArray,
    System,
    checked_state,
    checked_times,
    checked_tolerance,
)
from reference_model.trajectory import SimulationError, Solution, StepCount, Trajectory, phases_of

METHOD = "compiled DOP853 in stretched time, Radau IIA where it is stiff; closed-form stick phases"

LOCAL, LEAST = 0.05, 3e-14
"""Tolerance of a step as a share of the motion's, and its smallest value."""

SUM, DENSITY = 10.0, 5.0
"""Largest sum of the errors of steps in tolerances, and number of steps per unit of time.

Errors add up over the run, or over the decay time of the dampers.
"""

SLOW_SPRINGS = 0.1
"""Scaled natural frequency below which steps become more accurate: position errors are velocity errors over it."""

FIRST_STEP, FEW = 0.01, 15.0
"""First explicit step in stretched time, and number of short steps before collocation is tried."""

MOST_WORK = 20_000.0
"""Work of a call in explicit steps. It takes less than a second, then Python can handle an interruption."""

THINNEST = 1e-3
"""Smallest width of an annulus over its radius: a difference of two discs loses digits in a thinner one."""

KINDS: dict[int, Kind] = {1: "slip", 2: "stick", 3: "pivot"}
"""Names of the kinds of phases."""

Core = Callable[..., None]


@functools.cache
def compiled_core() -> Core:
    """Return :func:`reference_model.core.run.advance` as compiled code."""
    return compiled(advance)


def simulate_compiled(
    system: System,
    initial_state: ArrayLike,
    times: ArrayLike,
    *,
    tolerance: float = 1e-9,
    contact: Contact | None = None,
) -> Trajectory:
    """Simulate like :func:`reference_model.simulate`, by compiled code.

    Raises ``ValueError`` if the core does not know the contact.
    """
    require_known(system, contact_of(system, contact))
    return simulate_by(compiled_core(), system, initial_state, times, tolerance=tolerance, contact=contact)


def require_known(system: System, contact: Contact) -> None:
    """Raise ``ValueError`` if the core does not contain a law."""
    if isinstance(system, DiscOnDisc) and not isinstance(contact, Ring | Annulus | Points):
        raise ValueError(
            f"contact = {contact}: compiled runs support a Ring, an Annulus, Points and the law of the parameters; "
            "omit compiled=True"
        )
    if isinstance(contact, Annulus) and contact.pressure is not None:
        raise ValueError("pressure: compiled runs support only a uniform one, None; omit compiled=True")
    if isinstance(contact, Annulus) and contact.inner_radius > (1.0 - THINNEST) * contact.outer_radius:
        raise ValueError(
            f"inner_radius = {contact.inner_radius:g} m: compiled runs support annuli with a width of at least "
            f"{THINNEST:g} of outer_radius = {contact.outer_radius:g} m; use a Ring, or omit compiled=True"
        )


def law_of(system: System, contact: Any, unit: Units) -> tuple[FloatArray, FloatArray]:
    """Return the scaled parameters and ``around`` of the law of a pin, or a disc with this contact."""
    support = Support.of(system).scaled(unit.time**2 / system.mass, unit.length)
    friction = system.friction_force / system.mass * unit.time**2 / unit.length
    hold, outer, inner, load, shaft, lag, gyration = friction, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0
    around = np.zeros(0)
    if isinstance(system, DiscOnDisc):
        gyration = math.sqrt(system.polar_inertia / system.mass)
        lag = gyration * (system.disc_speed - system.shaft_speed) / unit.speed
        shaft = system.shaft_damping / system.polar_inertia * unit.time
        if isinstance(contact, Points):
            around = around_of(list(contact), gyration)
        elif isinstance(contact, Ring):
            outer = inner = contact.radius / gyration
        else:
            outer, inner = contact.outer_radius / gyration, contact.inner_radius / gyration
            load = 1.0 / ((1.0 - inner / outer) * (1.0 + inner / outer))
        gyration /= unit.length
        if friction > 0.0 and len(around) == 0:
            hold = holding_force(friction, abs(shaft * lag), outer, inner, load)
    scalars = (
        system.damping / system.mass * unit.time, support.stiffness, support.offset, support.hardening,
        support.stop_gap, support.stop_stiffness, friction, hold, system.disc_speed * unit.time, outer, inner, load,
        shaft, lag, gyration, 0.5 * friction,
    )  # fmt: skip
    return np.array(scalars), around


def holding_force(friction: float, asked: float, outer: float, inner: float, load: float) -> float:
    """Return the force on the limit surface at the moment that the shaft exerts; -1 beyond the largest moment."""
    most = shares(0.0, 1.0, outer, inner, load)[1]
    if asked > friction * most:
        return -1.0

    def at(alpha: float) -> tuple[float, float]:
        return shares(math.cos(alpha), math.sin(alpha) / most, outer, inner, load)

    alpha = 0.0
    if asked > 0.0:
        quarter = 0.5 * math.pi
        alpha = float(brentq(lambda a: friction * at(a)[1] - asked, 0.0, quarter, xtol=1e-16, rtol=1e-15))
    return friction * at(alpha)[0]


def simulate_by(
    core: Core,
    system: System,
    initial_state: ArrayLike,
    times: ArrayLike,
    *,
    tolerance: float = 1e-9,
    contact: Contact | None = None,
) -> Trajectory:
    """Simulate like :func:`reference_model.simulate` by ``core``, interpreted or compiled."""
    clock = time.perf_counter()
    start, moments = checked_state(system, initial_state), checked_times(times)
    tolerance = checked_tolerance(tolerance)
    law = contact_of(system, contact)
    unit = Units.of(system, start)
    frame = Frame.of(system, unit)
    parameters, around = law_of(system, law, unit)
    columns = [0, 1, 5, 2, 3, 4] if isinstance(system, DiscOnDisc) else [0, 1, 2, 3]
    state = np.zeros(7)
    state[columns] = frame.unknowns(start)
    scaled = (moments - moments[0]) / unit.time
    lasting = float(scaled[-1])
    if system.damping > 0.0:
        lasting = min(lasting, 2.0 * system.mass / (system.damping * unit.time))
    share = min(LOCAL, SUM / (DENSITY * lasting)) if lasting > 0.0 else LOCAL
    local = max(tolerance * share * min(1.0, unit.springs(system) / SLOW_SPRINGS), LEAST)
    out, memory, phases = np.zeros((len(moments), 6)), np.zeros(SLOTS), np.zeros((64, 8))
    memory[PATIENCE], memory[STEP], memory[RECORDED] = FEW, FIRST_STEP, 1.0
    end, count = float(scaled[-1]), StepCount(float(scaled[-1]))
    while memory[STATUS] == RUNS:
        core(state, memory, local, end, scaled, out, phases, MOST_WORK, parameters, around)
        if memory[STATUS] == FULL:
            phases = np.vstack((phases, np.zeros_like(phases)))
            memory[STATUS] = RUNS
        at = float(moments[0] + state[6] * unit.time)
        if memory[STATUS] == FAILS:
            raise SimulationError(
                f"the integrator failed after t = {at:g} s; try a larger tolerance than {tolerance:g}"
            )
        if too_many := count.reach(int(memory[STEPS]), float(state[6])):
            raise SimulationError(
                f"stopped at t = {at:g} s because {too_many}: the parameters are very stiff, or the motion is very "
                "long; simulate it in parts, or with a larger tolerance"
            )
    states = frame.states(out[:, columns])
    states[0] = start
    begun = [
        (KINDS[int(row[0])], float(moments[0] + row[1] * unit.time), frame.states(row[2:][columns]))
        for row in phases[: int(memory[PHASES])]
    ]
    solution = Solution(
        METHOD, tolerance, int(memory[EVALUATIONS]), int(memory[STEPS]), time.perf_counter() - clock
    )
    return Trajectory(system, moments, states, phases_of(begun, float(moments[-1])), solution)
