"""What motions of the centred disc end as."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict
from typing import NamedTuple

import numpy as np

from compare.claims.answers import asked, holds
from compare.claims.claim import Claim
from compare.claims.paper_parameters import FIG11
from compare.claims.parameters import at_each, parameters_of
from compare.engines import Simulate
from reference_model.systems import DiscOnDisc

SETTLED = 1200.0
WATCHED = 350.0
"""In s: how long motions are given to settle, and over how long before the end they are looked at."""

SLOWLY_SETTLED = 2400.0
"""In s: what takes longer near to where a cycle has just gone."""

SETTLING_TOLERANCE = 1e-6

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


def ends_of(
    simulate: Simulate, name: str, sentence: str, starts: Sequence[Start], equation: str = "(19), (20)"
) -> tuple[list[str], Claim]:
    """Return what the motions end as, and the claim that it is what they are said to.

    ``equation`` is that of the motions and of their law of friction.
    """
    ends: dict[float, list[str]] = {}

    def as_said(tolerance: float) -> list[bool]:
        ends[tolerance] = [kind_of_end(simulate, start, tolerance)[0] for start in starts]
        return [end == start.end for end, start in zip(ends[tolerance], starts, strict=True)]

    answers = holds(*asked(as_said, SETTLING_TOLERANCE))
    found = ends[SETTLING_TOLERANCE]
    durations = sorted({start.duration for start in starts})
    differing = [
        f"{end} in place of {start.end} for {changes(start.disc)}"
        for end, start in zip(found, starts, strict=True)
        if end != start.end
    ]
    return found, Claim(
        sentence,
        equation=equation,
        engine=name,
        **answers,
        parameters=parameters_of(FIG11),
        source="Fig. 11 with X0 = 0; one parameter at a time is another",
        note=f"Whether each motion ends as said after {at_each('t', durations)} s: "
        + ", ".join(f"{start.end} for {changes(start.disc)}" for start in starts)
        + f". {'; '.join(differing)}".rstrip("; "),
        basis="reference",
    )


def changes(disc: DiscOnDisc) -> str:
    """Return in words what of Fig. 11's parameters is different."""
    differing = [
        f"{name} = {value:.4g}" for name, value in asdict(disc).items() if value != getattr(FIG11, name)
    ]
    return ", ".join(differing) or "Fig. 11"
