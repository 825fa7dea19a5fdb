"""Numbers in README, docs and paper, written from a report and compared with every later one.

A number stands between two comments that no reader sees, the first of which says where it is from::

    <!--=fig05: dividing velocity, reference-->0.0277797404<!--/--> m/s

``study: name, ...`` is a quote of one of the study's claims, see ``compare.report.quotes``. ``claims`` and
``verdicts`` are how many of them a whole report has, and ``verdicts: engine=exudyn, verdict=agrees`` how many have
these values of fields in ``results.json``. In the paper ``#n("fig05: dividing velocity, reference")`` stands for such
a number. All numbers are kept in ``docs/numbers.json`` too, with what they may be off::

    python -m compare.cli.readme write report/results.json   # takes them over from this report
    python -m compare.cli.readme check report/results.json   # fails where this report and the texts part
"""

from __future__ import annotations

import json
import re
import sys
from collections.abc import Iterator, Mapping
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from compare.claims.as_json import claim_from_json
from compare.output.text_files import write_text
from compare.report.machines.results_json import read_results
from compare.report.matrix import WORST_FIRST, State
from compare.report.quotes import Nature, parts, quote

ROOT = Path(__file__).parents[2]

NUMBERS = Path("docs", "numbers.json")

MARKED = re.compile(r"(<!--=(?P<words>[^>]*?)-->)(?P<text>.*?)(?P<end><!--/-->)", flags=re.DOTALL)

QUOTED = re.compile(r'#n\(\s*"([^"]*)"\s*\)')
"""A number in a source of the paper, which looks it up in ``docs/numbers.json`` by itself."""

UNKNOWN = "…"
"""Stands where a number was never measured."""

APART = 10.0
"""Factor by which an error may differ between machines: rounding and the steps that it tips are others on each."""

Results = Mapping[str, Any]


@dataclass(frozen=True)
class Number:
    """A number of a text: what stands there, and what it may be off, by its nature."""

    text: str
    value: float
    error: float
    nature: Nature

    def parts_from(self, other: Number) -> bool:
        """Tell whether two reports can't both be right, counts to the last one, errors to within ``APART``."""
        if self.nature != other.nature:
            return True
        if self.nature == "count":
            return self.value != other.value
        if self.nature == "error":
            low, high = sorted((self.value, other.value))
            return high > APART * low
        return not abs(self.value - other.value) <= self.error + other.error


def texts(root: Path = ROOT) -> dict[Path, str]:
    """Return the texts that may have numbers, by path."""
    return {
        path: path.read_text(encoding="utf-8")
        for path in (root / "README.md", *sorted((root / "docs").glob("*.md")))
    }


def marks(text: str) -> Iterator[tuple[str, str]]:
    """Yield what each marked number of ``text`` is to be, and what stands there."""
    for found in MARKED.finditer(text):
        yield found["words"], found["text"]


def quoted(root: Path = ROOT) -> Iterator[str]:
    """Yield what the numbers of the paper are."""
    for path in sorted((root / "docs" / "paper").glob("*.typ")):
        yield from QUOTED.findall(path.read_text(encoding="utf-8"))


def filled(text: str, numbers: Mapping[str, Number]) -> str:
    """Return ``text`` with its marked numbers as they are in ``numbers``."""

    def replaced(found: re.Match[str]) -> str:
        number = numbers.get(found["words"])
        return f"{found[1]}{UNKNOWN if number is None else number.text}{found['end']}"

    return MARKED.sub(replaced, text)


def kept(root: Path = ROOT) -> dict[str, Number]:
    """Return the numbers of ``docs/numbers.json`` by what they are."""
    path = root / NUMBERS
    content = json.loads(path.read_text(encoding="utf-8")) if path.exists() else {}
    return {words: Number(**number) for words, number in content.items()}


def wanted(root: Path = ROOT) -> tuple[str, ...]:
    """Return what all marked numbers are to be, each once."""
    marked = (words for text in texts(root).values() for words, _ in marks(text))
    return tuple(dict.fromkeys([*marked, *quoted(root)]))


def number_in(results: Results, words: str) -> Number | None:
    """Return the number of a report, or None where it is about less than that number.

    Raises ``ValueError`` where the report has what the number is of, but not the number.
    """
    kind, _, rest = words.partition(":")
    if kind in ("claims", "verdicts"):
        if not _is_whole(results):
            return None
        count = (_count_of_claims if kind == "claims" else _count_of_verdicts)(results, rest)
        return Number(str(count), count, 0.0, "count")
    study = next((study for study in results["studies"] if study["name"] == kind), None)
    if study is None:
        return None
    found = quote([claim_from_json(claim) for claim in study["claims"]], rest)
    if found is None:
        if not _is_whole(results):
            return None
        raise ValueError(f"{words!r}: no claim of the study {kind!r} has that name")
    return Number(found.text, found.value, found.error, found.nature)


