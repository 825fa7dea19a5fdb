"""The first screen of the report: a grade and a sentence for each engine, derived from its claims."""

from collections.abc import Sequence
from dataclasses import dataclass
from html import escape
from urllib.parse import quote

from compare.claims.claim import GRADES, Claim, Verdict
from compare.claims.validation import Recorded
from compare.report.matrix import VERDICTS, Cell, Matrix, RecordedMatrix, State
from compare.run.runner import Run

OTHER_LAW = 10.0
"""Change of a recorded motion due to another friction law, in resolutions of its claim."""

ROUGH, DIFFERS, OPEN = "rough", "differs", "open"
"""Grades beyond ``compare.claims.claim.Grade``: agreement with a larger error; a claim differs; nothing agrees."""


@dataclass(frozen=True)
class Glance:
    """Summary of one engine.

    ``cells`` are the recorded motions at its best setting, None if not simulated. ``where`` links to its claims, and
    ``why`` to the reasons for its grade.
    """

    engine: str
    version: str
    grade: str
    sentence: str
    where: str
    why: str
    cells: tuple[Cell | None, ...] = ()


def glances(run: Run, matrix: Matrix) -> tuple[Glance, ...]:
    """Return the engines that this run measured, then the recorded engines at their best settings."""
    recorded = matrix.recorded[0] if matrix.recorded else None
    known = {*matrix.columns, *(recorded.by_engine if recorded is not None else ())}
    found = [_measured(run, matrix, engine, recorded) for engine in run.engines if engine in known]
    if recorded is not None:
        others = {
            engine: best_of(settings)
            for engine, settings in recorded.by_engine.items()
            if engine not in run.engines
        }
        order = sorted(others, key=lambda name: (_RANKS.index(_grade(others[name])), _share(others[name])))
        found += [_recorded(recorded, others[name]) for name in order]
    return tuple(found)


_RANKS = [grade.value for grade in GRADES] + [ROUGH, OPEN, DIFFERS]


def cases(recorded: RecordedMatrix) -> dict[str, str]:
    """Return the name of each recorded motion, and the source of its exact course."""
    setting = recorded.settings[0]
    return {_case(setting, one): setting.cases.get(one.sentence, ("", ""))[1] for one in recorded.claims}


def _case(setting: Recorded, claim: Claim) -> str:
    return setting.cases.get(claim.sentence, (claim.sentence, ""))[0]


def _measured(run: Run, matrix: Matrix, engine: str, recorded: RecordedMatrix | None) -> Glance:
    counts = matrix.count(engine)
    grades = matrix.grades(engine)
    if counts[State.DIFFERS] or counts[State.FAILED]:
        grade = DIFFERS
    elif counts[State.AGREES]:
        grade = next((one.value for one in reversed(GRADES) if grades[one]), ROUGH)
    else:
        grade = OPEN
    where = why = f"?engine={quote(engine)}#studies"
    sentences, share = _counted(matrix, engine), run.share(engine)
    if share.measured < share.of:
        sentences.append(share.in_words("claim"))
    cells: tuple[Cell | None, ...] = ()
    settings = recorded.by_engine.get(engine, []) if recorded is not None else []
    if recorded is not None and settings:
        best = settings[0]
        if grade != DIFFERS:  # compare all engines by the same motions
            grade, why = _grade(best), f"#{recorded.anchor(engine)}"
        sentences = [*_judged(best), *([best.advice] if best.advice else []), *sentences]
        cells = recorded.cells(best)
    version = run.versions.get(engine, "")
    return Glance(engine, version, grade, _joined(sentences), where, why, cells)


def _counted(matrix: Matrix, engine: str) -> list[str]:
    independent, counts = matrix.of_evidence("independent", engine), matrix.count(engine)
    agreeing, total = independent[State.AGREES], sum(independent.values())
    share = f"all {total}" if 1 < agreeing == total else f"{agreeing} of {total}"
    sentences = [f"{share} checks against independent evidence agree"] if total else []
    gaps = [f"{counts[state]} {verbs[counts[state] > 1]}" for state, verbs in GAPS.items() if counts[state]]
    if gaps:
        count, rest = _listed(gaps).split(" ", 1)
        sentences.append(f"{count} {'check' if count == '1' else 'checks'} {rest}")
    return sentences


GAPS = {
    State.DIFFERS: ("differs", "differ"),
    State.INCONCLUSIVE: ("is inconclusive", "are inconclusive"),
    State.FAILED: ("failed", "failed"),
    State.MISSING: ("is missing", "are missing"),
    State.NOT_SIMULATED: ("was not simulated", "were not simulated"),
}
"""Verbs for one check and for several checks without agreement."""


