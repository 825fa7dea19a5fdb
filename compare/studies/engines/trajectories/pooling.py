"""One claim of several motions: with all their numbers, each with its own error bar."""

from __future__ import annotations

import functools
import itertools
from collections.abc import Callable, Iterable, Mapping, Sequence

import numpy as np

from compare.claims.measured import Measured
from compare.claims.parameters import at_each, parameters_of
from compare.engines import Engine, UnsupportedSystemError
from compare.studies.engines.trajectories.drawn import Drawn
from compare.studies.engines.trajectories.parameters import MOTIONS, ONE_OF_EACH_KIND, UNTIL, Motion
from reference_model.systems import FloatArray

Motions = Iterable[Motion]
"""Those of which one claim is made."""

Measure = Callable[[Engine, Motion], "Measured | None"]
MeasureAll = Callable[[Engine, Motions], "Measured | None"]


def together(measure: Measure) -> MeasureAll:
    """Let ``measure``, which looks at one motion, look at all of which one claim is made."""

    @functools.wraps(measure)
    def measure_all(engine: Engine, motions: Motions) -> Measured | None:
        if engine.contact_only and (isinstance(motions, Drawn) or not set(motions) <= set(ONE_OF_EACH_KIND)):
            return None
        if not all(engine.simulates(motion.system) for motion in motions):
            # All that is missing in one sentence, not one for each claim.
            raise UnsupportedSystemError(engine.lacking(motion.system for motion in MOTIONS.values()))
        parts = [part for motion in motions if (part := measure(engine, motion)) is not None]
        return pooled(parts) if parts else None

    return measure_all


def pooled(parts: Sequence[Measured]) -> Measured:
    """Return what was measured of several systems of one kind as one, with all numbers and their error bars."""
    first, *others = parts
    if not others:
        return first
    systems = [part.system for part in parts if part.system is not None]
    speeds = [system.disc_speed for system in systems]
    return Measured(
        predicted=np.concatenate([np.ravel(part.predicted) for part in parts]),
        value=np.concatenate([np.ravel(part.value) for part in parts]),
        error=np.concatenate([np.broadcast_to(part.error, np.shape(part.value)).ravel() for part in parts]),
        size=np.concatenate([_sizes(part) for part in parts]),
        resolution=first.resolution,
        components=[
            ", ".join((f"ω = {speed:g} rad/s", *place))
            for part, speed in zip(parts, speeds, strict=True)
            for place in itertools.product(*part.axes)
        ],
        parameters=_ranges([parameters_of(system) for system in systems]),
        source=first.source,
        note=f"{len(parts)} motions to t = {UNTIL:g} s, for {at_each('ω', speeds)} rad/s.",
    )


def _sizes(part: Measured) -> FloatArray:
    """Return the size beside which errors of each number are small."""
    size = np.max(np.abs(part.predicted)) if part.size is None else part.size
    return np.broadcast_to(size, np.shape(part.value)).ravel()


def _ranges(parameters: Sequence[Mapping[str, float | str]]) -> dict[str, float | str]:
    """Return the smallest and the largest value of each parameter in words, or the one that all have."""
    found: dict[str, float | str] = {}
    for name, value in parameters[0].items():
        values = [one[name] for one in parameters]
        numbers = [one for one in values if not isinstance(one, str)]
        spread = len(set(values)) > 1
        found[name] = f"{min(numbers):.3g} … {max(numbers):.3g}" if spread else value
    return found
