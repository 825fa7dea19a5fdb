import math

import pytest

from compare.report.numbers import error_text, trimmed, unbroken, value_text


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (1.23e-10, "1.2×10⁻¹⁰"),
        (0.0, "0"),
        (0.00123, "0.0012"),
        (123456.0, "1.2×10⁵"),
        (-2.5e-7, "−2.5×10⁻⁷"),
        (math.nan, "NaN"),
        (math.inf, "∞"),
    ],
)
def test_errors_have_two_digits(value, text):
    assert error_text(value) == text


@pytest.mark.parametrize(
    ("value", "uncertainty", "text"),
    [
        (0.0435889894354, 1e-9, "0.043588989"),
        (0.0435889894354, 1e-16, "0.0435889894354"),
        (12.3456789, 0.3, "12.35"),
        (3e-12, 1e-9, "3.0×10⁻¹²"),
        (0.0, 1e-9, "0"),
        (2.0, 0.0, "2"),
        (math.nan, 1.0, "NaN"),
    ],
)
def test_results_have_the_digits_that_their_uncertainty_allows(value, uncertainty, text):
    assert value_text(value, uncertainty) == text


@pytest.mark.parametrize(
    ("value", "text"), [(0.09, "0.09"), (1.0, "1"), (1e-9, "1×10⁻⁹"), (1.5, "1.5"), (4001, "4001")]
)
def test_exact_numbers_keep_their_digits(value, text):
    assert trimmed(value) == text


@pytest.mark.parametrize(
    "text",
    [
        "5~%, 1.5~m/s,",
        "(2~N~m~s/rad)",
        "3×10⁻¹⁰~rpm",
        "1~kg~m²",
        "[0.05](#a)~m.",
        "<data>2</data>~1/s<",
        "3 mean, 4 so, 5 Nm",
    ],
)
def test_a_number_stays_with_its_unit(text):
    assert unbroken(text.replace("~", " ")) == text.replace("~", "\N{NO-BREAK SPACE}")
