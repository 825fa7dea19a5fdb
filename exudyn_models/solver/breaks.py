"""Runs that stop where a load jumps, or where a controller takes a sample, and then continue."""

import math
from collections.abc import Callable, Generator, Mapping, Sequence
from typing import Any

import exudyn as exu
import numpy as np

from reference_model.systems import finite_numbers, positive_number, require_callable, require_kind, shown

GAP = 1e-13
"""Share of the run's duration omitted next to a break, so that no step sees both sides."""


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


Controller = Callable[[Any, float], object]
"""Function of ``mbs`` and the time in s that reads sensors and sets loads."""

TOGETHER = 1e-9
"""Largest distance of two breaks that count as one, as a share of the run."""

MOST_SAMPLES = 10_000_000
"""Largest number of samples of one controller in a run; their list takes about 1 GB."""


def with_samples(
    breaks: Sequence[float], sampled: Mapping[float, Controller], options: Any
) -> dict[float, list[Controller]]:
    """Return the functions to call at the start of the run and at all breaks, by increasing time in s.

    Raises ``ValueError`` if a period is not > 0 or too short, or if a function has other arguments.
    """
    require_kind("sampled", sampled, Mapping)
    start, end = options.startTime, options.endTime
    calls: list[tuple[float, Controller | None]] = [(start, None), *((time, None) for time in breaks)]
    for period, function in sampled.items():
        period = positive_number("sampled", period, "s")
        require_callable(f"sampled[{period:g}]", function, "mbs", "t")
        count = math.ceil((end - start) / period * (1.0 - TOGETHER))
        if count > MOST_SAMPLES:
            raise ValueError(
                f"sampled = {period:g} s: the run would take {count:g} samples; use a longer period"
            )
        calls += [(start + k * period, function) for k in range(count)]
    result: dict[float, list[Controller]] = {}
    last = -math.inf
    for time, call in sorted(calls, key=lambda pair: pair[0]):
        if time - last > TOGETHER * (end - start):
            last = time
        result.setdefault(last, []).extend([] if call is None else [call])
    return result


def take_samples(mbs: Any, t: float, functions: Sequence[Controller]) -> None:
    """Call functions with the initial values as the present state."""
    if functions:
        mbs.systemData.SetSystemState(mbs.systemData.GetSystemState(exu.ConfigurationType.Initial))
        mbs.systemData.SetTime(t)
    for function in functions:
        function(mbs, t)


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
