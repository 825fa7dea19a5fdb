"""Ensembles of discs, and of bodies that only the core supports."""

import math
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from reference_model.contact.contact_law import Contact, contact_of
from reference_model.contact.points import Points
from reference_model.core.forces.law import SCALARS, SHAFT, WIDTH
from reference_model.core.forces.points import around_of
from reference_model.core.single import law_of
from reference_model.core.units import Units
from reference_model.ensemble.core.by_core import core_for_kernels, room_for
from reference_model.ensemble.core.lanes import row_of
from reference_model.ensemble.core.stepping.runge_kutta import tolerance_of_steps
from reference_model.ensemble.disc.kernel import run_by_core, run_points, run_rings
from reference_model.ensemble.disc.lanes import DiscSettings, Setup
from reference_model.ensemble.disc.trapping import no_regions, trapping_regions
from reference_model.ensemble.end_states import Results
from reference_model.ensemble.task import OF_DISC, OF_PIN, OF_SUPPORT, Task, in_chunks
from reference_model.systems import DiscOnDisc, FloatArray, PinOnDisc, System

ROUNDED = 1e-12
"""Rounding error of times, as a share of the duration."""

SPIN_DOWN = 1.0
"""Scaled shaft damping of a pin, whose spin is not a part of its motion and stays zero."""


def simulate_discs(
    disc: DiscOnDisc, task: Task, tolerance: float, early_end: bool, varied: bool, threads: int
) -> Results:
    """Simulate discs on a ring or on points with linear supports, in lanes."""
    number = disc.contact_points or 0
    around = tuple(f(2.0 * math.pi * i / number) for i in range(number) for f in (math.cos, math.sin))
    law, points = contact_of(disc), np.zeros(0)
    if isinstance(law, Points):
        points = around_of(list(law), disc.contact_radius)
    regions = no_regions() if varied else trapping_regions(disc)
    kernel = run_points if number else run_rings
    return _run(kernel, task, around, points, regions, tolerance, early_end, threads, by_core=False)


def simulate_any(
    system: System, contact: Contact | None, task: Task, tolerance: float, early_end: bool, threads: int
) -> Results:
    """Simulate bodies on any support, with any contact that the core supports, without lanes."""
    law = contact_of(system, contact)
    points = np.zeros(0)
    if isinstance(law, Points):
        points = around_of(list(law), 1.0 if contact else system.contact_radius)  # type: ignore[union-attr]
    starts = task.starts
    if isinstance(system, PinOnDisc):
        speed = task.parameters[:, OF_PIN.index("disc_speed")]
        x, y, vx, vy, spin = np.broadcast_arrays(*starts.T, speed)
        starts = np.column_stack((x, y, np.zeros_like(x), vx, vy, spin))
    table = np.array([scaled_for_core(system, contact, task, i) for i in range(task.size)])
    results = _run(
        run_by_core, Task(table, starts, task.durations), (), points, no_regions(), tolerance, early_end, threads,
        by_core=True,
    )  # fmt: skip
    if isinstance(system, PinOnDisc):
        return results._replace(states=results.states[:, [0, 1, 3, 4]])
    return results


def scaled_for_core(system: System, contact: Contact | None, task: Task, number: int) -> list[float]:
    """Return the scaled parameters of the core, the units of length and rate, η, the speed of the disc, and κ."""
    names = (*(OF_PIN if isinstance(system, PinOnDisc) else OF_DISC), *OF_SUPPORT)
    parameters: dict[str, Any] = dict(zip(names, row_of(task.parameters, number).tolist(), strict=True))
    one = replace(system, **parameters)
    unit = Units.of(one, row_of(task.starts, number))
    row = list(law_of(one, contact_of(one, contact), unit)[:SCALARS])
    if isinstance(one, PinOnDisc):
        kappa = reach = unit.length
        row[SHAFT] = SPIN_DOWN
    else:
        kappa = math.sqrt(one.polar_inertia / one.mass)
        reach = one.contact_radius if contact is None else 1.0
    return [*map(float, row), unit.length, 1.0 / unit.time, reach / kappa, one.disc_speed, kappa]


def _run(
    kernel: Any, task: Task, around: tuple[float, ...], points: FloatArray, regions: NDArray[Any], tolerance: float,
    early_end: bool, threads: int, *, by_core: bool,
) -> Results:  # fmt: skip
    results = Results.empty(task.size, DiscOnDisc.state_size)
    local, core = tolerance_of_steps(tolerance), core_for_kernels()

    def run(stoppable: Task, first: int, last: int) -> None:
        room = room_for(len(points) // WIDTH)
        setup = Setup(DiscSettings(local, early_end, around, regions), points, room, by_core)
        kernel(stoppable, setup, core, results, first, last)

    in_chunks(run, task, threads)
    durations = np.broadcast_to(task.durations, results.times.shape)
    at_end = results.times > durations * (1.0 - ROUNDED)
    results.times[at_end] = durations[at_end]
    return results
