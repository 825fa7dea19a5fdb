"""Numbers that texts quote from claims, so every number in a text was measured.

A quote in a study's text is a name in braces, as in "a pair grows at {rate of growth, 3 digits} 1/s". A claim of the
study gives this name to one or all of its elements (``Claim.named``). Options follow after commas:

=============  ======================================================================================================
(none)         the measured number from the first engine that has it, with the digits that its error allows
``exudyn``     the number from this engine
``error``      the largest error bar
``difference`` the largest difference from the prediction
``relative``   the error or difference, over the largest predicted number
``3 digits``   at most this number of digits
``mm``         another unit: ``%`` for a share, ``mm`` for m, ``rpm`` for rad/s, ``turns`` for rad
``% from 0.5`` the signed deviation from a given number, in per cent
``±``          the number followed by its error bar
=============  ======================================================================================================
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from string import Formatter
from typing import Any, Literal

import numpy as np

from compare.claims.claim import Claim
from compare.report.numbers import MOST_DIGITS, error_text, value_text

Nature = Literal["count", "measured", "error"]
"""Nature of a quoted number: a count is exact, a measured number has an error, an error holds to a power of ten."""

MISSING = "(not measured)"

UNITS = {"%": 100.0, "mm": 1e3, "rpm": 30.0 / math.pi, "turns": 0.5 / math.pi}


@dataclass(frozen=True)
class Quote:
    """A number as printed in a text, its exact value and error, its claim, and the unit of a measured number."""

    text: str
    value: float
    error: float
    nature: Nature
    claim: Claim
    unit: str = ""


@dataclass(frozen=True)
class _Reference:
    name: str
    engine: str = ""
    part: str = "measured"
    relative: bool = False
    with_error: bool = False
    digits: int = MOST_DIGITS
    factor: float = 1.0
    unit: str = ""
    origin: float = 0.0

    @classmethod
    def of(cls, words: str) -> _Reference:
        name, *options = (part.strip() for part in words.split(","))
        given: dict[str, Any] = {}
        for option in options:
            if option in ("error", "difference"):
                given["part"] = option
            elif option == "relative":
                given["relative"] = True
            elif option == "±":
                given["with_error"] = True
            elif option.startswith("% from "):
                given["origin"] = float(option.removeprefix("% from "))
                given["factor"], given["unit"] = 100.0 / given["origin"], "%"
            elif option in UNITS:
                given["factor"], given["unit"] = UNITS[option], option
            elif option.endswith((" digit", " digits")):
                given["digits"] = int(option.split()[0])
            else:
                given["engine"] = option
        return cls(name, **given)


def quote(claims: Iterable[Claim], words: str) -> Quote | None:
    """Return the number that ``words`` name from the first of ``claims`` that has it, or None."""
    asked = _Reference.of(words)
    for claim in claims:
        if asked.name in claim.named and asked.engine in ("", claim.engine):
            return _quote(claim, asked)
    return None


def _quote(claim: Claim, asked: _Reference) -> Quote:
    place = claim.named[asked.name]
    which = slice(None) if place is None else slice(place, place + 1)
    error = asked.factor * float(
        np.max(np.broadcast_to(claim.budget.total, claim.predicted.shape).flat[which])
    )
    if asked.part == "measured":
        if place is None:
            raise ValueError(
                f"{asked.name!r} names all numbers of a claim; quote their 'error' or 'difference'"
            )
        value = asked.factor * (float(claim.measured.flat[place]) - asked.origin)
        sign = "+" if asked.origin and value > 0.0 else ""
        text = sign + value_text(value, error, most=asked.digits)
        if asked.with_error:
            text += f" ± {error_text(error, 1)}"
        return Quote(
            text, value, error, "measured", claim, asked.unit or claim.units[place % len(claim.units)]
        )
    value = error if asked.part == "error" else asked.factor * float(np.max(claim.difference.flat[which]))
    if asked.relative:
        value /= asked.factor * float(np.max(np.abs(claim.predicted.flat[which])))
    return Quote(error_text(value, min(asked.digits, 2)), value, 0.0, "error", claim)


def parts(text: str) -> Iterator[tuple[str, str | None]]:
    """Yield each text before a quote with the words of the quote, then the remaining text and None."""
    for literal, name, options, _ in Formatter().parse(text):
        yield literal, f"{name}:{options}" if options else name


def filled(text: str, claims: Iterable[Claim]) -> str:
    """Return ``text`` with its quotes replaced by numbers of ``claims``."""
    claims = tuple(claims)
    found = []
    for literal, words in parts(text):
        found.append(literal)
        if words is not None:
            it = quote(claims, words)
            found.append(MISSING if it is None else it.text)
    return "".join(found)
