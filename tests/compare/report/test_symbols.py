"""What symbols mean: those of a drawn figure are found, and no study draws one whose meaning is not known."""

import re
from pathlib import Path

import pytest

import compare.studies
from compare.output.figures import axis, new_figure, saved
from compare.report.symbols import ALIKE, MEANINGS, parsed, symbols_of


def test_symbols_of_a_figure_are_those_that_it_draws():
    figure, (panel,) = new_figure()
    panel.set(
        xlabel=axis(r"\mu N", "N"), ylabel=axis(r"\dot\varphi - \Omega", "rad/s"), title=r"$y > 0$ at t"
    )
    svg, _ = saved(figure)
    assert [shown for shown, _ in symbols_of(svg.decode())] == ["μN", "Ω", "φ̇", "x, y"]


@pytest.mark.parametrize(
    ("formula", "known", "unknown"),
    [
        (r"\frac{2}{3}\,\mu NR", {r"\mu N", "R"}, set()),
        (r"\max\,\mathrm{Re}\,\lambda\,/\,k", {r"\lambda", "k"}, set()),
        (r"8\,e^{-2}\exp(-\tau/t)", {r"\tau", "t"}, set()),
        (r"\omega_0 + \omega_*", {r"\omega", r"\omega_*"}, set()),
        (r"\gamma\,Q", set(), {r"\gamma", "Q"}),
    ],
)
def test_formulas_are_taken_apart(formula, known, unknown):
    assert parsed(formula) == (known, unknown)


def test_every_symbol_that_a_study_draws_has_a_meaning():
    drawn = set()
    for source in Path(compare.studies.__file__).parent.rglob("pictures.py"):
        text = re.sub(
            r"\{[^{}]*[a-z_.]{3}[^{}]*\}", " ", source.read_text(encoding="utf-8")
        )  # what is filled in
        drawn |= set(re.findall(r'(?<!\.)axis\(\s*r?"([^"]+)"', text)) | set(re.findall(r"\$([^$]+)\$", text))
    assert len(drawn) > 50
    assert {formula: parsed(formula)[1] for formula in drawn if parsed(formula)[1]} == {}
    used = {key for formula in drawn for key in parsed(formula)[0]}
    assert used == set(MEANINGS)
    assert set(ALIKE.values()) <= set(MEANINGS)
