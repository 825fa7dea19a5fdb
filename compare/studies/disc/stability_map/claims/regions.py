"""What motions end as in each region of the map, and beside its borders."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from compare.claims.measured import Measured
from compare.claims.study import Data
from compare.engines import Engine
from compare.studies.disc.stability_map.claims.study import STUDY
from compare.studies.disc.stability_map.theory import (
    BESIDE,
    BEYOND,
    DISC,
    ENDS,
    LOADS,
    ON_CYCLE,
    OUTSIDE,
    SETTLED,
    SLOW_LOADS,
    SLOWLY_SETTLED,
    STUCK,
    Start,
    at,
    ends_of,
    kind_of_end,
)
from compare.studies.toolkit.fig11_planes import PLANES
from reference_model.steady.bifurcation_curves import crossings
from reference_model.steady.steady_states import whirls
from reference_model.systems import FloatArray


@STUDY.claim(
    "In each region of the map motions end as the map says", equation="(19), (20)", basis="reference"
)
def regions(engine: Engine, starts: Sequence[Start] | None = None) -> Measured:
    """See what motions end as; None for those of ``starts_in_regions``."""
    starts = starts_in_regions() if starts is None else starts
    ends, measured = ends_of(engine.simulate, starts)
    return replace(measured, data=ends_by_plane(starts, ends))


@STUDY.claim(
    "Just outside of the Hopf curves whirl and modulated cycle coexist, and 2 % outside only the whirl is left",
    equation="(19), (20)",
    basis="reference",
)
def coexist(
    engine: Engine, starts: Sequence[Start] | None = None, loads: Sequence[float] = LOADS
) -> Measured:
    """See what motions end as outside of the Hopf curves; None for those of ``coexisting``.

    ``loads`` in N are those of the motions that are drawn over the load.
    """
    _, measured = ends_of(engine.simulate, coexisting() if starts is None else starts)
    return replace(measured, data={"section": long_motions(engine, loads)})


def starts_in_regions() -> tuple[Start, ...]:
    """Return motions in all regions of the map: what they are to end as, by the curves of the ring."""
    at_rest = (0.0, 0.0, 0.0, 0.0, 0.0, DISC.disc_speed)  # it turns with the master disc
    outside = (0.03, 0.0, 0.0, 0.0, 0.03, 1.38)
    near_axis = (1e-3, 0.0, 0.0, 0.0, 1e-3, 1.41)

    return (
        Start(at(friction_force=0.018), outside, "rotation"),
        Start(at(friction_force=0.0211), near_axis, "whirl", SLOWLY_SETTLED),
        Start(DISC, near_axis, "modulated cycle"),
        Start(DISC, outside, "modulated cycle"),
        Start(at(friction_force=0.028), near_axis, "whirl"),
        Start(at(friction_force=0.034), outside, "whirl"),
        Start(at(friction_force=0.034), at_rest, "sticking", STUCK),
        Start(at(shaft_damping=0.011), near_axis, "whirl"),
        Start(at(shaft_damping=0.02), outside, "rotation"),
        Start(at(polar_inertia=0.4), outside, "whirl", SLOWLY_SETTLED),
        Start(at(polar_inertia=2.0), outside, "modulated cycle"),
        Start(at(damping=0.35), outside, "whirl"),
        Start(at(damping=0.8), outside, "rotation"),
        Start(at(shaft_speed=1.15), outside, "rotation"),
        Start(at(shaft_speed=1.3), near_axis, "whirl"),
    )


def coexisting() -> tuple[Start, ...]:
    """Return motions outside of both Hopf curves: near to them one from whirl and cycle each, and farther off."""
    lower, upper = crossings(PLANES["load"], "Hopf", "disc_speed", DISC.disc_speed)
    starts = []
    for border, outward, settled in ((lower, -1.0, SLOWLY_SETTLED), (upper, 1.0, SETTLED)):
        near, far = (at(friction_force=border * (1.0 + outward * share)) for share in (OUTSIDE, BEYOND))
        (whirl,) = whirls(near)
        starts += [
            Start(near, tuple((whirl.state * BESIDE).tolist()), "whirl"),
            Start(near, ON_CYCLE, "modulated cycle"),
            Start(far, ON_CYCLE, "whirl", settled),
        ]
    return tuple(starts)


def ends_by_plane(starts: Sequence[Start], ends: Sequence[str]) -> Data:
    """Return the two parameters and the end, as its place in ``ENDS``, of all motions that a plane shows."""
    rows: dict[str, list[tuple[float, float, float]]] = {}
    for name, plane in PLANES.items():
        for start, end in zip(starts, ends, strict=True):
            first, second = (getattr(start.disc, parameter) for parameter in plane.names)
            if plane.at((first, second)) == start.disc:
                rows.setdefault(f"ends/{name}", []).append((first, second, float(ENDS.index(end))))
    return {name: np.array(found) for name, found in rows.items()}


def long_motions(engine: Engine, loads: Sequence[float]) -> FloatArray:
    """Return friction force in N, smallest and largest radius in m after a long time, shape (n, 3)."""

    def extent(load: float) -> tuple[float, float]:
        settled = SLOWLY_SETTLED if load in SLOW_LOADS else SETTLED
        return kind_of_end(engine.simulate, Start(at(friction_force=load), ON_CYCLE, "", settled))[1:]

    return np.array([(load, *extent(load)) for load in loads])
