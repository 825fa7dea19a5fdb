"""Claims."""

import functools

import numpy as np

import compare.studies.engines.error_estimates.theory as theory
from compare.claims import COARSENING, ROUNDING, SAFETY, ByEngine, Figures, Measured, Study
from compare.engines import Engine
from compare.output.figures import Axes, curve, engines_in, new_figure, points
from compare.studies.toolkit.random_systems import between

PROPORTIONAL = SAFETY * (1.0 - 1.0 / COARSENING)
"""Ratio of estimate to true error if errors are proportional to the tolerance."""

KNOWN_FROM = (
    "Every number has the estimate that all claims use. True errors refer to closed forms, or to the reference at "
    f"tolerance {theory.EXACT:g}."
)

STUDY = Study.beside(
    __file__,
    "error-estimates",
    words={"safety": f"{SAFETY:g}", "coarsening": f"{COARSENING:g}"},
    source=theory.SOURCE,
    seconds=3.5,
)


@STUDY.claim(
    f"In at least {100 * theory.LEAST_COVERAGE:g} % of random cases the true error lies within its estimate: {{}}",
    kind="trajectory",
    resolution=1.0 - theory.LEAST_COVERAGE,
    note=KNOWN_FROM,
    each=tuple(theory.PROBLEMS),
)
def coverage(engine: Engine, kind: str, motions: int = theory.MOTIONS) -> Measured:
    found = calibration(engine, kind, motions)
    return Measured(
        predicted=1.0,
        value=found.coverage,
        model=1.0 - theory.LEAST_COVERAGE,
        parameters={"motions": found.motions, "seed": theory.SEED},
        note=f"{len(found.errors)} numbers from {found.motions} motions; standard error of the coverage: "
        f"{100.0 * found.coverage_noise:.2f} %.",
        data={f"{kind}: errors": found.errors, f"{kind}: estimates": found.estimates},
        friction=kind not in theory.FRICTIONLESS,
    )


@STUDY.claim(
    f"The median ratio of estimate to true error is at most {theory.MOST_OVER_ESTIMATE:g}: {{}}",
    kind="trajectory",
    resolution=theory.MOST_OVER_ESTIMATE - PROPORTIONAL,
    friction=False,
    note=f"{KNOWN_FROM} If errors are proportional to the tolerance, the ratio is {SAFETY:g}·(1 − 1/{COARSENING:g}) "
    f"= {PROPORTIONAL:g} by construction. If errors do not depend on the tolerance, as in the closed form of stick, "
    f"the ratio is {ROUNDING / theory.KNOWN:g}, the allowed rounding over the known rounding.",
    each=tuple(theory.PROBLEMS),
)
def over_estimate(engine: Engine, kind: str, motions: int = theory.MOTIONS) -> Measured:
    found = calibration(engine, kind, motions)
    return Measured(
        predicted=PROPORTIONAL,
        value=found.over_estimate,
        model=theory.MOST_OVER_ESTIMATE - PROPORTIONAL,
        parameters={"motions": found.motions, "seed": theory.SEED},
        note=f"{len(found.errors)} numbers from {found.motions} motions.",
    )


@functools.lru_cache(maxsize=len(theory.PROBLEMS))
def calibration(engine: Engine, kind: str, motions: int) -> theory.Calibration:
    """Return the calibration for one kind of problem; all simulated kinds share ``motions``."""
    each = -(-motions // len(simulated(engine)))
    return theory.calibrated(engine, drawn(kind, each))


@functools.lru_cache(maxsize=len(theory.PROBLEMS))
def drawn(kind: str, motions: int) -> tuple[tuple[theory.Problem, float], ...]:
    """Return ``motions`` problems of a kind with their tolerances, the same for every engine."""
    random = np.random.default_rng([theory.SEED, list(theory.PROBLEMS).index(kind)])  # one stream per kind
    return tuple((theory.PROBLEMS[kind](random), between(random, *theory.TOLERANCES)) for _ in range(motions))


@functools.lru_cache(maxsize=1)
def simulated(engine: Engine) -> tuple[str, ...]:
    return tuple(
        kind
        for kind, problem in theory.PROBLEMS.items()
        if engine.simulates(problem(np.random.default_rng(theory.SEED)).system)
    )


COLUMNS = 3


def draw(data: ByEngine) -> Figures:
    kinds = list(theory.PROBLEMS)
    rows = -(-len(kinds) // COLUMNS)
    figure, panels = new_figure(ncols=COLUMNS, nrows=rows, width=10.0, height=2.9 * rows)
    for panel, kind in zip(panels, kinds, strict=False):
        panel.set_title(kind)
        seen = []
        for engine in engines_in(data):
            if f"{kind}: errors" in data[engine]:
                errors, estimates = (data[engine][f"{kind}: {what}"] for what in ("errors", "estimates"))
                right = errors > 0.0  # the logarithmic axis cannot show zero
                seen += [errors[right], estimates[right]]
                look = points(engine, markersize=3.0, markeredgewidth=0.6)
                panel.loglog(errors[right], estimates[right], **look)
        if seen:
            _draw_bounds(panel, np.concatenate(seen))
    for panel in panels[len(kinds) :]:
        panel.axis("off")
    figure.supxlabel("true error, relative to the largest number", fontsize=11.0)
    figure.supylabel("estimate, relative to the largest number", fontsize=11.0)
    figure.legend(*panels[0].get_legend_handles_labels(), loc="outside upper right", ncols=4)
    return {"error-estimates": figure}


def _draw_bounds(panel: Axes, seen: np.ndarray) -> None:
    ends = np.array([0.3 * np.min(seen), 3.0 * np.max(seen)])
    panel.plot(ends, ends, **curve("theory", "equal"))
    label = f"{theory.MOST_OVER_ESTIMATE:g} times"
    panel.plot(ends, theory.MOST_OVER_ESTIMATE * ends, **curve("theory", label, linestyle=":"))
    panel.set(xlim=ends, ylim=ends)


STUDY.provides(figures=draw)
