import numpy as np
import pytest
from studies_under_test import sentences, verdicts

from compare.claims.claim import Verdict
from compare.figures import paper_style, saved
from compare.studies.disc.simulated_map import claims as simulated_map
from compare.studies.disc.simulated_map.claims import LEAVES, NO_WHIRL, STUDY
from reference_model.ensemble import EndState


@pytest.fixture(scope="module")
def ends():
    return simulated_map.simulated()


def test_theory_agrees_and_is_drawn(ends, monkeypatch):
    monkeypatch.setattr(simulated_map, "simulated", lambda: ends)
    found = simulated_map.theory()
    assert verdicts(found) == {LEAVES: Verdict.AGREES, NO_WHIRL: Verdict.AGREES}
    assert np.mean(ends == EndState.UNDECIDED) < 0.01
    with paper_style():
        figures = STUDY.draw({"theory": found.data})
    assert saved(figures["simulated-map"])[1].startswith(b"\x89PNG")


def test_the_disc_of_fig_11_is_modulated(ends):
    column = np.argmin(np.abs(simulated_map.DAMPING - 0.5))
    row = np.argmin(np.abs(simulated_map.SHAFT_DAMPING - 0.015))
    assert ends[row, column] == EndState.MODULATED


@pytest.mark.parametrize(
    ("where", "instead", "sentence"),
    [
        (EndState.SELF_CENTRED, EndState.WHIRL, LEAVES),
        (EndState.MODULATED, EndState.SELF_CENTRED, LEAVES),
        (EndState.MODULATED, EndState.WHIRL, NO_WHIRL),
    ],
)
def test_ends_that_can_not_be_are_found_out(ends, where, instead, sentence, monkeypatch):
    wrong = np.where(ends == where, instead, ends).astype(np.uint8)
    monkeypatch.setattr(simulated_map, "simulated", lambda: wrong)
    assert sentences(simulated_map.theory(), Verdict.DIFFERS) == {sentence}
