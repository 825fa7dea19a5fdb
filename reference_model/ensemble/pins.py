"""An ensemble of pins: from parameters to results."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from reference_model.ensemble.chunks import in_chunks
from reference_model.ensemble.pin import PARAMETERS, PinTask, run_pins
from reference_model.ensemble.pin_book import KNOWN
from reference_model.ensemble.regions import known_ends
from reference_model.ensemble.results import Ensemble, Results
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
    """Do as :func:`reference_model.ensemble.simulate_ensemble` with checked arguments, for ``n`` pins."""
    table = np.empty((n if varied else 1, len(PARAMETERS)))
    for column, name in zip(table.T, PARAMETERS, strict=True):
        column[:] = varied.get(name, getattr(pin, name))
    known = np.zeros(KNOWN)
    if not varied:
        known[:] = known_ends(pin)  # which is read-only: for such an array all would be compiled once more
    task, results = PinTask(table, starts, duration), Results.empty(n, pin.state_size)

    def run(first: int, last: int) -> None:
        run_pins(task, tolerance, early_end, False, known, results, first, last)

    in_chunks(run, n, threads)
    return results.ensemble(varied.get("friction_force", pin.friction_force))
