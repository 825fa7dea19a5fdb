"""Take the numbers in README, docs/findings.md and the paper from a report.

``builders/findings.md`` and the paper's source name each number as in ``#n("fig05: dividing velocity, reference")``:
a study and a quote of one of its claims (see ``compare.report.quotes``). "claims", "checks" and
"verdicts: independent" are counts of a whole report. "verdicts: friction" counts the independent verdicts that would
fail with half the friction, and "engine: Bullet" is its sentence about an engine. A number of a claim links to the
claim at the end of the page. README contains the numbers of ``IN_README`` literally::

    python builders/findings.py write report/results.json   # docs/numbers.json, docs/findings.md and its figures
    python builders/findings.py check report/results.json   # fails if the report deviates from them
"""

from __future__ import annotations

import json
import re
import shutil
import sys
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any, Literal

from compare.claims.as_json import claim_from_json
from compare.output.text_files import write_text
from compare.report.matrix import WORST_FIRST, State
from compare.report.numbers import error_text, value_text
from compare.report.quotes import Nature, parts, quote
from compare.report.results_json import read_results
from reference_model.systems import UNITS

ROOT = Path(__file__).parents[1]

QUOTED = re.compile(r'#n\(\s*"([^"]*)"\s*\)')

WITH_UNIT = re.compile(QUOTED.pattern + r"( (?:N m s/rad|mm|rpm|N|m|s|%)(?!\w))?")
"""A number with its unit, which the link to its claim includes: a search for "3145 rpm" finds it."""

CLAIMS = "#claims"
"""Place of the quoted claims in ``builders/findings.md``."""

FIGURE = re.compile(r"\]\(([\w-]+\.svg)\)")
"""Link to a figure of the report."""

IN_README = (
    "claims",
    "verdicts: independent",
    "verdicts: friction",
    "fig05: dividing velocity, reference, ±",
    "stability-map: lower friction_force, 3 digits",
    "stability-map: upper friction_force, 3 digits",
    "drivetrain-frozen: onset at 80 N m and 12 rad/s, exudyn, rpm, 4 digits",
)

MOST_DIGITS = 7
"""Largest number of digits on the page; ``docs/numbers.json`` contains all. Parameters are known to at most four."""

FACTOR_BETWEEN_MACHINES = 10.0
"""Largest ratio of an error between machines. Rounding differs, and the choice of steps depends on it."""

Results = Mapping[str, Any]


@dataclass(frozen=True)
class Number:
    """A printed number with its value, its error and its nature; a sentence about an engine has only its text.

    A number of a claim also has the claim's name and sentence, and its own unit.
    """

    text: str
    value: float
    error: float
    nature: Nature | Literal["text"]
    claim: str = ""
    sentence: str = ""
    unit: str = ""

    def __str__(self) -> str:
        """Return the sentence, or the value with its error."""
        return self.text if self.nature == "text" else f"{self.value:.12g} ± {self.error:.2g}"

    def deviates_from(self, other: Number) -> bool:
        """Return whether two reports differ: counts by any amount, other numbers by more than their errors."""
        if (self.nature, self.claim, self.sentence) != (other.nature, other.claim, other.sentence):
            return True
        if self.nature == "text":
            return self.text != other.text
        if self.nature == "count":
            return self.value != other.value
        if self.nature == "error":
            low, high = sorted((self.value, other.value))
            return high > FACTOR_BETWEEN_MACHINES * low
        return not abs(self.value - other.value) <= self.error + other.error


def wanted(root: Path = ROOT) -> tuple[str, ...]:
    """Return the distinct names of all numbers."""
    sources = (root / "builders" / "findings.md", *sorted((root / "docs" / "paper").glob("*.typ")))
    quoted = (name for path in sources for name in QUOTED.findall(path.read_text(encoding="utf-8")))
    return tuple(sorted({*IN_README, *quoted}))


