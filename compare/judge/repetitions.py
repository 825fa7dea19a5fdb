"""Right engines with random admissible parameters: no claim may fail one of them."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.random import Generator

from compare.claims.error_estimates import TRUTH, WORKING
from compare.claims.study import Findings, Study
from compare.engines import Engine
from compare.studies.engines.trajectories.claims import measure
from compare.studies.engines.trajectories.parameters import Motion
from compare.studies.toolkit.random_systems import any_disc, any_pin, any_start
from reference_model import simulate
from reference_model.systems import System

REPETITIONS = 50

SEED = 50

UNTIL = 10.0
"""In s: three to thirty radians of the support's own oscillation."""

RESOLUTION = 1e-4
"""Of a claim, as a part of the largest number in the start."""

SYSTEMS: dict[str, Callable[[Generator], System]] = {
    "pin": any_pin,
    "disc on the continuous ring": lambda random: any_disc(random, None),
    "disc on points": lambda random: any_disc(random, int(random.integers(3, 7))),
}


def random_motions(repetitions: int = REPETITIONS) -> dict[str, Motion]:
    """Return motions with random parameters and starts, of pins and discs by turns."""
    random = np.random.default_rng(SEED)
    motions = {}
    for i in range(repetitions):
        kind = list(SYSTEMS)[i % len(SYSTEMS)]
        system = SYSTEMS[kind](random)
        start = any_start(random, system)
        phases = simulate(system, start, [0.0, UNTIL], tolerance=TRUTH).phases
        motions[f"{kind}, parameters {i + 1}"] = Motion(
            system,
            tuple(start.tolist()),
            UNTIL,
            sticks=any(phase.kind != "slip" for phase in phases),
            tolerance=WORKING,
            resolution=RESOLUTION * float(np.max(np.abs(start))),
            source=f"assumption: parameters and start are random, with seed {SEED}",
        )
    return motions


def measure_repeatedly(engine: Engine) -> Findings:
    """Follow all of these motions with ``engine``."""
    return measure(engine, random_motions())


REPEATED = Study(
    name="random-parameters",
    title="Right engines with random parameters",
    paper="Not in the paper: its parameters are a few of many.",
    by_hand=measure_repeatedly,
    seconds=20.0,
)