def _is_whole(results: Results) -> bool:
    from compare.engines import engines
    from compare.studies import STUDIES

    names = [study["name"] for study in results["studies"]]
    return (
        names == [study.name for study in STUDIES]
        and {engine.name for engine in engines()} <= set(results["engines"])
        and not any(results["totals"][state.value] for state in (State.FAILED, State.MISSING))
    )


def _verdicts(results: Results) -> Iterator[dict[str, Any]]:
    """Yield the verdict of each claim with each engine, as the report's matrix counts: of several the worst."""
    cells: dict[tuple[str, ...], list[dict[str, Any]]] = {}
    for study in results["studies"]:
        for claim in study["claims"]:
            key = (study["name"], claim["sentence"], claim["equation"], claim["engine"])
            cells.setdefault(key, []).append({"study": study["name"]} | claim)
    for same in cells.values():
        worst = min(same, key=lambda claim: WORST_FIRST.index(State(claim["verdict"])))
        yield worst


def _chosen(results: Results, conditions: str) -> Iterator[dict[str, Any]]:
    """Yield the verdicts whose fields have the values of ``conditions``, "engine=exudyn, verdict=agrees"."""
    pairs = [part.strip().split("=", 1) for part in conditions.split(",") if part.strip()]
    for verdict in _verdicts(results):
        for name, _ in pairs:
            if name not in verdict:
                raise ValueError(f"{name!r} is no field of a claim, which has {', '.join(verdict)}")
        if all(str(verdict[name]) == value for name, value in pairs):
            yield verdict


def _count_of_verdicts(results: Results, conditions: str) -> int:
    return sum(1 for _ in _chosen(results, conditions))


def _count_of_claims(results: Results, conditions: str) -> int:
    return len({(each["study"], each["sentence"], each["equation"]) for each in _chosen(results, conditions)})


def write(results: Results, root: Path = ROOT) -> None:
    """Take over what the report measured; what it is not about stays as it was."""
    old = kept(root)
    new = {words: number_in(results, words) or old.get(words) for words in wanted(root)}
    numbers = {words: number for words, number in sorted(new.items()) if number is not None}
    content = json.dumps(
        {words: asdict(each) for words, each in numbers.items()}, ensure_ascii=False, indent=1
    )
    write_text(root / NUMBERS, content + "\n")
    for path, text in texts(root).items():
        if (after := filled(text, numbers)) != text:
            write_text(path, after)


def parted(results: Results, root: Path = ROOT) -> list[str]:
    """Return a sentence for each number of which the report says something else than the texts."""
    sentences = []
    for words, number in kept(root).items():
        measured = number_in(results, words)
        if measured is not None and number.parts_from(measured):
            error = " ± {:.2g}".format
            sentences.append(
                f"{words}: the text has {number.value:.12g}{error(number.error) if number.error else ''}, "
                f"measured is {measured.value:.12g}{error(measured.error) if measured.error else ''}"
            )
    return sentences


def unmeasured(results: Results) -> list[str]:
    """Return a sentence for each quote in the texts of studies that no claim of a whole report measures."""
    from compare.studies import studies

    found = {study["name"]: study["claims"] for study in results["studies"]} if _is_whole(results) else {}
    sentences = []
    for study in studies(found) if found else ():
        claims = [claim_from_json(claim) for claim in found[study.name]]
        for text in (study.finding, study.paper, *study.figures.values()):
            sentences += [
                f"{study.name}: no claim has {words!r}"
                for _, words in parts(text)
                if words is not None and quote(claims, words) is None
            ]
    return list(dict.fromkeys(sentences))


def unlike(root: Path = ROOT) -> list[str]:
    """Return a sentence for each marked number that is not as it is kept, and for each that is kept in vain."""
    numbers = kept(root)
    sentences = [
        f"{path.name}: {words}: {text!r} in place of {numbers[words].text if words in numbers else UNKNOWN!r}"
        for path, content in texts(root).items()
        for words, text in marks(content)
        if words not in numbers or numbers[words].text != text
    ]
    sentences += [f"the paper: {words}: never measured" for words in quoted(root) if words not in numbers]
    return sentences + [f"no text has {words!r}" for words in numbers.keys() - set(wanted(root))]


def main(arguments: list[str], root: Path = ROOT) -> int:
    """Run ``write`` or ``check`` with a ``results.json``; return the exit status."""
    if len(arguments) != 2 or arguments[0] not in ("write", "check"):
        print("usage: python -m compare.cli.readme write|check RESULTS.json", file=sys.stderr)
        return 2
    results = read_results(Path(arguments[1]))
    if arguments[0] == "write":
        write(results, root)
    sentences = unlike(root) + parted(results, root) + unmeasured(results)
    for sentence in sentences:
        print(sentence)
    if sentences:
        print("`make readme` takes the numbers over from report/results.json, once they are right")
    return 1 if sentences else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
