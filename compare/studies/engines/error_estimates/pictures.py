"""Estimates beside true errors."""

from __future__ import annotations

import numpy as np

from compare.claims.study import ByEngine, Figures
from compare.output.figures import BLACK, curve, engines_in, new_figure, points
from compare.studies.engines.error_estimates.parameters import LEAST_COVERAGE, MOST_OVER_ESTIMATE
from compare.studies.engines.error_estimates.problems import PROBLEMS

SMALLEST, LARGEST = 1e-1, 1e4
"""Ratios of estimate and true error that the figure shows."""


def draw(data: ByEngine) -> Figures:
    """Draw estimates over true errors, and for each kind of motion how far they lie above."""
    figure, (scatter, spread) = new_figure(ncols=2, width=10.6, height=4.4)
    ends = np.array([1e-16, 1.0])
    names, kinds = engines_in(data), list(PROBLEMS)
    for engine in names:
        errors, estimates = (
            np.concatenate(
                [data[engine][f"{kind}: {what}"] for kind in kinds if f"{kind}: errors" in data[engine]]
            )
            for what in ("errors", "estimates")
        )
        scatter.loglog(errors, estimates, **points(engine, markersize=2.0, markeredgewidth=0.5))
    scatter.plot(ends, ends, **curve("theory", "equal"))
    scatter.plot(
        ends, MOST_OVER_ESTIMATE * ends, **curve("theory", f"{MOST_OVER_ESTIMATE:g} times", linestyle=":")
    )
    scatter.set(xlim=ends, ylim=ends, xlabel="true error", ylabel="estimate")
    for i, engine in enumerate(names):
        shift = 0.5 * ((i + 0.5) / len(names) - 0.5)
        for row, kind in enumerate(kinds):
            if f"{kind}: ratios" not in data[engine]:
                continue
            low, middle, high = np.clip(
                np.quantile(data[engine][f"{kind}: ratios"], (1.0 - LEAST_COVERAGE, 0.5, LEAST_COVERAGE)),
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
