"""The theory and the simulations of measured pushes."""

import math
from dataclasses import replace
from functools import partial
from pathlib import Path

import numpy as np
import pytest
from scipy.stats import norm
from studies_under_test import DIFFERS, theory_of

from compare.claims.validation import EXPECTED
from compare.studies.plane.pushes import forward, pictures, study, theory
from compare.studies.plane.pushes.reduction import reduced_pushes
from compare.studies.plane.pushes.study import GROUPS, STUDY, chosen, validations

TEXT = " ".join(Path(study.__file__).with_name("study.md").read_text(encoding="utf-8").split())

SERIES = "10_90_10_10_30_130"

FEW = {"sums": {"every": 10}, "on_limit_surface": {"every": 10}}


def obeying(push, load):
    """Return the push with the force and the place of the hand that Coulomb's law predicts."""
    wrench = theory.predicted(theory.Motion.of(push), theory.contact_of(push.series), load)
    arm = -1j * wrench.moment / wrench.force.conjugate() / theory.MM + theory.CENTRE
    force_x, force_y = wrench.force.real, wrench.force.imag
    return replace(push, force_x=force_x, force_y=force_y, end_x=arm.real, end_y=arm.imag)


@pytest.mark.parametrize("series", ["patch", "wood_30_90_30_30_30_90", SERIES])
def test_a_push_that_obeys_coulombs_law_has_no_error_and_all_laws_contain_it(series):
    push = obeying(theory.by_series()[series][3], theory.SLIDING_FORCES[theory.surface(series)])
    still = [partial(theory.pushed_above, height=0.0), partial(theory.summed, at_edges=1e-12)]
    for law in (theory.coulomb, theory.summed, *still):
        assert theory.force_error(push, law) == pytest.approx(0.0, abs=1e-9)
        assert theory.wrench_error(push, law) == pytest.approx(0.0, abs=1e-5)
        assert theory.work_ratio(push, law) == pytest.approx(1.0)


@pytest.mark.parametrize("series", ["patch", SERIES])
def test_a_pusher_above_the_surface_tilts_the_load_linearly(series, monkeypatch):
    """The weight moves forward until its moment balances the force at that height."""
    push = theory.by_series()[series][0]
    monkeypatch.setattr(theory, "coulomb", lambda push, centre: theory.contact_of(push.series, centre))
    level, tilted = (theory.pushed_above(push, height) for height in (0.0, 10.0))
    arms = np.array(tilted.arms(0.0))
    moment = theory.MASS * theory.GRAVITY * (tilted.shares @ arms)
    assert moment == pytest.approx(0.01 * theory.measured(push).force)
    ratios = np.array(tilted.shares) / level.shares
    plane = np.column_stack((np.ones(len(arms)), arms.real, arms.imag))
    assert plane @ np.linalg.lstsq(plane, ratios)[0] == pytest.approx(ratios)


def test_shares_of_feet_follow_from_the_centre_of_mass():
    assert theory.contact_of(SERIES).shares == pytest.approx([0.25, 0.5, 0.25])


def test_errors_agree_with_the_first_look_of_the_table():
    """Median errors in degrees of an analysis by another script, with another start of the mean force."""
    expected = {"10_130_10_10_10_130": 6.3, SERIES: 4.5, "30_90_30_30_30_90": 5.3, "patch": 4.4}
    expected |= {"wood_10_130_10_10_10_130": 6.0, "wood_30_90_30_30_30_90": 8.7, "wood_patch": 6.0}
    for series, median in expected.items():
        found = theory.errors(theory.by_series()[series], theory.force_error)
        assert np.median(found) == pytest.approx(median, abs=0.5)


def test_each_push_is_validated_once():
    *directions, wrench, work, position = validations(every=50)
    assert sum(one.count for one in directions) == wrench.count == work.count == len(reduced_pushes()) == 350
    assert sorted(series for group in GROUPS.values() for series in group) == sorted(theory.by_series())
    assert position.count == len(chosen(50)) == 7
    for one in (*directions, wrench, work, position):
        assert 0.0 < one.error_uncertainty < one.error
        # A study that validates the law would need another text.
        assert 0.0 < one.explained < EXPECTED
        assert one.factor > 1.0
        assert one.model > 0.0
    assert "this does not validate Coulomb's law" in TEXT


def test_larger_uncertainties_or_an_error_of_the_theory_explain_the_expected_share():
    random = np.random.default_rng(2)
    errors = np.abs(random.normal(0.0, 3.0, 999))
    known = theory.Uncertainties(np.full(999, 0.8), np.full(999, 0.6), np.zeros(999))
    factor, model = known.missing(errors)
    assert (factor, model) == pytest.approx((3.0 * norm.ppf(0.975) / 2.0, math.sqrt(8.0)), rel=0.05)
    for scale in (0.999, 1.001):
        larger = [
            theory.Uncertainties(scale * factor * known.data, scale * factor * known.input, known.numerical),
            theory.Uncertainties(known.data, known.input, np.full(999, scale * model)),
        ]
        assert {one.share_explained(errors) >= EXPECTED for one in larger} == {scale > 1.0}
    assert theory.Uncertainties(errors, errors, errors).missing(errors)[1] == 0.0