def kept(root: Path = ROOT) -> dict[str, Number]:
    """Return the numbers in ``docs/numbers.json`` by name."""
    content = json.loads((root / "docs" / "numbers.json").read_text(encoding="utf-8"))
    return {name: Number(**number) for name, number in content.items()}


def findings(numbers: Mapping[str, Number], root: Path = ROOT) -> str:
    """Return the text of docs/findings.md."""
    template = (root / "builders" / "findings.md").read_text(encoding="utf-8")
    linked = WITH_UNIT.sub(lambda found: _linked(numbers[found[1]], found[2] or ""), template)
    return linked.replace(CLAIMS, "\n\n".join(_claims(numbers, QUOTED.findall(template))))


def _linked(number: Number, unit: str) -> str:
    text = f"{number.text}{unit}"
    return f"[{text}](#{anchor(number.claim)})" if number.nature == "measured" else text


def anchor(claim: str) -> str:
    """Return the anchor of a claim's heading."""
    return claim.replace("/", "")


def _claims(numbers: Mapping[str, Number], names: Iterable[str]) -> Iterator[str]:
    """Yield a heading, the sentence and the measured numbers with their errors for each claim behind ``names``."""
    quoted: dict[str, dict[str, Number]] = {}
    for name in names:
        number, words = numbers[name], name.partition(": ")[2].partition(",")[0]
        if number.nature == "measured":
            quoted.setdefault(number.claim, {})[words] = number
    for claim, found in quoted.items():
        values = [
            f"- {words.replace('_', ' ')}: {_with_error(replace(number, unit=number.unit or _unit(words)))}"
            for words, number in found.items()
        ]
        sentence = next(iter(found.values())).sentence
        yield "\n".join([f"### {claim}", "", f"{sentence}.", "", *values])


def _unit(words: str) -> str:
    """Return the unit of the parameter that ``words`` end with, or ""."""
    return UNITS.get(words.split()[-1], "")


def _with_error(number: Number) -> str:
    error, shown = error_text(number.error, 1), value_text(number.value, number.error, MOST_DIGITS)
    text = f"{shown} ± {error}"
    if shown != value_text(number.value, number.error):  # the error is below the last digit
        return f"{shown} {number.unit}".rstrip() + f" (numerical error {error} {number.unit}".rstrip() + ")"
    return f"{number.text if '±' in number.text else text} {number.unit}".rstrip()


def number_in(results: Results, name: str) -> Number | None:
    """Return a number from a report, or None if the report did not measure it.

    Raises ``ValueError`` if the report contains the study but none of its claims has that name.
    """
    kind, _, rest = name.partition(": ")
    if kind in ("claims", "checks", "verdicts", "engine"):
        if not _is_whole(results):
            return None
        if kind == "engine":
            return Number(results["in_short"][rest], 0.0, 0.0, "text")
        counts = {"claims": _count_of_claims(results), "checks": sum(results["totals"].values())}
        count = counts[kind] if kind in counts else _agreeing_by_evidence(results)[rest]
        return Number(str(count), count, 0.0, "count")
    study = next((study for study in results["studies"] if study["name"] == kind), None)
    if study is None:
        return None
    claims = [claim_from_json(claim) for claim in study["claims"]]
    found = quote(claims, rest)
    if found is None:
        if not _is_whole(results):
            return None
        raise ValueError(f"{name!r}: no claim of the study {kind!r} has that name")
    name = next(
        about["id"] for claim, about in zip(claims, study["claims"], strict=True) if claim is found.claim
    )
    unit = found.unit if found.unit != "1" else ""
    return Number(found.text, found.value, found.error, found.nature, name, found.claim.sentence, unit)


def _is_whole(results: Results) -> bool:
    from compare.engines import engines
    from compare.studies import STUDIES

    return (
        [study["name"] for study in results["studies"]] == [study.name for study in STUDIES]
        and {engine.name for engine in engines()} <= set(results["engines"])
        and not any(results["totals"][state.value] for state in (State.FAILED, State.MISSING))
    )


