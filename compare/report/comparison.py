"""Differences between two reports: numbers moved beyond their error bars, verdicts, new and missing claims."""

import json
from collections.abc import Collection, Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from enum import Enum
from pathlib import Path
from typing import Any, TypeAlias

import numpy as np

from compare.claims.claim import THEORY
from compare.output.text_files import read_json, write_text
from compare.report.matrix import WORST_FIRST, State
from compare.report.numbers import error_text, value_text
from reference_model.systems import FloatArray

Results = Mapping[str, Any]

Key: TypeAlias = "tuple[str, str]"
"""Identity of a claim, or name of a study, and name of an engine."""


class Kind(Enum):
    """Kind of a change; those in ``BAD`` make the comparison fail unless they are known."""

    WORSE = "worse"
    MOVED = "moved"
    GONE = "gone"
    NEW = "new"
    BETTER = "better"


BAD = (Kind.WORSE, Kind.MOVED, Kind.GONE)


@dataclass(frozen=True)
class Change:
    """A change of one claim, or of a whole study, of one engine."""

    kind: Kind
    claim: str
    engine: str
    words: str
    known: bool = False

    @property
    def counts(self) -> bool:
        """True if the change is bad and not known."""
        return self.kind in BAD and not self.known

    def __str__(self) -> str:
        return f"{self.kind.value}{' (known)' * self.known}: {self.claim} {self.engine}: {self.words}"


def changes(old: Results, new: Results, known: Collection[Key] = ()) -> tuple[Change, ...]:
    """Return the changes between two results of ``read_results``, bad ones first.

    Changes of claims in ``known`` do not count.
    """
    found = [*_of_runs(old, new), *_of_claims(old, new)]
    order = list(Kind)
    marked = [replace(one, known=(one.claim, one.engine) in known) for one in found]
    return tuple(sorted(marked, key=lambda one: order.index(one.kind)))


def failures(results: Results) -> dict[Key, str]:
    """Return the claims that differ and the studies that failed, with the word for it."""
    differ = {
        (claim["id"], claim["engine"]): State.DIFFERS.value
        for claim in _claims(results)
        if claim["verdict"] == State.DIFFERS.value
    }
    failed = State.FAILED.value
    return differ | {key: failed for key, unit in _units(results).items() if unit["state"] == failed}


def without_verdict(results: Results) -> tuple[str, ...]:
    """Return the measured engines without any claim; a study may have no claims about its theory."""
    known = {THEORY, *(claim["engine"] for claim in _claims(results))}
    return tuple(dict.fromkeys(engine for _, engine in _units(results) if engine not in known))


def _claims(results: Results) -> Iterator[dict[str, Any]]:
    return (claim for study in results["studies"] for claim in study["claims"])


def _of_runs(old: Results, new: Results) -> Iterator[Change]:
    before, after = _units(old), _units(new)
    for (study, engine), unit in after.items():
        state = unit["state"]
        was = before.get((study, engine), {"state": "not there"})["state"]
        if state == State.FAILED.value and was != state:
            yield Change(Kind.WORSE, study, engine, f"{was} before, failed now: {unit['reason']}")
        elif was == State.FAILED.value and state != was:
            yield Change(Kind.BETTER, study, engine, f"failed before, {state} now")
        elif was == "not there":
            yield Change(Kind.NEW, study, engine, state)
    for study, engine in before.keys() - after.keys():
        yield Change(Kind.GONE, study, engine, "missing in the new report")


def _units(results: Results) -> dict[Key, dict[str, Any]]:
    return {
        (study["name"], engine): unit
        for study in results["studies"]
        for engine, unit in study["units"].items()
    }


