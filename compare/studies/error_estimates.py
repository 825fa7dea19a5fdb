"""What the error bars of all claims are worth: true errors of random motions beside their estimates."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from compare.accuracy import COARSENING, SAFETY
from compare.calibration import Calibration, calibrated
from compare.claim import Claim, ErrorBudget
from compare.engines import Engine
from compare.report.style import BLACK, curve, engines_in, new_figure, points
from compare.studies.error_estimates_problems import PROBLEMS, TIGHT, between
from compare.study import Data, Findings, Study

if TYPE_CHECKING:
    from matplotlib.figure import Figure

MOTIONS = 360
"""Random motions for an engine, as many of every kind of problem that it can simulate."""

TOLERANCES = (1e-7, 1e-5)
"""Between these the tolerance of a motion is drawn."""

SEED = 20

LEAST_COVERAGE, MOST_OVER_ESTIMATE = 0.99, 10.0
"""What error bars must reach to mean something."""

PROPORTIONAL = SAFETY * (1.0 - 1.0 / COARSENING)
"""Estimate over true error where errors are in proportion to the tolerance."""

COVERS = f"In at least {100 * LEAST_COVERAGE:g} % of random cases the true error lies within its estimate"
EXCEEDS = (
    f"In the median the estimate is about {PROPORTIONAL:g} times the true error, and not more than "
    f"{MOST_OVER_ESTIMATE:g} times"
)

SOURCE = (
    f"assumption: parameters, starts, times and tolerances (from {TOLERANCES[0]:g} to {TOLERANCES[1]:g}) "
    "are random"
)

SMALLEST, LARGEST = 1e-2, 1e3
"""Ratios of estimate and true error that the figure shows."""


def measure(engine: Engine, motions: int = MOTIONS) -> Findings:
    """Compare error estimates of ``engine`` with true errors in at least so many random motions."""
    found = calibrations(engine, motions)
    whole = Calibration.of(found.values())
    kinds = "; ".join(
        f"{kind} {100.0 * part.coverage:.1f} %, {part.over_estimate:.3g}" for kind, part in found.items()
    )
    note = (
        f"{len(whole.errors)} numbers from {whole.motions} motions, each with the estimate that all claims take. "
        f"True errors are against closed forms, or the reference at tolerance {TIGHT:g}. Coverage "
        f"{100.0 * whole.coverage:.2f} % with a standard error of {100.0 * whole.coverage_noise:.2f} %; median of "
        f"estimate over true error {whole.over_estimate:.3g}. By kind of problem: {kinds}."
    )
    claims = tuple(
        Claim(
            sentence,
            equation="",
            kind="trajectory",
            engine=engine.name,
            predicted=predicted,
            measured=measured,
            budget=ErrorBudget(0.0, model=allowed, resolution=allowed),
            parameters={"motions": whole.motions, "seed": SEED},
            source=SOURCE,
            note=note,
        )
        for sentence, predicted, measured, allowed in (
            (COVERS, 1.0, whole.coverage, 1.0 - LEAST_COVERAGE),
            (EXCEEDS, PROPORTIONAL, whole.over_estimate, MOST_OVER_ESTIMATE - PROPORTIONAL),
        )
    )
    return Findings(claims, {"errors": whole.errors, "estimates": whole.estimates, "ratios": whole.ratios})


def calibrations(engine: Engine, motions: int) -> dict[str, Calibration]:
    """Return the calibration of every kind of problem that ``engine`` can simulate."""
    mine = [
        kind
        for kind, problem in PROBLEMS.items()
        if engine.simulates(problem(np.random.default_rng()).system)
    ]
    each = -(-motions // len(mine))
    found = {}
    for kind in mine:
        # Of its own for each kind: every engine is asked the same questions.
        random = np.random.default_rng([SEED, list(PROBLEMS).index(kind)])
        found[kind] = calibrated(
            engine, ((PROBLEMS[kind](random), between(random, *TOLERANCES)) for _ in range(each))
        )
    return found


def draw(data: Mapping[str, Data]) -> dict[str, Figure]:
    """Estimates over true errors, and how they are distributed."""
    figure, (scatter, share) = new_figure(ncols=2, width=9.6, height=4.0)
    ends = np.array([1e-16, 1.0])
    for engine in engines_in(data):
        errors, estimates = data[engine]["errors"], data[engine]["estimates"]
        scatter.loglog(errors, estimates, **points(engine, markersize=2.0, markeredgewidth=0.5))
        ratios = np.sort(np.clip(data[engine]["ratios"], SMALLEST, LARGEST))
        share.semilogx(ratios, np.linspace(0.0, 1.0, len(ratios)), **curve(engine))
    scatter.plot(ends, ends, **curve("theory", "equal"))
    scatter.plot(
        ends, MOST_OVER_ESTIMATE * ends, **curve("theory", f"{MOST_OVER_ESTIMATE:g} times", linestyle=":")
    )
    scatter.set(xlim=ends, ylim=ends, xlabel="true error", ylabel="estimate")
    for ratio, linestyle in ((1.0, "-"), (MOST_OVER_ESTIMATE, ":")):
        share.axvline(ratio, color=BLACK, linewidth=0.8, linestyle=linestyle)
    share.set(xlim=(SMALLEST, LARGEST), xlabel="estimate / true error", ylabel="fraction of cases below")
    for panel in (scatter, share):
        panel.legend()
    return {"error-estimates": figure}


STUDY = Study(
    name="error-estimates",
    title="What the error bars are worth",
    paper="Not in the paper. All claims here allow for the numerical error that is estimated from the run itself: "
    f"{SAFETY:g} times its change when the tolerance is made {COARSENING:g} times smaller. In random motions whose "
    "end is known the true error must lie within that, and not far below. They last for one turn of the support and "
    "more: shorter ones may take the same few steps at any tolerance, whose errors no change of it shows.",
    measure=measure,
    draw=draw,
    figures={
        "error-estimates": "Left: estimates and true errors of random motions, as fractions of the largest number of "
        "each. Right: the fraction of cases whose estimate is below so many times the true error; it should be "
        "next to none at 1, and a half before 10."
    },
    section="The engines",
    seconds=20.0,
)