def _agreeing_by_evidence(results: Results) -> Counter[str]:
    """Count the cells of the matrix that agree, by evidence. The worst claim of a cell decides."""
    cells: dict[tuple[str, ...], list[dict[str, Any]]] = {}
    for study in results["studies"]:
        for claim in study["claims"]:
            key = (study["name"], claim["sentence"], claim["equation"], claim["engine"])
            cells.setdefault(key, []).append(claim)
    worst = (
        min(claims, key=lambda claim: WORST_FIRST.index(State(claim["verdict"]))) for claims in cells.values()
    )
    agreeing = [claim for claim in worst if claim["verdict"] == "agrees"]
    of_friction = sum(claim["evidence"] == "independent" and claim["friction"] for claim in agreeing)
    return Counter(claim["evidence"] for claim in agreeing) + Counter(friction=of_friction)


def _count_of_claims(results: Results) -> int:
    return len(
        {
            (study["name"], claim["sentence"], claim["equation"])
            for study in results["studies"]
            for claim in study["claims"]
        }
    )


def write(results: Results, root: Path = ROOT) -> None:
    """Write the numbers of a report and keep those that it did not measure."""
    old = kept(root)
    numbers = {name: number_in(results, name) or old[name] for name in wanted(root)}
    content = {name: asdict(number) for name, number in numbers.items()}
    write_text(root / "docs" / "numbers.json", json.dumps(content, ensure_ascii=False, indent=1) + "\n")
    write_text(root / "docs" / "findings.md", findings(numbers, root))


def deviations(results: Results, root: Path = ROOT) -> Iterator[str]:
    """Yield a sentence for each kept number that the report contradicts."""
    for name, number in kept(root).items():
        measured = number_in(results, name)
        if measured is not None and number.deviates_from(measured):
            yield f"{name}: docs/numbers.json has {number}, the report {measured}"


def unmeasured(results: Results) -> Iterator[str]:
    """Yield a sentence for each quote in a study's text that no claim of a complete report measures."""
    from compare.studies import studies

    found = {study["name"]: study["claims"] for study in results["studies"]} if _is_whole(results) else {}
    for study in studies(found) if found else ():
        claims = [claim_from_json(claim) for claim in found[study.name]]
        for text in (study.prose.finding, study.prose.paper, *study.figures.values()):
            for _, words in parts(text):
                if words is not None and quote(claims, words) is None:
                    yield f"{study.name}: no claim has {words!r}"


def outdated(root: Path = ROOT) -> Iterator[str]:
    """Yield a sentence for each text that lacks a kept number."""
    numbers = kept(root)
    if set(numbers) != set(wanted(root)):
        yield f"docs/numbers.json lacks or does not need {sorted(set(numbers) ^ set(wanted(root)))}"
        return
    if (root / "docs" / "findings.md").read_text(encoding="utf-8") != findings(numbers, root):
        yield "docs/findings.md is not what builders/findings.md gives"
    readme = (root / "README.md").read_text(encoding="utf-8")
    for name in IN_README:
        if not re.search(rf"(?<![\d.]){re.escape(numbers[name].text)}(?![\d.]*\d)", readme):
            yield f"README.md does not contain {numbers[name].text}, {name}"


def main(arguments: list[str], root: Path = ROOT) -> int:
    """Run ``write`` or ``check`` with a ``results.json``; return the exit status."""
    if len(arguments) != 2 or arguments[0] not in ("write", "check"):
        print("usage: python builders/findings.py write|check RESULTS.json", file=sys.stderr)
        return 2
    results = read_results(Path(arguments[1]))
    if arguments[0] == "write":
        write(results, root)
        for name in FIGURE.findall((root / "docs" / "findings.md").read_text(encoding="utf-8")):
            figure = Path(arguments[1]).parent / "figures" / name
            if figure.exists():  # the report may lack its study
                shutil.copy(figure, root / "docs")
    sentences = [*outdated(root), *deviations(results, root), *unmeasured(results)]
    for sentence in sentences:
        print(sentence)
    return 1 if sentences else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
