"""What motions of the centred disc end as."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict
from typing import NamedTuple

import numpy as np

from compare.claims.measured import Measured, answers_of, asked
from compare.claims.parameters import at_each
from compare.engines import Simulate
from compare.studies.disc.stability_map.parameters import DISC
from reference_model.systems import DiscOnDisc

SETTLED = 600.0
WATCHED = 350.0
"""In s: how long motions are given to settle, and over how long before the end they are looked at."""

SLOWLY_SETTLED = 2400.0
"""In s: what takes longer near to where a cycle has just gone, as disturbances fall at less than 0.01 1/s there."""

SETTLING_TOLERANCE = 1e-5

AXIS = 1e-3
"""Radius in units of R below which a motion counts as rotation about the axis."""

MODULATED = 0.05
"""Of (largest − smallest)/(largest + smallest) radius, above which a motion counts as modulated."""


ENDS = ("rotation", "whirl", "modulated cycle", "sticking")
"""What motions end as."""


class Start(NamedTuple):
    """A disc, the state from which it starts, what it is to end as, and after how many seconds."""

    disc: DiscOnDisc
    state: tuple[float, ...]
    end: str
    duration: float = SETTLED


def kind_of_end(
    simulate: Simulate, start: Start, tolerance: float = SETTLING_TOLERANCE
) -> tuple[str, float, float]:
    """Return what a motion ends as, and the smallest and the largest radius in m of its last part."""
    times = [0.0, *np.linspace(max(start.duration - WATCHED, 0.5 * start.duration), start.duration, 801)]
    run = simulate(start.disc, start.state, times, tolerance=tolerance)
    radius = run.radius[1:]
    low, high = float(np.min(radius)), float(np.max(radius))
    if run.phases[-1].kind == "stick" and run.phases[-1].start <= times[1]:
        return "sticking", low, high
    if high < AXIS * start.disc.contact_radius:
        return "rotation", low, high
    return "modulated cycle" if high - low > MODULATED * (high + low) else "whirl", low, high


def ends_of(simulate: Simulate, starts: Sequence[Start]) -> tuple[list[str], Measured]:
    """Return what motions end as, and in how many that is what they are said to."""
    ends: dict[float, list[str]] = {}

    def as_said(tolerance: float) -> list[bool]:
        ends[tolerance] = [kind_of_end(simulate, start, tolerance)[0] for start in starts]
        return [end == start.end for end, start in zip(ends[tolerance], starts, strict=True)]

    answers = asked(as_said, SETTLING_TOLERANCE)
    found = ends[SETTLING_TOLERANCE]
    differing = [
        f"{end} in place of {start.end} for {changes(start.disc)}"
        for end, start in zip(found, starts, strict=True)
        if end != start.end
    ]
    return found, answers_of(
        *answers,
        source="Fig. 11 with X0 = 0; one parameter at a time is another",
        note=f"Whether each motion ends as said after {at_each('t', sorted({one.duration for one in starts}))} s: "
        + ", ".join(f"{start.end} for {changes(start.disc)}" for start in starts)
        + f". {'; '.join(differing)}".rstrip("; "),
    )


def changes(disc: DiscOnDisc) -> str:
    """Return in words what of Fig. 11's parameters is different."""
    differing = [
        f"{name} = {value:.4g}" for name, value in asdict(disc).items() if value != getattr(DISC, name)
    ]
    return ", ".join(differing) or "Fig. 11"
