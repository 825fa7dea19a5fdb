"""``index.html``: one page with all texts and numbers; pictures are separate files."""

import functools
import shlex
from collections import Counter
from collections.abc import Mapping
from typing import Any
from urllib.parse import quote

from jinja2 import Environment, PackageLoader, StrictUndefined
from markupsafe import Markup

from compare.claims.claim import EVIDENCE, GRADES, THEORY, Claim, Evidence
from compare.claims.errata import TEXT
from compare.claims.study import Study
from compare.report import quotes
from compare.report.at_a_glance import Glance, cases
from compare.report.matrix import GRADE_SYMBOLS, WORST_FIRST, Matrix, Row, State, state_of
from compare.report.numbers import answers_text, error_text, in_short, trimmed, unbroken, value_text, worst
from compare.report.results_json import erratum_id
from compare.run.provenance import ROOT, address_of
from compare.run.runner import Run
from compare.run.store import Drawing
from compare.run.workers import Failure
from reference_model.systems import UNITS

HERO = "drivetrain-picture"


def page(
    run: Run,
    matrix: Matrix,
    stamp: Mapping[str, str],
    paths: Mapping[str, str],
    glances: tuple[Glance, ...],
) -> str:
    """Return the HTML of the report; ``paths`` are the claims' tables by identity."""
    return unbroken(
        environment()
        .get_template("index.html.j2")
        .render(
            run=run,
            matrix=matrix,
            stamp=stamp,
            State=State,
            EVIDENCE=EVIDENCE,
            TEXT=TEXT,
            GRADES=GRADES,
            GRADE_SYMBOLS=GRADE_SYMBOLS,
            kinds=[evidence for evidence in EVIDENCE if matrix.of_evidence(evidence)],
            summary=summary(matrix),
            counted=counted(matrix),
            paths=paths,
            glances=glances,
            seen={one.grade for one in glances},
            grades=[
                grade for grade in GRADES if any(matrix.grades(column)[grade] for column in matrix.columns)
            ],
            recorded_cases=cases(matrix.recorded[0]) if matrix.recorded else {},
            explained=lambda cell: "; ".join(filter(None, (cell.reason, cell.cost))),
            deviation=lambda cell: error_text(max(float(claim.difference.max()) for claim in cell.claims), 1),
            hero=_hero(run),
            filters=_filters(matrix),
            erratum_id=erratum_id,
            claim_commands=functools.partial(_claim_commands, run.seed),
            recorded_summaries=[(recorded, _in_words(recorded.totals)) for recorded in matrix.recorded],
            exceptions=_exceptions(matrix),
            once=lambda state: "; ".join(dict.fromkeys("; ".join(matrix.reasons(state)).split("; "))),
            worst=worst,
            in_short=in_short,
            state_of=state_of,
            measuring=_measuring,
            particular=_particular,
            common=_common,
            findings=[study for study in matrix.studies if _is_answered(study, matrix.of(study))],
            quoting=_quoting,
            pictures=lambda study: _pictures(run, study),
            drawing_failed=lambda study: _reason(run.drawings.get(study.name)),
            commands=lambda study: _commands(run, study),
            failed=lambda value: isinstance(value, Failure),
        )
    )


