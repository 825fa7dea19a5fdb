"""Numbers as a reader wants them: as many digits as mean something, powers of ten with superscripts."""

from __future__ import annotations

import math

MINUS = "\N{MINUS SIGN}"

MOST_DIGITS = 12
"""Of a result, however small its error."""

_SUPERSCRIPTS = str.maketrans("0123456789-", "⁰¹²³⁴⁵⁶⁷⁸⁹⁻")


def with_digits(value: float, digits: int) -> str:
    """Return ``value`` with so many significant digits: "0.0436", "−1.2×10⁻¹⁰", "0", "NaN", "∞"."""
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
    """Return a result with its digits down to the first of ``uncertainty``: 4 (2 in the noise) to ``most``."""
    if not (math.isfinite(value) and math.isfinite(uncertainty)) or value == 0.0:
        return with_digits(value, 4)
    if uncertainty <= 0.0:
        return trimmed(value) if most == MOST_DIGITS else with_digits(value, most)
    digits = math.floor(math.log10(abs(value))) - math.floor(math.log10(uncertainty)) + 1
    return with_digits(value, min(max(digits, 2 if uncertainty >= abs(value) else 4), most))


def error_text(value: float, digits: int = 2) -> str:
    """Return an error or a difference: two digits say enough."""
    return with_digits(value, digits)


def trimmed(value: float) -> str:
    """Return a given number (a parameter) without digits that it does not have: "0.09", "1", "1×10⁻⁹"."""
    if not math.isfinite(value) or value == 0.0:
        return with_digits(value, 1)
    digits = next((n for n in range(1, 13) if float(f"{value:.{n - 1}e}") == value), 12)
    return with_digits(value, digits)
