"""Runs that stop where a load jumps and then continue."""

import math
from collections.abc import Generator, Sequence
from typing import Any

import exudyn as exu
import numpy as np

from reference_model.systems import finite_numbers, shown

GAP = 1e-13
"""Share of the run's duration omitted beside a break, so that no step sees both sides."""


def checked_breaks(breaks: Sequence[float], options: Any) -> list[float]:
    """Return the breaks in s; raise ``ValueError`` unless they increase and lie within the run."""
    start, end = options.startTime, options.endTime
    times = finite_numbers("breaks", breaks)
    if times.ndim != 1:
        raise ValueError(f"breaks = {shown(breaks)}: it must be a list of times")
    result: list[float] = times.tolist()
    for i, (before, value) in enumerate(zip([start, *result], result, strict=False)):
        if not start < value < end:
            raise ValueError(
                f"breaks[{i}] = {value:g} s: it must be within the run, from {start:g} to {end:g} s"
            )
        if value <= before:
            raise ValueError(f"breaks[{i}] = {value:g} s: it must be later than {before:g} s, the one before")
    return result


def parts_of_run(
    mbs: Any, settings: Any, breaks: Sequence[float], update_initial_values: bool
) -> Generator[bool, None, None]:
    """Set ``settings`` for each part of the run in turn; yield whether its end is the next initial state.

    Files and sensors record all parts. At the end the initial values are restored unless ``update_initial_values``.
    """
    options, outputs = settings.timeIntegration, settings.solution
    start, end, steps = options.startTime, options.endTime, options.numberOfSteps
    initial = mbs.systemData.GetSystemState(exu.ConfigurationType.Initial) if breaks else None
    gaps = [max(GAP * (end - start), 4.0 * np.spacing(abs(value))) for value in breaks]
    starts = [start, *(value + gap for value, gap in zip(breaks, gaps, strict=True))]
    ends = [*(value - gap for value, gap in zip(breaks, gaps, strict=True)), end]
    try:
        for i, (first, last) in enumerate(zip(starts, ends, strict=True)):
            options.startTime, options.endTime = first, last
            options.numberOfSteps = max(1, math.ceil((last - first) / (end - start) * steps - 1e-6))
            if i > 0:
                outputs.file.append = outputs.sensors.append = True
                outputs.file.writeInitialValues = False
            yield update_initial_values or last != end
    finally:
        if initial is not None and not update_initial_values:
            mbs.systemData.SetSystemState(initial, exu.ConfigurationType.Initial)
