"""One trajectory by the core, interpreted or compiled."""

import functools
import math
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from reference_model.contact.annulus import Annulus
from reference_model.contact.contact_law import IsotropicContact, Pin, Ring
from reference_model.contact.limit_surface import force_beside
from reference_model.contact.points import Points
from reference_model.core.forces.law import OWN, SCALARS, Law, unpacked
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
from reference_model.core.run import advance
from reference_model.core.steps.explicit import SIZE
from reference_model.core.units import Frame, Units
from reference_model.numerics.cache_folders import has_files
from reference_model.numerics.parts import digest_with_parts, prepared
from reference_model.support import Support
from reference_model.systems import DiscOnDisc, FloatArray, System
from reference_model.trajectory import Kind, SimulationError, Solution, StepCount, Trajectory, phases_of

METHOD = "DOP853 in stretched time, Radau IIA where it is stiff; closed-form stick phases"

LOCAL, LEAST = 0.05, 3e-14
"""Tolerance of a step as a share of the motion's tolerance, and its smallest value."""

SUM, DENSITY = 10.0, 5.0
"""Largest sum of the errors of steps in tolerances, and number of steps per unit of time.

Errors add up over the run, or over the decay time of the dampers.
"""

SLOW_SPRINGS = 0.1
"""Scaled natural frequency below which steps become more accurate: position errors are velocity errors over it."""

FIRST_STEP, FEW = 0.01, 15.0
"""First explicit step in stretched time, and number of short steps before collocation is tried."""

MOST_WORK = 20_000.0
"""Work of a call in explicit steps. A call takes less than a second, so Python can handle an interruption after
it."""

THINNEST = 1e-3
"""Smallest width of an annulus over its radius; in a thinner annulus, the difference of two discs loses digits."""

KINDS: dict[int, Kind] = {1: "slip", 2: "stick", 3: "pivot"}
"""Names of the kinds of phases."""

PACKAGE = Path(__file__).parent

Core = Callable[..., None]
"""Continues a run, like :func:`reference_model.core.run.follow`."""


@dataclass(frozen=True)
class OwnLaw:
    """A law of the user for scaled slip and r = κ(φ̇ − ω), with κ in m."""

    contact: IsotropicContact
    gyration: float

    def shares(self, slip: float, spin: float) -> tuple[float, float]:
        """Return force and moment over κ as shares of μN."""
        found = self.contact.shares(slip, spin / self.gyration)
        return found.resistance, found.moment / self.gyration


@functools.cache
def compiled_core() -> Core:
    """Return :func:`reference_model.core.run.follow` as compiled code, which is made in the first call."""
    kernel = compiled_advance()

    def core(law: Law, *arguments: Any) -> None:
        kernel(*arguments, np.array(law[:SCALARS]), law.around)

    return core


@functools.cache
def compiled_advance() -> Any:
    """Return :func:`reference_model.core.run.advance` as a ``CompiledOnce``."""
    from reference_model.numerics.compiled_once import CompiledOnce

    return CompiledOnce(prepared(advance), PACKAGE, _digest())


def is_compiled() -> bool:
    """Return whether an earlier process or call on this machine has compiled the core."""
    return compiled_core.cache_info().currsize > 0 or has_files(PACKAGE, _digest(), advance.__name__)


@functools.cache
def _digest() -> str:
    return digest_with_parts(advance)


def is_compilable(contact: IsotropicContact | Points) -> bool:
    """Return whether compiled code supports a law: a pin, a ring, points, and an annulus under uniform pressure."""
    if isinstance(contact, Annulus):
        return contact.pressure is None and contact.inner_radius <= (1.0 - THINNEST) * contact.outer_radius
    return isinstance(contact, Pin | Ring | Points)