def best_of(settings: Sequence[Recorded]) -> Recorded:
    """Return the setting with the fewest claims that do not agree; among several, with the most agreements."""

    def badness(setting: Recorded) -> tuple[int, int, float]:
        agree = sum(claim.verdict is Verdict.AGREES for claim in setting.claims)
        return len(setting.claims) - agree, -agree, _share(setting)

    return min([setting for setting in settings if setting.own] or settings, key=badness)


def _recorded(recorded: RecordedMatrix, best: Recorded) -> Glance:
    cells = recorded.cells(best)
    first, *more = _judged(best)
    sentences = [f"with {_named([best.setting])}, {first}" if best.setting else first, *more]
    if best.advice:
        others = any(claim.verdict is Verdict.DIFFERS for claim in best.claims)
        sentences.append(f"in the other motions, {best.advice}" if others else best.advice)
    for claim in best.claims:
        if claim.verdict is Verdict.INCONCLUSIVE:
            sentences.append(f"“{_case(best, claim)}” is undecided: {best.reasons.get(claim.sentence, '')}")
    if lacking := [name for name, cell in zip(cases(recorded), cells, strict=True) if cell is None]:
        sentences.append(f"we did not simulate {_quoted(lacking)}")
    avoided: dict[tuple[str, ...], list[str]] = {}
    for one in recorded.by_engine[best.engine]:
        if one is not best and _grade(one) == DIFFERS:
            avoided.setdefault(_judged(one), []).append(one.setting)
    for (reason, *more), names in avoided.items():
        sentences += [f"avoid {_named(names)}, because {reason}", *more]
    anchor = recorded.anchor(best.engine)
    where = f"?engine={quote(best.engine)}#{quote(anchor)}"
    return Glance(best.engine, best.version, _grade(best), _joined(sentences), where, f"#{anchor}", cells)


def _named(settings: Sequence[str]) -> str:
    named = [name for name in settings if name != SHIPPED]
    noun = f"the setting{'s' * (len(named) > 1)} "
    words = [noun + _quoted(named)] if named else []
    return " and ".join(words + ["the default settings"] * (len(named) < len(settings)))


def _quoted(names: Sequence[str]) -> str:
    return _listed([f"“{name}”" for name in names])


def _listed(words: Sequence[str]) -> str:
    *first, last = words
    return f"{', '.join(first)} and {last}" if first else last


SHIPPED = "as shipped"


def _judged(setting: Recorded) -> tuple[str, ...]:
    """Return one or two sentences, to be capitalised. The first may follow "with the setting X" or "because"."""
    wrong = [_case(setting, claim) for claim in setting.claims if claim.verdict is Verdict.DIFFERS]
    if not wrong:
        agrees = any(claim.verdict is Verdict.AGREES for claim in setting.claims)
        right = "friction is Coulomb's, and the error decreases as the step is refined"
        return (right if agrees else "the errors are too large to decide",)
    total = len(setting.claims)
    share = f"all {total}" if 1 < len(wrong) == total else f"{len(wrong)} of {total}"
    which = f" ({_quoted(wrong)})" if len(wrong) <= MOST_NAMED else ""
    text = f"{share} motions{which} {'is' if len(wrong) == 1 else 'are'} wrong"
    off = f"the radius of the whirl is {100.0 * setting.whirl:.0f} % off"
    whirl = f", and {off}" if setting.whirl > LEAST_SHARE else ""
    if setting.law in ("", CONE):
        differing = (claim.sentence for claim in setting.claims if claim.verdict is Verdict.DIFFERS)
        reasons = dict.fromkeys(filter(None, (setting.reasons.get(one) for one in differing)))
        return (f"{text} at any step{whirl}", *reasons)
    return f"a {setting.law} replaces the friction cone", f"at any step, {text}{whirl}"


MOST_NAMED = 2

LEAST_SHARE = 0.01
"""Smallest relative error of the radius of a whirl that a sentence names."""

CONE = "cone"
"""Name of Coulomb's law, as in ``compare.diagnosis.laws``."""


def _joined(sentences: Sequence[str]) -> str:
    return " ".join(f"{text[0].upper()}{text[1:]}." for text in sentences)


def _share(setting: Recorded) -> float:
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
"""Width of a letter, and of both margins together, in pixels."""


def badge(matrix: Matrix) -> str:
    """Return an SVG with the number of agreeing verdicts, coloured by the worst verdict."""
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
