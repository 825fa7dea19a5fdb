"""Ensembles of pins and single pins: from parameters to results."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from reference_model.ensemble.checkpoints import Checkpoints, empty_checkpoints, from_the_start
from reference_model.ensemble.chunks import in_chunks
from reference_model.ensemble.core.stepping.runge_kutta import tolerance_of_steps
from reference_model.ensemble.end_states import Ensemble, Results
from reference_model.ensemble.parameters import Task, parameter_table
from reference_model.ensemble.pin.kernel import PARAMETERS, run_pins
from reference_model.ensemble.pin.memory import no_regions, settings_of
from reference_model.ensemble.pin.trapping import trapping_regions
from reference_model.ensemble.recording import Recording
from reference_model.systems import FloatArray, PinOnDisc


def simulate_pins(
    pin: PinOnDisc,
    starts: FloatArray,
    duration: float,
    tolerance: float,
    varied: Mapping[str, FloatArray],
    early_end: bool,
    n: int,
    threads: int,
) -> Ensemble:
    """Simulate ``n`` pins like :func:`reference_model.ensemble.simulate_ensemble`, with checked arguments."""
    table = parameter_table(pin, PARAMETERS, varied)
    regions = no_regions()  # a writable array, because the kernel is compiled for one kind only
    if not varied:
        regions[:] = trapping_regions(pin)
    local = tolerance_of_steps(tolerance)
    task, results = (
        Task(table, starts, from_the_start(), np.full(1, duration)),
        Results.empty(n, pin.state_size),
    )
    nowhere = empty_checkpoints(0, pin.state_size)

    def run(first: int, last: int) -> None:
        run_pins(task, settings_of(local, early_end, False, regions, nowhere), results, first, last)

    in_chunks(run, n, threads)
    return results.ensemble(varied.get("friction_force", pin.friction_force))


def follow_pin(pin: PinOnDisc, state: FloatArray, tolerance: float, recording: Recording) -> None:
    """Record the motion of a pin from ``state`` on."""
    local = tolerance_of_steps(tolerance)
    table, regions = parameter_table(pin, PARAMETERS), no_regions()

    def run(
        starts: FloatArray, paces: FloatArray, durations: FloatArray, checkpoints: Checkpoints
    ) -> Results:
        results = Results.empty(len(starts), pin.state_size)
        task = Task(table, starts, paces, durations)
        run_pins(task, settings_of(local, False, False, regions, checkpoints), results, 0, len(starts))
        return results

    recording.follow(run, run, state, 0.0)
