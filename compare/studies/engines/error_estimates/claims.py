"""What the error bars of all claims are worth: true errors of random motions beside their estimates."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from compare.claims.claim import Claim, ErrorBudget
from compare.claims.error_estimates import COARSENING, ROUNDING, SAFETY
from compare.claims.study import Data, Findings, Study
from compare.engines import Engine
from compare.figures import BLACK, curve, engines_in, new_figure, points
from compare.studies.engines.error_estimates.calibration import KNOWN, Calibration, calibrated
from compare.studies.engines.error_estimates.problems import PROBLEMS, TIGHT, between

if TYPE_CHECKING:
    from matplotlib.figure import Figure

MOTIONS = 360
"""Random motions for an engine, as many of every kind of problem that it can simulate."""

TOLERANCES = (1e-7, 1e-5)
"""Between these the tolerance of a motion is drawn."""

SEED = 20

LEAST_COVERAGE, MOST_OVER_ESTIMATE = 0.99, 30.0
"""What error bars must reach to mean something, in each kind of motion."""

PROPORTIONAL = SAFETY * (1.0 - 1.0 / COARSENING)
"""Estimate over true error where errors are in proportion to the tolerance."""

COVERS = (
    f"In at least {100 * LEAST_COVERAGE:g} % of random cases the true error lies within its estimate: {{}}"
)
EXCEEDS = f"In the median the estimate is not more than {MOST_OVER_ESTIMATE:g} times the true error: {{}}"

SOURCE = (
    f"assumption: parameters, starts, times and tolerances (from {TOLERANCES[0]:g} to {TOLERANCES[1]:g}) "
    "are random"
)

SMALLEST, LARGEST = 1e-1, 1e4
"""Ratios of estimate and true error that the figure shows."""


def measure(engine: Engine, motions: int = MOTIONS) -> Findings:
    """Compare error estimates of ``engine`` with true errors in at least so many random motions."""
    found = calibrations(engine, motions)
    claims = [claim for kind, part in found.items() for claim in claims_of(engine, kind, part)]
    whole = Calibration.of(found.values())
    data = {
        "errors": whole.errors,
        "estimates": whole.estimates,
        "coverage": np.array([part.coverage for part in found.values()]),
        "over-estimate": np.array([part.over_estimate for part in found.values()]),
    }
    return Findings(tuple(claims), data | {f"ratios: {kind}": part.ratios for kind, part in found.items()})


def claims_of(engine: Engine, kind: str, part: Calibration) -> tuple[Claim, Claim]:
    """Claim coverage and over-estimate of one kind of motion."""
    note = (
        f"{len(part.errors)} numbers from {part.motions} motions, each with the estimate that all claims take. "
        f"True errors are against closed forms, or the reference at tolerance {TIGHT:g}. Coverage "
        f"{100.0 * part.coverage:.2f} % with a standard error of {100.0 * part.coverage_noise:.2f} %; median of "
        f"estimate over true error {part.over_estimate:.3g}. Where errors are in proportion to the tolerance that is "
        f"{SAFETY:g}·(1 − 1/{COARSENING:g}) = {PROPORTIONAL:g} by construction; where no error depends on the "
        f"tolerance, as in the closed form of stick, it is rounding as allowed for over rounding as known, "
        f"{ROUNDING / KNOWN:g}."
    )

    def claim(sentence: str, predicted: float, measured: float, allowed: float) -> Claim:
        return Claim(
            sentence.format(kind),
            equation="",
            kind="trajectory",
            engine=engine.name,
            predicted=predicted,
            measured=measured,
            budget=ErrorBudget(0.0, model=allowed, resolution=allowed),
            parameters={"motions": part.motions, "seed": SEED},
            source=SOURCE,
            note=note,
        )

    return (
        claim(COVERS, 1.0, part.coverage, 1.0 - LEAST_COVERAGE),
        claim(EXCEEDS, PROPORTIONAL, part.over_estimate, MOST_OVER_ESTIMATE - PROPORTIONAL),
    )


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
    """Draw estimates over true errors, and for each kind of motion how far they lie above."""
    figure, (scatter, spread) = new_figure(ncols=2, width=10.6, height=4.4)
    ends = np.array([1e-16, 1.0])
    names, kinds = engines_in(data), list(PROBLEMS)
    for engine in names:
        errors, estimates = data[engine]["errors"], data[engine]["estimates"]
        scatter.loglog(errors, estimates, **points(engine, markersize=2.0, markeredgewidth=0.5))
    scatter.plot(ends, ends, **curve("theory", "equal"))
    scatter.plot(
        ends, MOST_OVER_ESTIMATE * ends, **curve("theory", f"{MOST_OVER_ESTIMATE:g} times", linestyle=":")
    )
    scatter.set(xlim=ends, ylim=ends, xlabel="true error", ylabel="estimate")
    for i, engine in enumerate(names):
        shift = 0.5 * ((i + 0.5) / len(names) - 0.5)
        for row, kind in enumerate(kinds):
            if f"ratios: {kind}" not in data[engine]:
                continue
            low, middle, high = np.clip(
                np.quantile(data[engine][f"ratios: {kind}"], (1.0 - LEAST_COVERAGE, 0.5, LEAST_COVERAGE)),
                SMALLEST,
                LARGEST,
            )
            look = points(engine, "_", markersize=4.0)
            spread.errorbar(
                middle, row + shift, xerr=[[middle - low], [high - middle]], elinewidth=0.8, **look
            )
    for ratio, linestyle in ((1.0, "-"), (MOST_OVER_ESTIMATE, ":")):
        spread.axvline(ratio, color=BLACK, linewidth=0.8, linestyle=linestyle)
    spread.set(xscale="log", xlim=(SMALLEST, LARGEST), xlabel="estimate / true error")
    spread.set_yticks(range(len(kinds)), kinds)
    spread.invert_yaxis()
    scatter.legend()
    return {"error-estimates": figure}


STUDY = Study(
    name="error-estimates",
    title="What the error bars are worth",
    paper="Not in the paper. All claims here allow for the numerical error that is estimated from the run itself: "
    f"{SAFETY:g} times its change when the tolerance is made {COARSENING:g} times smaller. In random motions whose "
    "end is known the true error must lie within that, and not far below. They last for one turn of the support and "
    "more: shorter ones may take the same few steps at any tolerance, whose errors no change of it shows. Each kind "
    "of motion counts for itself: together, good ones would hide bad ones.",
    by_hand=measure,
    draw=draw,
    figures={
        "error-estimates": "Left: estimates and true errors of random motions, as fractions of the largest number of "
        f"each. Right: how many times the true error the estimate is, for each kind of motion: the median, and from "
        f"{100 - 100 * LEAST_COVERAGE:g} to {100 * LEAST_COVERAGE:g} % of all numbers. It should begin at 1, and the "
        f"median lie before {MOST_OVER_ESTIMATE:g}."
    },
    section="The engines",
    seconds=20.0,
)
