import numpy as np
import pytest
from studies_under_test import Patched
from tested_studies import RUN_UP
from wrong_parts import as_predicted, moving, run_up_with

from compare.studies.drivetrain.run_up import pictures
from compare.studies.drivetrain.run_up.study import (
    SLIP,
    TURNS,
    order_spectrum,
    strongest_line,
    transmitted,
    whirls_above_onset,
)
from compare.studies.toolkit.drivetrain_bench import (
    RPM,
    centre,
    natural_frequency,
    onset_speed,
    passenger_car,
)


def test_a_disc_on_the_predicted_lines_agrees():
    (claim,) = RUN_UP.claims_of_fault(Patched(moving(as_predicted())), ("lines",))
    assert np.max(claim.difference) < 0.5 / TURNS
    # Half of the errors exceed this if interpolation is wrong.
    assert np.median(claim.difference) < 0.125 / TURNS


def test_a_disc_off_its_line_differs_below_the_natural_frequency():
    """The faults of every study are above the onset."""
    move = run_up_with({0.88: 3e-4, 0.0: 1e-4})
    (claim,) = RUN_UP.claims_of_fault(Patched(moving(move)), ("lines",))
    speeds, _ = strongest_line(move)
    end, onset = natural_frequency(passenger_car()), whirls_above_onset(passenger_car())[0, 0]
    chosen = speeds[(speeds < end) | (speeds >= onset)]
    assert np.all((claim.difference > claim.budget.total)[chosen < 0.8 * end])


def test_the_mean_torque_brings_the_engine_to_its_final_speed():
    data = RUN_UP.found("exudyn").data
    assert data["engine"][-1, 1] == pytest.approx(1100.0 * RPM, rel=0.02)
    assert data["slip"][-1] == pytest.approx(SLIP, abs=4.0)


def test_the_reference_predicts_self_centring_below_the_onset_and_a_whirl_above():
    data = RUN_UP.found("theory").data
    car = passenger_car()
    speed, rest = data["rest"].T
    assert np.all(np.diff(rest) < 0.0)
    assert rest[0] < car.offset
    assert speed[-1] < data["onset"][0] < data["whirl"][0, 0]
    assert data["onset"][0] == onset_speed(car, SLIP, transmitted(car))
    assert np.all(data["whirl"][:, 1] > car.stop_gap)
    # The unbalance resonates if the slipping disc turns at k.
    assert speed[np.argmax(data["unbalance"])] == pytest.approx(data["onset"][1] + SLIP, rel=0.02)


def test_figures_are_drawn_from_any_available_data(monkeypatch):
    monkeypatch.setattr(pictures, "FRAMES", 1)
    theory = RUN_UP.found("theory").data
    drawn = {"exudyn": run_up_with({0.9: 5e-4, 0.0: 2e-4}), "theory": theory}
    figures = RUN_UP.study.draw(drawn)
    gifs = RUN_UP.study.animate(drawn)
    assert {*figures, *gifs} == set(RUN_UP.study.figures)
    assert all(each.startswith(b"GIF89a") for each in gifs.values())
    assert RUN_UP.study.draw({"theory": theory}) == {}
    assert RUN_UP.study.animate({}) == {}
    assert set(drawn["exudyn"]) == set(RUN_UP.found("exudyn").data)


def test_the_spectrum_has_amplitude_order_and_sense_of_a_whirl():
    speed, orders, amplitude = order_spectrum(run_up_with({0.9: 5e-4, -0.9: 1e-4, 0.0: 2e-4}))
    assert speed[0] > 800.0 * RPM
    assert speed[-1] < 6000.0 * RPM
    width = orders[1] - orders[0]
    for order, expected in ((0.9, 5e-4), (-0.9, 1e-4), (0.0, 2e-4)):
        near = np.abs(orders - order) < 0.2
        peak = amplitude[near].max(axis=0)
        # A Hann window loses up to 4 % of a line between two frequencies of the spectrum.
        np.testing.assert_allclose(peak, expected, rtol=0.05)
        assert np.all(np.abs(orders[near][amplitude[near].argmax(axis=0)] - order) <= width)


def test_the_envelope_spans_the_least_and_the_largest_distance():
    data = run_up_with({0.0: 2e-4, 1.0: 1e-4})
    speed, least, largest = pictures.envelope(data, np.abs(centre(data["disc"])))
    np.testing.assert_allclose(least[1:-1], 1e-4, rtol=0.05)
    np.testing.assert_allclose(largest[1:-1], 3e-4, rtol=0.01)
    assert np.all(np.diff(speed) > 0.0)
