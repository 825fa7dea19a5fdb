"""Texts quote measured numbers with the digits that their errors allow."""

import re
from dataclasses import replace

import pytest
from fake_studies import claim, fake, straight

from compare.claims.study import Findings
from compare.engines import Engine
from compare.report import quotes
from compare.report.quotes import filled, quote
from compare.report.write import write_report
from compare.run.runner import run

NAMED = {"unit": "m", "named": {"place": 0}}
CLAIMS = (
    claim("The radius", "theory", 0.05, 0.0512345678, 1e-6, **NAMED),
    claim("The radius", "good", 0.05, 0.05123, 2e-4, **NAMED),
    claim("The error", "good", [1.0, 2.0], [1.0, 2.001], [0.002, 0.004], named={"all": None, "second": 1}),
)


@pytest.mark.parametrize(
    ("words", "text"),
    [
        ("place", "0.051235"),
        ("place, 3 digits", "0.0512"),
        ("place, good", "0.05123"),
        ("place, mm, 3 digits", "51.2"),
        ("place, rpm", "0.489254"),
        ("place, turns, 2 digits", "0.0082"),
        ("place, %, 2 digits", "5.1"),
        ("place, ±, good", "0.05123 ± 0.0002"),
        ("place, error, good", "0.00020"),
        ("all, difference", "0.0010"),
        ("all, error, 1 digit", "0.004"),
        ("all, difference, relative", "0.00050"),
        ("second", "2.001"),
        ("second, % from 2", "+0.050"),
        ("second, % from 4, 2 digits", "−50"),
    ],
)
def test_a_quote_has_the_requested_quantity_unit_and_digits(words, text):
    found = quote(CLAIMS, words)
    assert found is not None
    assert found.text == text


def test_a_quote_has_value_error_and_nature():
    found = quote(CLAIMS, "place, mm, good")
    assert (found.value, found.error, found.nature) == (pytest.approx(51.23), pytest.approx(0.2), "measured")
    assert quote(CLAIMS, "all, error").nature == "error"
    assert quote(CLAIMS, "place, bad") is None
    with pytest.raises(ValueError, match="names all numbers of a claim"):
        quote(CLAIMS, "all")


def test_a_quote_without_its_claim_is_marked():
    assert filled("{place, 2 digits} m and {nothing} m", CLAIMS) == "0.051 m and (not measured) m"


def test_a_name_for_a_missing_element_is_rejected():
    with pytest.raises(ValueError, match=r"named\['far'\] = 1: it must be from 0 to 0"):
        claim("The radius", "good", 0.05, 0.05, 1e-6, named={"far": 1})


def quoted(engine):
    """Return one claim that agrees, with a name."""
    return Findings((claim("The radius", engine.name, 0.05, 0.05 + 1e-8, 1e-7, **NAMED),))


pytestmark = pytest.mark.usefixtures("in_this_process")

STUDY = fake(
    "verdicts", "Verdicts", "The radius is {place} m.", quoted, finding="It rests at {place, 2 digits} m."
)


def page_of(study, folder):
    write_report(run((study,), (Engine("one", straight),), folder=folder / "data"), folder)
    return (folder / "index.html").read_text(encoding="utf-8")


def test_the_page_links_each_quote_to_its_claim_and_shows_its_error(tmp_path):
    page = page_of(STUDY, tmp_path)
    first = re.escape(
        f'<a class="quote" href="#{STUDY.name}/the-radius" title="± 1.0×10⁻⁷, one: The radius">'
    )
    assert re.search(f"<li>It rests at {first}0.050</a>\\sm\\.", page)
    assert re.search(f"<p>The radius is {first}0.0500000</a>\\sm\\.", page)
    assert f'<details class="claim" id="{STUDY.name}/the-radius"' in page


def test_a_finding_without_its_number_is_omitted(tmp_path):
    page = page_of(replace(STUDY, prose=replace(STUDY.prose, finding="It rests at {nowhere} m.")), tmp_path)
    assert "It rests at" not in page
    assert quotes.MISSING not in page
