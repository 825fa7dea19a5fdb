"""Numbers for readers: significant digits only, powers of ten with superscripts."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from compare.claims.claim import Claim, Verdict
from reference_model.systems import FloatArray

MINUS = "\N{MINUS SIGN}"

MOST_DIGITS = 12

_SUPERSCRIPTS = str.maketrans("0123456789-", "⁰¹²³⁴⁵⁶⁷⁸⁹⁻")


def with_digits(value: float, digits: int) -> str:
    """Return ``value`` with this number of significant digits: "0.0436", "−1.2×10⁻¹⁰", "0", "NaN", "∞"."""
    if math.isnan(value):
        return "NaN"
    if math.isinf(value):
        return "∞" if value > 0.0 else MINUS + "∞"
    if value == 0.0:
        return "0"
    mantissa, _, exponent = f"{value:.{digits - 1}e}".partition("e")
    power = int(exponent)
    if -4 <= power < max(digits, 5):
        text = f"{value:.{max(digits - 1 - power, 0)}f}"
    else:
        text = f"{mantissa}×10{str(power).translate(_SUPERSCRIPTS)}"
    return text.replace("-", MINUS)


def value_text(value: float, uncertainty: float, most: int = MOST_DIGITS) -> str:
    """Return a result to the first digit of ``uncertainty``: at least 4 digits (2 if smaller), at most ``most``."""
    if not (math.isfinite(value) and math.isfinite(uncertainty)) or value == 0.0:
        return with_digits(value, 4)
    if uncertainty <= 0.0:
        return trimmed(value) if most == MOST_DIGITS else with_digits(value, most)
    digits = math.floor(math.log10(abs(value))) - math.floor(math.log10(uncertainty)) + 1
    return with_digits(value, min(max(digits, 2 if uncertainty >= abs(value) else 4), most))


def error_text(value: float, digits: int = 2) -> str:
    """Return an error or a difference as text."""
    return with_digits(value, digits)


def trimmed(value: float) -> str:
    """Return an exact number, such as a parameter, without trailing zeros: "0.09", "1", "1×10⁻⁹"."""
    if not math.isfinite(value) or value == 0.0:
        return with_digits(value, 1)
    digits = next((n for n in range(1, 13) if float(f"{value:.{n - 1}e}") == value), 12)
    return with_digits(value, digits)


# --- The element of a claim that decides its verdict.

SPACE = "\N{NO-BREAK SPACE}"

_SYMBOL = "(?:kg|rad|rpm|mm|[μm]?[ms]|N|J|W|Pa|Hz|K|°C|h|min)[²³]?"
_BEFORE_UNIT = re.compile(
    rf"([\d⁰¹²³⁴⁵⁶⁷⁸⁹∞](?:</data>|</a>|\]\([^)]*\))?) (%|(?:1/)?{_SYMBOL}(?:[ /·]{_SYMBOL})*)(?![\w²³/])"
)


def unbroken(text: str) -> str:
    """Return ``text`` (HTML or Markdown) with no-break spaces in each unit and between it and its number."""
    return _BEFORE_UNIT.sub(lambda found: f"{found[1]}{SPACE}{found[2].replace(' ', SPACE)}", text)


@dataclass(frozen=True)
class Element:
    """One number of a claim: element ``index`` (from 0) of ``count``, with its name, unit and errors.

    ``largest`` contains, for the deciding element only, the elements with the largest difference in each unit.
    """

    index: int
    count: int
    name: str
    unit: str
    predicted: float
    measured: float
    difference: float
    numerical: float
    model: float
    largest: tuple[Element, ...] = ()

    @property
    def total(self) -> float:
        """Numerical plus model error."""
        return self.numerical + self.model


def worst(claim: Claim) -> Element:
    """Return the element nearest to failing; for an inconclusive claim, the element with the largest error bar."""
    difference = np.nan_to_num(claim.difference.ravel(), nan=np.inf)
    units = np.resize(claim.units, difference.size)
    largest = (
        int(np.argmax(np.where(units == unit, difference, -1.0))) for unit in dict.fromkeys(claim.units)
    )
    is_open = claim.verdict is Verdict.INCONCLUSIVE
    decides = int(np.argmax(_numerical(claim))) if is_open else claim.worst
    return replace(_element(claim, decides), largest=tuple(_element(claim, i) for i in largest))


def _element(claim: Claim, index: int) -> Element:
    name = claim.element(index) or f"no. {index + 1} of {claim.predicted.size}"
    return Element(
        index,
        claim.predicted.size,
        name if claim.predicted.size > 1 else "",
        claim.units[index % len(claim.units)],
        float(claim.predicted.flat[index]),
        float(claim.measured.flat[index]),
        float(claim.difference.flat[index]),
        float(_numerical(claim).flat[index]),
        claim.budget.model,
    )


def _numerical(claim: Claim) -> FloatArray:
    return np.broadcast_to(claim.budget.numerical, claim.predicted.shape)


def deciding(claims: Sequence[Claim]) -> Claim:
    """Return the claim nearest to failing, or the least certain claim, among claims with the same verdict."""

    def weight(claim: Claim) -> float:
        element = worst(claim)
        if claim.verdict is Verdict.INCONCLUSIVE:
            return element.total
        return float(claim.ratio.flat[element.index])

    return max(claims, key=weight)


def in_short(claim: Claim) -> str:
    """Return the number next to a verdict: the error bar, "± 2×10⁻⁹ m", or the excessive difference, "by 3 m".

    For yes-no answers the text is "7 of 8".
    """
    element = worst(claim)
    if claim.answers:
        return f"{answers_text(element.measured)} of {answers_text(element.predicted)}"
    unit = f" {element.unit}" if element.unit else ""
    if claim.verdict is Verdict.DIFFERS:
        missing = not math.isfinite(element.measured)
        return "no number" if missing else f"by{SPACE}{error_text(element.difference)}{unit}"
    error = max(element.total, 0.0 if claim.verdict is Verdict.INCONCLUSIVE else element.difference)
    return "no error estimate" if math.isnan(error) else f"±{SPACE}{error_text(error)}{unit}" if error else ""


def decision(claim: Claim) -> str:
    """Return the reason of a verdict, unless the claim agrees."""
    element = worst(claim)
    unit = f" {element.unit}" if element.unit else ""
    place = f" at {element.name}" if element.name else ""
    allowed = f"{error_text(element.total)}{unit}"
    if claim.verdict is Verdict.INCONCLUSIVE:
        if math.isfinite(element.total):
            return f"the error budget of {allowed} is too large for a verdict"
        return f"no error budget{place}: a number is missing at one of two tolerances"
    if not math.isfinite(element.measured):
        return f"the engine returned {error_text(element.measured)}{place}, so a number is missing"
    return f"differs by {error_text(element.difference)}{unit}; the error budget is {allowed}"


def answers_text(count: float) -> str:
    """Return a number of answers as an integer: "3", "1,000,000"."""
    return f"{round(count):,}"


def account(claim: Claim) -> str:
    """Return the numbers of the deciding element in one line."""
    element = worst(claim)
    if claim.answers:
        return f"{in_short(claim)} hold, {answers_text(element.numerical)} inconclusive"
    if not math.isfinite(element.measured) or not math.isfinite(element.total):
        return f"{decision(claim)}; predicted {element.predicted!r} {element.unit}".rstrip()
    unit = f" {element.unit}" if element.unit else ""
    largest = ", ".join(f"{error_text(one.difference)} {one.unit}".rstrip() for one in element.largest)
    return (
        f"predicted {element.predicted!r}{unit}, measured {element.measured!r}{unit}, "
        f"difference {error_text(element.difference)}, allowed {error_text(element.numerical)} (numerical) "
        f"+ {error_text(element.model)} (model), resolution {error_text(claim.budget.resolution)}; "
        f"largest difference of {element.count}: {largest}"
    )
