"""What each recorded engine makes of each case: whether its motion comes to the exact one as the tolerance falls."""

from __future__ import annotations

from compare.claims.claim import Claim, ErrorBudget
from compare.claims.error_estimates import ROUNDING
from compare.claims.parameters import parameters_of
from compare.claims.study import Recorded
from compare.foreign.cases import CASES
from compare.foreign.records import ERROR, STEPS, TOLERANCE, Recording, estimate
from compare.studies.engines.foreign_engines.ladders import recorded

OUR_FORCE = "our force"
"""The setting of engines in which friction is none of theirs."""

IN_SHORT = {
    "slip": ("slides", "slip"),
    "stick-slip": ("sticks 9 times", "stick"),
    "whirl": ("whirls", "slip"),
    "stuck": ("stays stuck", "stick"),
    "release": ("lets go", "stick"),
    "disc": ("disc, 6 points", "slip"),
}
"""Of each case a name and whether it slips or sticks."""


def recorded_settings() -> tuple[Recorded, ...]:
    """Return what the report's matrix shows of each setting."""
    return tuple(recorded_claims(recording) for recording in recorded())


def recorded_claims(recording: Recording) -> Recorded:
    """Return the claim of each case that one setting of an engine simulates, from its finest run."""
    claims = []
    for name, runs in recording.runs.items():
        case = CASES[name]
        rounding = ROUNDING * max(map(abs, case.start))
        claims.append(
            Claim(
                case.sentence,
                equation=case.equation,
                kind=case.kind,
                engine=recording.name,
                predicted=0.0,
                measured=runs[-1, ERROR],
                budget=ErrorBudget(estimate(runs) + rounding, resolution=case.resolution),
                parameters=parameters_of(case.system)
                | {"tolerance": float(runs[-1, TOLERANCE]), "steps": float(runs[-1, STEPS])},
                source=f"Recorded on {recording.recorded} with {recording.engine} {recording.version}, "
                f"{recording.platform}; {case.title}",
                unit="m",
                note="How far the finest run is off the exact motion, the largest over time. Numerical error: what "
                "the last two refinements of the tolerance changed. Resolution: a tenth of what another law of "
                "friction, or a pin that lets go, would change.",
            )
        )
    return Recorded(
        recording.engine,
        recording.setting,
        recording.version,
        recording.recorded,
        tuple(claims),
        own=recording.setting != OUR_FORCE,
        cases={CASES[name].sentence: words for name, words in IN_SHORT.items()},
    )