def law_of(system: System, contact: IsotropicContact | Points, unit: Units) -> Law:
    """Return the scaled law of a pin, or of a disc with this contact.

    Raises ``ValueError`` if the disc touches only in its centre, or the law has more than two resting radii.
    """
    support = Support.of(system).scaled(unit.time**2 / system.mass, unit.length)
    friction = system.friction_force / system.mass * unit.time**2 / unit.length
    hold, outer, inner, load, shaft, lag, gyration = friction, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0
    around, own = np.zeros(0), None
    if isinstance(system, DiscOnDisc):
        gyration = math.sqrt(system.polar_inertia / system.mass)
        lag = gyration * (system.disc_speed - system.shaft_speed) / unit.speed
        shaft = system.shaft_damping / system.polar_inertia * unit.time
        if isinstance(contact, Points):
            around = around_of(list(contact), gyration)
        else:
            outer, inner, load, own = _radii(contact, gyration)
            moment = system.shaft_damping * abs(system.disc_speed - system.shaft_speed)
            held = force_beside(contact, system.friction_force, moment)
            hold = -1.0 if held is None else held / system.mass * unit.time**2 / unit.length
        gyration /= unit.length
    scalars = (
        system.damping / system.mass * unit.time, support.stiffness, support.offset, support.hardening,
        support.stop_gap, support.stop_stiffness, friction, hold, system.disc_speed * unit.time, outer, inner, load,
        shaft, lag, gyration, 0.5 * friction,
    )  # fmt: skip
    return unpacked(np.array(scalars), around)._replace(own=own)


def _radii(contact: IsotropicContact, gyration: float) -> tuple[float, float, float, OwnLaw | None]:
    """Return the radii over κ, the load of the law, and a law that is not in the core."""
    if isinstance(contact, Pin):
        raise ValueError(
            f"contact = {contact}: a disc with point contact never comes to rest; use a PinOnDisc"
        )
    if isinstance(contact, Ring):
        return contact.radius / gyration, contact.radius / gyration, 0.0, None
    if isinstance(contact, Annulus) and is_compilable(contact):
        outer, inner = contact.outer_radius / gyration, contact.inner_radius / gyration
        return outer, inner, 1.0 / ((1.0 - inner / outer) * (1.0 + inner / outer)), None
    radii = sorted((float(radius) / gyration for radius in contact.resting_radii), reverse=True)
    if len(radii) > 2:
        raise ValueError(f"resting_radii = {contact.resting_radii}: at most two radii are possible")
    outer, inner = (radii or [1.0])[0], (radii[1:] or [0.0])[0]  # where there is no kink, a step may end too
    return outer, inner, OWN, OwnLaw(contact, gyration)


def simulate_by(
    core: Core,
    system: System,
    contact: IsotropicContact | Points,
    start: FloatArray,
    moments: FloatArray,
    tolerance: float,
) -> Trajectory:
    """Return the motion like :func:`reference_model.simulate`, by ``core``; the arguments are checked."""
    clock = time.perf_counter()
    unit = Units.of(system, start)
    frame, law = Frame.of(system, unit), law_of(system, contact, unit)
    columns = [0, 1, 5, 2, 3, 4] if isinstance(system, DiscOnDisc) else [0, 1, 2, 3]
    state = np.zeros(SIZE + 2)
    state[columns] = frame.unknowns(start)
    scaled = (moments - moments[0]) / unit.time
    local = _tolerance_of_steps(system, unit, float(scaled[-1]), tolerance)
    out, memory, phases = np.zeros((len(moments), 6)), np.zeros(SLOTS), np.zeros((64, 8))
    memory[PATIENCE], memory[STEP], memory[RECORDED] = FEW, FIRST_STEP, 1.0
    end, count = float(scaled[-1]), StepCount(float(scaled[-1]))
    while memory[STATUS] == RUNS:
        core(law, state, memory, local, end, scaled, out, phases, MOST_WORK)
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


def _tolerance_of_steps(system: System, unit: Units, lasting: float, tolerance: float) -> float:
    if system.damping > 0.0:
        lasting = min(lasting, 2.0 * system.mass / (system.damping * unit.time))
    share = min(LOCAL, SUM / (DENSITY * lasting)) if lasting > 0.0 else LOCAL
    return max(tolerance * share * min(1.0, unit.springs(system) / SLOW_SPRINGS), LEAST)
