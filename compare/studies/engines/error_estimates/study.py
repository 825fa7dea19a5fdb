"""What the error bars of all claims are worth: true errors of random motions beside their estimates."""

from __future__ import annotations

import functools

import numpy as np

from compare.claims.error_estimates import COARSENING, ROUNDING, SAFETY
from compare.claims.measured import Measured
from compare.claims.study import Study
from compare.engines import Engine
from compare.studies.engines.error_estimates.theory import (
    EXACT,
    KNOWN,
    LEAST_COVERAGE,
    MOST_OVER_ESTIMATE,
    MOTIONS,
    PROBLEMS,
    SEED,
    SOURCE,
    TOLERANCES,
    Calibration,
    Problem,
    calibrated,
)
from compare.studies.toolkit.random_systems import between

PROPORTIONAL = SAFETY * (1.0 - 1.0 / COARSENING)
"""Estimate over true error where errors are in proportion to the tolerance."""

KNOWN_FROM = (
    "Every number with the estimate that all claims take. True errors are against closed forms, or the reference at "
    f"tolerance {EXACT:g}."
)

STUDY = Study.beside(
    __file__,
    "error-estimates",
    words={
        "safety": f"{SAFETY:g}",
        "coarsening": f"{COARSENING:g}",
        "low": f"{100 - 100 * LEAST_COVERAGE:g}",
        "high": f"{100 * LEAST_COVERAGE:g}",
        "most": f"{MOST_OVER_ESTIMATE:g}",
    },
    source=SOURCE,
    seconds=3.5,
)


@STUDY.claim(
    f"In at least {100 * LEAST_COVERAGE:g} % of random cases the true error lies within its estimate: {{}}",
    kind="trajectory",
    resolution=1.0 - LEAST_COVERAGE,
    note=KNOWN_FROM,
    each=tuple(PROBLEMS),
)
def coverage(engine: Engine, kind: str, motions: int = MOTIONS) -> Measured:
    """Count the numbers whose true error lies within the estimate, in one kind of motion."""
    found = calibration(engine, kind, motions)
    return Measured(
        predicted=1.0,
        value=found.coverage,
        model=1.0 - LEAST_COVERAGE,
        parameters={"motions": found.motions, "seed": SEED},
        note=f"{len(found.errors)} numbers from {found.motions} motions; standard error of the coverage: "
        f"{100.0 * found.coverage_noise:.2f} %.",
        data={f"{kind}: errors": found.errors, f"{kind}: estimates": found.estimates},
    )


@STUDY.claim(
    f"In the median the estimate is not more than {MOST_OVER_ESTIMATE:g} times the true error: {{}}",
    kind="trajectory",
    resolution=MOST_OVER_ESTIMATE - PROPORTIONAL,
    note=f"{KNOWN_FROM} Where errors are in proportion to the tolerance the ratio is "
    f"{SAFETY:g}·(1 − 1/{COARSENING:g}) = {PROPORTIONAL:g} by construction; where no error depends on the tolerance, "
    f"as in the closed form of stick, it is rounding as allowed for over rounding as known, {ROUNDING / KNOWN:g}.",
    each=tuple(PROBLEMS),
)
def over_estimate(engine: Engine, kind: str, motions: int = MOTIONS) -> Measured:
    """Take the median of the estimate over the true error, in one kind of motion."""
    found = calibration(engine, kind, motions)
    return Measured(
        predicted=PROPORTIONAL,
        value=found.over_estimate,
        model=MOST_OVER_ESTIMATE - PROPORTIONAL,
        parameters={"motions": found.motions, "seed": SEED},
        note=f"{len(found.errors)} numbers from {found.motions} motions.",
        data={f"{kind}: ratios": found.ratios},
    )


@functools.lru_cache(maxsize=len(PROBLEMS))
def calibration(engine: Engine, kind: str, motions: int) -> Calibration:
    """Return the calibration of one kind of problem, in its part of ``motions`` over all that can be simulated."""
    each = -(-motions // len(simulated(engine)))
    return calibrated(engine, drawn(kind, each))


@functools.lru_cache(maxsize=len(PROBLEMS))
def drawn(kind: str, motions: int) -> tuple[tuple[Problem, float], ...]:
    """Return ``motions`` problems of a kind, each with its tolerance: every engine is asked the same."""
    random = np.random.default_rng([SEED, list(PROBLEMS).index(kind)])  # of its own for each kind
    return tuple((PROBLEMS[kind](random), between(random, *TOLERANCES)) for _ in range(motions))


@functools.lru_cache(maxsize=1)
def simulated(engine: Engine) -> tuple[str, ...]:
    """Return the kinds of problems that ``engine`` promises to simulate."""
    return tuple(
        kind
        for kind, problem in PROBLEMS.items()
        if engine.simulates(problem(np.random.default_rng(SEED)).system)
    )
