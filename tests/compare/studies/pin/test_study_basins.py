from dataclasses import replace

import numpy as np
import pytest
from studies_under_test import altered, for_every_sound_engine, sentences, verdicts

from compare.claims.claim import Verdict
from compare.claims.paper_parameters import FIG5
from compare.figures import paper_style, saved
from compare.studies.pin.basins import claims as basins
from compare.studies.pin.basins.claims import (
    AREA,
    CLOSES,
    DIVIDES,
    PARTS,
    RECOMPUTES,
    RETURNS,
    SHRINKS,
    STUDY,
    enclosed,
    measure,
    smooth,
)
from reference_model.ensemble import EndState, Ensemble
from reference_model.systems import PinOnDisc


@pytest.fixture
def coarse(monkeypatch):
    """A hundredth of the starts, at one speed, and a boundary from as few points as can be."""
    monkeypatch.setattr(basins, "WHERE", {FIG5: basins.WHERE[FIG5]})
    monkeypatch.setattr(basins, "CELLS", 6)
    monkeypatch.setattr(basins, "SIDE", 100)
    monkeypatch.setattr(basins, "STARTS", 400)
    monkeypatch.setattr(basins, "SPEEDS", np.linspace(1.1, 3.0, 6))
    monkeypatch.setattr(basins, "RECOMPUTED", 6)


@for_every_sound_engine
def test_sound_engines_come_back_on_the_saddle_and_part_beside_the_boundary(engine):
    assert verdicts(measure(engine)) == dict.fromkeys((CLOSES, RETURNS, PARTS), Verdict.AGREES)


def test_an_engine_with_too_much_friction_neither_closes_nor_parts():
    assert sentences(measure(altered(friction_force=1.05)), Verdict.DIFFERS) == {CLOSES, RETURNS, PARTS}


def test_a_little_more_damping_gives_the_saddle_another_period_and_multiplier():
    claim = basins.returns_claim(altered(damping=1.0 + 1e-5))
    assert claim.verdict is Verdict.DIFFERS
    assert np.all((claim.difference > claim.budget.total)[[0, 2]])


def test_a_share_that_is_not_the_area_of_the_basin_is_found_out(coarse):
    """Of starts that come to the equilibrium in the quarter of the rectangle that is nearest to its middle."""
    x, vx = np.meshgrid(np.linspace(-1.0, 1.0, 401), np.linspace(-1.0, 1.0, 401))
    ends = np.where((abs(x) <= 0.5) & (abs(vx) <= 0.5), EndState.SELF_CENTRED, EndState.WHIRL).astype(
        np.uint8
    )
    claim = basins.area_claim({FIG5: ends})
    assert claim.verdict is Verdict.DIFFERS
    assert claim.measured[claim.named["share at 1.5 rad/s"]] == pytest.approx(0.25, abs=4e-3)


def test_theory_agrees_and_is_drawn(coarse):
    found = basins.theory()
    assert verdicts(found) == dict.fromkeys((DIVIDES, AREA, RECOMPUTES, SHRINKS), Verdict.AGREES) | {
        AREA: Verdict.INCONCLUSIVE  # the boundary passes through too many of so few cells
    }
    with paper_style():
        figures = STUDY.draw({"theory": found.data})
    assert set(figures) == set(STUDY.figures)
    assert saved(figures["basins"])[1].startswith(b"\x89PNG")


def test_ends_of_wrong_starts_are_found_out(coarse, monkeypatch):
    """Of an ensemble that takes 2 mm too much for x0."""
    right = basins.ensemble_of

    def shifted(starts: np.ndarray, *pin: PinOnDisc, **parameters: np.ndarray) -> Ensemble:
        return right(np.add(starts, (0.002, 0.0, 0.0, 0.0)), *pin, **parameters)

    monkeypatch.setattr(basins, "ensemble_of", shifted)
    monkeypatch.setattr(basins, "SIDE", 400)
    assert DIVIDES in sentences(basins.theory(), Verdict.DIFFERS)


def test_a_basin_that_grows_with_the_speed_is_found_out(coarse, monkeypatch):
    right = basins.ensemble_of

    def slower(starts: np.ndarray, *pin: PinOnDisc, **parameters: np.ndarray) -> Ensemble:
        return right(starts, *pin, **{name: 4.1 - values for name, values in parameters.items()})

    monkeypatch.setattr(basins, "ensemble_of", slower)
    assert SHRINKS in sentences(basins.theory(), Verdict.DIFFERS)


def test_an_ensemble_that_disagrees_with_the_plain_reference_is_found_out(coarse, monkeypatch):
    right = basins.ensemble_of

    def swapped(starts: np.ndarray, *pin: PinOnDisc, **parameters: np.ndarray) -> Ensemble:
        found = right(starts, *pin, **parameters)
        return replace(found, end=np.where(found.end == 1, 2, 1).astype(np.uint8))

    monkeypatch.setattr(basins, "ensemble_of", swapped)
    assert {DIVIDES, RECOMPUTES} <= sentences(basins.theory(), Verdict.DIFFERS)


def test_a_circle_is_smooth_to_fourth_order():
    """The spline through n points misses the area of the circle by ~ n⁻⁴."""
    missed = []
    for n in (12, 24):
        turn = np.linspace(0.0, 2.0 * np.pi, n + 1)
        points = np.column_stack((np.cos(turn), np.sin(turn)))
        points[-1] = points[0]
        missed.append(abs(enclosed(smooth(points, 100_000)) - np.pi))
    assert missed[1] < missed[0] / 12.0
