"""Ensembles of pins."""

from reference_model.ensemble.core.by_core import core_for_kernels
from reference_model.ensemble.core.stepping.runge_kutta import tolerance_of_steps
from reference_model.ensemble.end_states import Results
from reference_model.ensemble.pin.kernel import run_pins
from reference_model.ensemble.pin.lanes import settings_of
from reference_model.ensemble.pin.trapping import trapping_regions
from reference_model.ensemble.task import Task, in_chunks
from reference_model.systems import PinOnDisc


def simulate_pins(
    pin: PinOnDisc, task: Task, tolerance: float, early_end: bool, varied: bool, threads: int
) -> Results:
    regions = None if varied else trapping_regions(pin)
    results, local = Results.empty(task.size, pin.state_size), tolerance_of_steps(tolerance)

    core = core_for_kernels()

    def run(stoppable: Task, first: int, last: int) -> None:
        run_pins(stoppable, settings_of(local, early_end, regions=regions), core, results, first, last)

    in_chunks(run, task, threads)
    return results