def _of_claims(old: Results, new: Results) -> Iterator[Change]:
    before, after = _by_key(_claims(old)), _by_key(_claims(new))
    for key, claim in after.items():
        was = before.get(key)
        if was is None:
            kind = Kind.WORSE if claim["verdict"] == State.DIFFERS.value else Kind.NEW
            yield Change(kind, claim["id"], claim["engine"], f"new, {claim['verdict']}: {claim['sentence']}")
        elif was["verdict"] != claim["verdict"]:
            ranks = [WORST_FIRST.index(State(one["verdict"])) for one in (was, claim)]
            kind = Kind.WORSE if ranks[1] < ranks[0] else Kind.BETTER
            words = f"{was['verdict']} before, {claim['verdict']} now: {claim['sentence']}"
            yield Change(kind, claim["id"], claim["engine"], words)
        elif words := _moved(was, claim):
            yield Change(Kind.MOVED, claim["id"], claim["engine"], words)
    whole = _units(new)
    for key, claim in before.items():
        unit = whole.get((key[0], claim["engine"]))
        if key not in after and unit is not None and unit["state"] != State.FAILED.value:  # see _of_runs
            yield Change(Kind.GONE, claim["id"], claim["engine"], claim["sentence"])


def _by_key(claims: Iterable[dict[str, Any]]) -> dict[tuple[str, str, str, int], dict[str, Any]]:
    return {
        (claim["id"].partition("/")[0], claim["id"], claim["engine"], claim["measurement"]): claim
        for claim in claims
    }


def _moved(old: Mapping[str, Any], new: Mapping[str, Any]) -> str:
    """Describe the number that moved farthest beyond the sum of both error bars, or return ""."""
    if old["shape"] != new["shape"] or old["places"] != new["places"]:
        return "the claim consists of different numbers, so they cannot be compared"
    allowed = _errors(old) + _errors(new)
    worst, words = 1.0, ""
    for name in ("measured", "predicted"):
        before, after = _numbers(old, name), _numbers(new, name)
        with np.errstate(divide="ignore", invalid="ignore"):
            way = np.abs(after - before)
            ratio = np.where((before == after) | (np.isnan(before) & np.isnan(after)), 0.0, way / allowed)
        ratio[np.isnan(ratio)] = np.inf  # one of them is missing
        i = int(np.argmax(ratio))
        if ratio[i] > worst:
            worst, unit = float(ratio[i]), f" {new['places'][i][1]}".rstrip()
            place = f", {new['places'][i][0]}" if new["places"][i][0] else ""
            words = (
                f"{name} {value_text(before[i], allowed[i])} before, {value_text(after[i], allowed[i])} now{unit}: "
                f"changed by {error_text(way[i])}{unit}, allowed {error_text(allowed[i])}{place}"
            )
    return words


def _errors(claim: Mapping[str, Any]) -> FloatArray:
    return _numbers(claim, "numerical_error") + float(claim["model_error"])


def _numbers(claim: Mapping[str, Any], name: str) -> FloatArray:
    return np.array(claim[name], dtype=float).ravel()


# --- A baseline: claims known to fail, so a server reports only new failures.
#
# A file for people to read and edit::
#
# {"format": "friction-discs baseline", "version": 1, "known": [{"claim": "fig05/slides", "engine": "mine",
# "state": "differs", "why": "issue 12"}]}

FORMAT, VERSION = "friction-discs baseline", 1


def read_baseline(path: Path) -> frozenset[Key]:
    """Return the claims, or studies, and engines that are known to fail.

    Raises ``ValueError`` for an invalid file.
    """
    try:
        content = read_json(path)
        if (content["format"], content["version"]) == (FORMAT, VERSION):
            return frozenset((str(one["claim"]), str(one["engine"])) for one in content["known"])
    except OSError as error:
        raise ValueError(f"cannot read {str(path)!r}: {error.strerror}") from None
    except (ValueError, KeyError, TypeError):
        pass
    raise ValueError(f"{str(path)!r} is not a baseline; write one with diff --write-baseline")


def write_baseline(path: Path, failures: Mapping[Key, str]) -> None:
    """Write the ``failures`` with empty reasons to be filled in."""
    known = [
        {"claim": claim, "engine": engine, "state": state, "why": ""}
        for (claim, engine), state in sorted(failures.items())
    ]
    content = {"format": FORMAT, "version": VERSION, "known": known}
    write_text(path, json.dumps(content, indent=1, ensure_ascii=False) + "\n")