@functools.cache
def environment() -> Environment:
    """Return the environment of the templates."""
    result = Environment(
        loader=PackageLoader("compare.report"),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    result.filters.update(
        number=lambda value: _data(value, error_text(value)),
        value=lambda value, uncertainty: _data(value, value_text(value, uncertainty)),
        exact=lambda value: _data(value, trimmed(value)),
        answers=lambda value: _data(value, answers_text(value)),
        paragraphs=lambda text: [one.strip() for one in text.split("\n\n") if one.strip()],
        urlpath=quote,
    )
    return result


def summary(matrix: Matrix) -> str:
    """Return the headline: "41 checks against independent evidence and 7 others agree, 1 differs, 0 inconclusive".

    The sentence also says how many independent verdicts would fail with half the friction force, unless all would.
    """
    count, of_friction = matrix.of_evidence("independent")[State.AGREES], matrix.of_friction()
    more = matrix.totals[State.AGREES] - count
    tested = f" ({of_friction} of them test the friction force)" if of_friction < count else ""
    others = f" and {more} other{'s' * (more != 1)}" if more else ""
    return (
        f"{_number_of('check', count)} against independent evidence{tested}{others} {_agree(count + more)}, "
        f"{_others_in_words(matrix.totals)}"
    )


def counted(matrix: Matrix) -> str:
    """Return how the number of checks follows from the number of claims."""
    of_kind = [
        f"{sum(matrix.of_evidence(kind).values())} {words}"
        for kind, words in KINDS.items()
        if matrix.of_evidence(kind)
    ]
    gaps = [f"{matrix.totals[state]} {state.value}" for state in GAPS if matrix.totals[state]]
    *first, last = of_kind + gaps or ["none"]
    listed = f"{', '.join(first)} and {last}" if first else last
    claims, checks = _number_of("claim", len(matrix.rows)), _number_of("check", len(matrix.cells))
    return f"{claims}, {checks} (each claim in every engine of its study): {listed}."


def _number_of(noun: str, count: int) -> str:
    return f"{count} {noun}{'s' * (count != 1)}"


KINDS: dict[Evidence, str] = {
    "independent": "against independent evidence",
    "self-check": "self-checks",
    "algebra": "of algebra",
    "implied": "implied by others",
}

GAPS = (State.FAILED, State.MISSING, State.NOT_SIMULATED)


def _in_words(totals: Counter[State]) -> str:
    agreeing = totals[State.AGREES]
    return f"{agreeing} {_agree(agreeing)}, {_others_in_words(totals)}"


def _agree(count: int) -> str:
    return "agrees" if count == 1 else "agree"


def _others_in_words(totals: Counter[State]) -> str:
    words = [
        f"{totals[State.DIFFERS]} differ" + "s" * (totals[State.DIFFERS] == 1),
        f"{totals[State.INCONCLUSIVE]} inconclusive",
    ]
    return ", ".join(words + [f"{totals[state]} {state.value}" for state in GAPS if totals[state]])


def _exceptions(matrix: Matrix) -> list[tuple[State, str, str]]:
    """Return state, text and anchor of claims that differ or are inconclusive and of failed engines, worst first."""
    found: dict[tuple[State, str, str], list[str]] = {}
    for row in matrix.rows:
        for column, cell in row.cells.items():
            if cell.state is State.FAILED:  # with all claims of the study
                text, target = f"{row.study.title}: {cell.reason}", row.study.name
            elif cell.state in (State.DIFFERS, State.INCONCLUSIVE):
                text, target = row.sentence, row.identity
            else:
                continue
            columns = found.setdefault((cell.state, text, target), [])
            columns += [column] if column not in columns else []
    lines = [
        (state, f"{', '.join(columns)}: {text}", target) for (state, text, target), columns in found.items()
    ]
    return sorted(lines, key=lambda line: WORST_FIRST.index(line[0]))


def _measuring(row: Row) -> tuple[str, str] | None:
    """Return file and line of the function that measures a claim, and its web address; None if unknown."""
    if row.declared is None:
        return None
    file, line = row.declared.place
    inside = file.is_relative_to(ROOT)
    path = file.relative_to(ROOT).as_posix() if inside else file.name
    return f"{path}:{line}", address_of(path, line) if inside else ""


def _particular(row: Row, claim: Claim) -> str:
    shared = _shared_parameters(row.claims)
    return _parameters({name: value for name, value in claim.parameters.items() if name not in shared})


def _common(row: Row) -> dict[str, Any]:
    return {
        "parameters": _parameters(_shared_parameters(row.claims)),
        "sources": _by_engine(row, "source"),
        "notes": _by_engine(row, "note"),
    }


def _shared_parameters(claims: tuple[Claim, ...]) -> dict[str, Any]:
    first = claims[0].parameters if claims else {}
    return {
        name: value
        for name, value in first.items()
        if all(repr(claim.parameters.get(name)) == repr(value) for claim in claims)  # NaN equals NaN
    }


def _by_engine(row: Row, attribute: str) -> list[str]:
    texts: dict[str, list[str]] = {}
    for claim in row.claims:
        text = getattr(claim, attribute)
        if text and claim.engine not in texts.setdefault(text, []):
            texts[text].append(claim.engine)
    if len(texts) <= 1:
        return list(texts)
    return [f"{', '.join(engines)}: {text}" for text, engines in texts.items()]


def _parameters(parameters: Mapping[str, Any]) -> str:
    said = {
        name: trimmed(float(value)) if isinstance(value, int | float) else value
        for name, value in parameters.items()
    }
    return ", ".join(f"{name} = {text} {UNITS.get(name, '')}".rstrip() for name, text in said.items())


def _is_answered(study: Study, own: Matrix) -> bool:
    """Return whether a study's finding may be shown: its claims agree, and its numbers were measured."""
    return (
        bool(study.prose.finding)
        and own.agrees
        and quotes.MISSING not in quotes.filled(study.prose.finding, own.claims)
    )


def _quoting(own: Matrix, text: str) -> Markup:
    """Return a text with quotes from ``own``, each with its error and a link to its claim."""
    found = Markup()
    for literal, words in quotes.parts(text):
        found += _with_code(literal)
        if words is None:
            continue
        number = quotes.quote(own.claims, words)
        if number is None:
            found += quotes.MISSING
            continue
        place = next(row.identity for row in own.rows if number.claim in row.claims)
        found += Markup('<a class="quote" href="#{}" title="{}">{}</a>').format(
            place, _origin(number), number.text
        )
    return found


def _with_code(text: str) -> Markup:
    parts = (
        Markup("<code>{}</code>" if i % 2 else "{}").format(part) for i, part in enumerate(text.split("`"))
    )
    return Markup().join(parts)


def _origin(quote: quotes.Quote) -> str:
    error = f"± {error_text(quote.error)}, " if quote.nature == "measured" else ""
    return f"{error}{quote.claim.engine}: {quote.claim.sentence}"


def _pictures(run: Run, study: Study) -> list[tuple[str, str]]:
    drawing = run.drawings.get(study.name)
    if not isinstance(drawing, Drawing):
        return []
    found = [(name, "svg") for name in drawing.figures] + [(name, "gif") for name in drawing.animations]
    order = list(study.figures)
    return sorted(found, key=lambda one: order.index(one[0]) if one[0] in order else len(order))


def _hero(run: Run) -> tuple[Study, str, str] | None:
    pictures = ((study, *picture) for study in run.studies for picture in _pictures(run, study))
    return next((picture for picture in pictures if picture[1] == HERO), None)


def _filters(matrix: Matrix) -> dict[str, list[str]]:
    return {
        "engine": list(
            dict.fromkeys([*matrix.columns, *(name for one in matrix.recorded for name in one.by_engine)])
        ),
        "verdict": [state.value for state in State if matrix.totals[state]],
        "evidence": [kind for kind in EVIDENCE if matrix.of_evidence(kind)],
        "study": [study.name for study in matrix.studies],
        "equation": list(dict.fromkeys(row.equation for row in matrix.rows if row.equation)),
    }


def _reason(value: object) -> str:
    return value.reason if isinstance(value, Failure) else ""


def _commands(run: Run, study: Study) -> list[str]:
    engines = [column for column in run.columns(study) if column != THEORY]
    return [command(study.name, engine, run.seed) for engine in engines or [THEORY]]


def _claim_commands(seed: int | None, row: Row) -> list[str]:
    engines = list(dict.fromkeys(claim.engine for claim in row.claims if claim.engine != THEORY)) or [THEORY]
    return [command(f"--claim {shlex.quote(row.identity)}", engine, seed) for engine in engines]


def command(what: str, engine: str, seed: int | None = None) -> str:
    """Return the command that repeats the measurement of a study or a claim with one engine."""
    text = f"friction-discs report {what}"
    if engine == THEORY:
        return text
    return f"{text} --engine {shlex.quote(engine)}" + (f" --seed {seed}" if seed is not None else "")


def _data(value: float, text: str) -> Markup:
    return Markup('<data value="{}">{}</data>').format(repr(value), text)