def test_the_text_contains_the_numbers_of_the_measurements():
    series = theory.by_series()
    lifts, turns = np.transpose([theory.pose_errors(pushes) for pushes in series.values()])
    assert f"by {lifts.min():.1f} to {lifts.max():.1f} mm and {1e3 * turns.min():.0f} to " in TEXT
    assert f"{1e3 * turns.max():.0f} mrad" in TEXT
    above = partial(theory.pushed_above, height=10.0)
    angle, before = (
        np.median(theory.errors(series["patch"], theory.force_error, *law)) for law in ([above], [])
    )
    assert f"a median error of {angle:.1f} degrees, a third less" in TEXT
    assert angle == pytest.approx(2.0 / 3.0 * before, rel=0.05)
    ratios, scatters, larger = [], [], {}
    for name, pushes in series.items():
        work = np.array([theory.work_error(push, theory.coulomb) for push in pushes])
        ratios.append(np.median(np.abs(work) / theory.uncertainties(pushes, theory.work_error).total))
        scatters.append(theory.scatter(pushes, theory.work_error)[0])
        larger[name] = np.mean(work > 0.0)
        raised = np.median(theory.errors(pushes, theory.work_ratio, above))
        assert raised == pytest.approx(np.median(theory.errors(pushes, theory.work_ratio)), rel=0.01)
    assert (round(min(ratios)), round(max(ratios))) == (4, 15)
    assert "by four to fifteen times its known uncertainty" in TEXT
    assert f"scatter by {min(scatters):.0f} to {max(scatters):.0f} %" in TEXT
    assert [name for name, share in larger.items() if share < 0.65] == ["wood_patch"]


def test_the_work_is_as_uncertain_as_the_last_digit_of_the_sliding_force(monkeypatch):
    monkeypatch.setattr(theory, "CENTRE_TO", 0.0)
    pushes = theory.by_series()["wood_patch"]
    found = theory.uncertainties.__wrapped__(pushes, theory.work_error)
    ratios = theory.errors(pushes, theory.work_ratio)
    assert found.input == pytest.approx(100.0 * ratios * 0.1 / math.sqrt(12.0) / 5.0, rel=0.01)


def test_data_uncertainties_are_the_effect_of_errors_of_that_size():
    """Here all measured numbers have random errors at once; the study changes one after the other."""
    random = np.random.default_rng(1)
    pushes = theory.by_series()["patch"]
    shift, turn = theory.pose_errors(pushes)
    sizes = {"x": shift, "y": shift, "turn": turn, "end_x": shift / 2**0.5, "end_y": shift / 2**0.5}
    push = pushes[0]
    sizes |= {"force_x": push.noise, "force_y": push.noise}
    for of in (theory.force_error, theory.wrench_difference, theory.work_error):
        found = []
        for _ in range(300):
            moved = {name: getattr(push, name) + random.normal(0.0, size) for name, size in sizes.items()}
            found.append(np.ravel(of(replace(push, **moved), theory.coulomb)))
        expected = np.linalg.norm(np.std(found, axis=0))
        assert theory.uncertainties(pushes, of).data[0] == pytest.approx(expected, rel=0.15)


def test_equal_pushes_scatter_by_the_errors_of_each():
    push = obeying(theory.by_series()["patch"][0], 4.2)
    quantiles = norm.ppf((np.arange(60) + 0.5) / 60)  # in degrees
    turned = [np.exp(1j * math.radians(angle)) * complex(push.force_x, push.force_y) for angle in quantiles]
    pushes = [replace(push, force_x=force.real, force_y=force.imag) for force in turned]
    found, pairs = theory.scatter([*pushes, replace(push, start_x=push.start_x + 6.0)])
    assert pairs == 60 * 59 / 2
    assert found == pytest.approx(1.0, rel=0.02)


def test_the_theory_claims_feel_a_wrong_moment(monkeypatch):
    right = theory.wrench_of_slip
    monkeypatch.setattr(theory, "wrench_of_slip", lambda *of: (right(*of)[0], 1.001 * right(*of)[1]))
    assert set(theory_of(STUDY, *FEW, few=FEW).values()) == {DIFFERS}


def test_a_push_through_the_centre_of_mass_only_moves_the_body():
    """The hand pushes the lower leg upwards from a gap of 2 mm to 10 mm, seen from the first pose."""
    ends = {"start_x": 50.0, "start_y": -2.0, "end_x": 50.0, "end_y": 0.0, "x": 0.0, "y": 10.0, "turn": 0.0}
    push = replace(theory.by_series()["patch"][0], **ends)
    position, angle = forward.quasi_static(push)
    assert position == pytest.approx(0.01j, abs=1e-7)
    assert angle == pytest.approx(0.0, abs=1e-6)
    position, angle = forward.by_exudyn(push, 1e-5)
    assert position == pytest.approx(0.01j - 4.2j / forward.STIFFNESS, abs=1e-6)
    assert angle == pytest.approx(0.0, abs=1e-4)


def test_a_figure_shows_final_positions_if_they_were_simulated(monkeypatch):
    monkeypatch.setattr(pictures, "_forces", lambda: None)
    without = pictures.draw({})["pushes-errors"]
    shown = pictures.draw({"exudyn": {"reference": [1.0, 2.0], "exudyn": [1.0, 3.0]}})["pushes-errors"]
    assert len(without.axes) == 2
    assert shown.axes[2].get_legend_handles_labels()[1] == ["reference", "exudyn"]
