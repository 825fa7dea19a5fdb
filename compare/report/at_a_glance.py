"""The first screen of the report: a grade and a sentence for each engine, derived from its claims only."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from html import escape
from urllib.parse import quote

from compare.claims.claim import GRADES, Evidence, Verdict
from compare.claims.study import Recorded
from compare.report.matrix import VERDICTS, Cell, Matrix, RecordedMatrix, State
from compare.report.numbers import error_text
from compare.run.runner import Run

OTHER_LAW = 10.0
"""Change of a recorded motion due to another friction law, over the resolution of its claim."""

ROUGH, DIFFERS, OPEN = "rough", "differs", "open"
"""Grades beyond ``compare.claims.claim.Grade``: agreement with a larger error; a claim differs; nothing agrees."""


@dataclass(frozen=True)
class Glance:
    """Summary of one engine.

    ``cells`` are the recorded motions at its best setting, None for a motion that it does not simulate. ``where``
    links to the details.
    """

    engine: str
    version: str
    grade: str
    sentence: str
    where: str
    cells: tuple[Cell | None, ...] = ()


def glances(run: Run, matrix: Matrix) -> tuple[Glance, ...]:
    """Return the engines of this run, then the recorded engines, each at its best setting."""
    recorded = matrix.recorded[0] if matrix.recorded else None
    found = [_measured(run, matrix, engine, recorded) for engine in run.engines]
    if recorded is not None:
        others = {
            engine: _best(settings)
            for engine, settings in recorded.by_engine.items()
            if engine not in run.engines
        }
        order = sorted(others, key=lambda name: (_RANKS.index(_grade(others[name])), _share(others[name])))
        found += [_recorded(recorded, others[name], recorded.by_engine[name]) for name in order]
    return tuple(found)


_RANKS = [grade.value for grade in GRADES] + [ROUGH, OPEN, DIFFERS]
"""Grades, best first."""


def cases(recorded: RecordedMatrix) -> tuple[str, ...]:
    """Return a heading for each recorded motion."""
    first = recorded.settings[0]
    return tuple(first.cases.get(claim.sentence, (claim.sentence, ""))[0] for claim in recorded.claims)


def _measured(run: Run, matrix: Matrix, engine: str, recorded: RecordedMatrix | None) -> Glance:
    counts = matrix.count(engine)
    grades = matrix.grades(engine)
    if counts[State.DIFFERS] or counts[State.FAILED]:
        grade = DIFFERS
    elif counts[State.AGREES]:
        grade = next((one.value for one in reversed(GRADES) if grades[one]), ROUGH)
    else:
        grade = OPEN
    independent = matrix.of_evidence(INDEPENDENT, engine)
    agreeing = (
        f"{independent[State.AGREES]} of {sum(independent.values())} claims agree on independent evidence"
    )
    gaps = (State.DIFFERS, State.INCONCLUSIVE, State.FAILED, State.MISSING, State.NOT_SIMULATED)
    rest = [f"{counts[state]} {_verb(state, counts[state])}" for state in gaps if counts[state]]
    settings = recorded.by_engine.get(engine, []) if recorded is not None else []
    if settings and grade != DIFFERS:  # compare all engines by the same motions
        grade = _grade(settings[0])
    errors = _errors(settings[0]) if settings else ""
    parts = [agreeing, *rest, *([errors] if errors else [])]
    cells = recorded.cells(settings[0]) if recorded is not None and settings else ()
    where = f"?engine={quote(engine)}#studies"
    return Glance(engine, run.versions.get(engine, ""), grade, f"{'; '.join(parts)}.", where, cells)


INDEPENDENT: Evidence = "independent"


def _verb(state: State, count: int) -> str:
    return "differ" if state is State.DIFFERS and count > 1 else state.value


def _best(settings: Sequence[Recorded]) -> Recorded:
    """Return the setting with the fewest claims that do not agree; of several, the one with the most that do."""

    def badness(setting: Recorded) -> tuple[int, int, float]:
        agree = sum(claim.verdict is Verdict.AGREES for claim in setting.claims)
        return len(setting.claims) - agree, -agree, _share(setting)

    return min([setting for setting in settings if setting.own] or settings, key=badness)


def _recorded(recorded: RecordedMatrix, best: Recorded, settings: Sequence[Recorded]) -> Glance:
    """Return the summary of a recorded engine: its best setting, and the settings that differ."""
    cells = recorded.cells(best)
    names = cases(recorded)
    parts = [f"{best.setting}: {_errors(best)}" if best.setting else _errors(best)]
    for state, word in ((State.DIFFERS, "differs"), (State.INCONCLUSIVE, "too coarse to decide")):
        listed = [name for name, cell in zip(names, cells, strict=True) if cell and cell.state is state]
        parts += [f"{word}: {', '.join(listed)}"] if listed else []
    lacking = [name for name, cell in zip(names, cells, strict=True) if cell is None]
    parts += [f"not simulated: {', '.join(lacking)}"] if lacking else []
    wrong = [one.setting for one in settings if one is not best and _grade(one) == DIFFERS]
    parts += [f"another friction law with {', '.join(wrong)}"] if wrong else []
    return Glance(
        best.engine,
        best.version,
        _grade(best),
        f"{'; '.join(parts)}.",
        f"#{recorded.study.name}-recorded",
        cells,
    )


def _errors(setting: Recorded) -> str:
    """Return the largest errors of agreeing motions, separately for slipping and for stick and release."""
    words = []
    for part, name in (("slip", "slipping"), ("stick", "in stick and release")):
        claims = [
            claim
            for claim in setting.claims
            if setting.cases.get(claim.sentence, ("", ""))[1] == part and claim.verdict is Verdict.AGREES
        ]
        if claims:
            largest = max(claims, key=lambda claim: float(claim.difference.max()))
            words.append(f"≤ {error_text(float(largest.difference.max()), 1)} {largest.unit} {name}")
    return ", ".join(words)


def _share(setting: Recorded) -> float:
    """Return the largest error of agreeing motions, relative to the change due to another friction law."""
    return max(
        (
            float(max(claim.difference.max(), claim.budget.total.max()))
            / (OTHER_LAW * claim.budget.resolution)
            for claim in setting.claims
            if claim.verdict is Verdict.AGREES
        ),
        default=0.0,
    )


def _grade(setting: Recorded) -> str:
    """Return the grade of a setting: its error relative to the change due to another friction law."""
    verdicts = {claim.verdict for claim in setting.claims}
    if Verdict.DIFFERS in verdicts:
        return DIFFERS
    if Verdict.AGREES not in verdicts:
        return OPEN
    share = _share(setting)
    return next((grade.value for grade, largest in GRADES.items() if share <= largest), ROUGH)


# --- ``badge.svg``: the number of agreeing claims, for a README.

LABEL = "friction-discs"

GREEN, BROWN, RED = "#1d5c38", "#7a5200", "#9c1c1c"
"""Colours of the page; the contrast of white letters is at least 6.9:1."""

WIDTH, MARGIN = 6.6, 12.0
"""Width of a letter, and both margins together, in pixels."""


def badge(matrix: Matrix) -> str:
    """Return an SVG with the number of agreeing verdicts; its colour shows whether any differs or is inconclusive."""
    counts = matrix.totals
    words = f"{counts[State.AGREES]} of {sum(counts[state] for state in (*VERDICTS, State.FAILED))} agree"
    bad = counts[State.DIFFERS] + counts[State.FAILED]
    colour = RED if bad else BROWN if counts[State.INCONCLUSIVE] or not counts[State.AGREES] else GREEN
    left, right = (round(WIDTH * len(text) + MARGIN) for text in (LABEL, words))
    said = escape(f"{LABEL}: {words}")
    size = f'width="{left + right}" height="20"'
    return f"""<svg xmlns="http://www.w3.org/2000/svg" {size} role="img" aria-label="{said}">
<title>{said}</title>
<rect {size} rx="3" fill="#333"/>
<path d="M{left} 0h{right - 3}a3 3 0 0 1 3 3v14a3 3 0 0 1 -3 3h-{right - 3}z" fill="{colour}"/>
<g fill="#fff" font-family="Verdana,DejaVu Sans,sans-serif" font-size="11" text-anchor="middle">
<text x="{left / 2:g}" y="14">{LABEL}</text>
<text x="{left + right / 2:g}" y="14">{escape(words)}</text>
</g>
</svg>
"""
