"""The run-up balances its energy, its figures show what is there, and its spectrum finds a known whirl."""

import numpy as np
import pytest
from studies_under_test import findings_of, sentences, verdicts

from compare.claims.claim import Verdict
from compare.studies.drivetrain.run_up import claims as study
from compare.studies.drivetrain.run_up import pictures
from compare.studies.toolkit.drivetrain_bench import RPM, onset_speed, passenger_car
from exudyn_models.parts.friction_sensors import RingFriction

FEW = {"top": 1100.0}


@pytest.fixture(scope="module")
def findings():
    return findings_of(study, "exudyn", FEW)


def test_the_energy_is_balanced(findings):
    assert verdicts(findings) == {study.BALANCE: Verdict.AGREES}


def test_the_mean_torque_brings_the_engine_to_the_end(findings):
    assert findings.data["engine"][-1, 1] == pytest.approx(FEW["top"] * RPM, rel=0.02)
    assert findings.data["slip"][-1] == pytest.approx(study.SLIP, abs=4.0)


def test_heat_that_is_counted_wrong_by_a_thousandth_is_found_out(monkeypatch):
    power = RingFriction.power
    monkeypatch.setattr(RingFriction, "power", lambda friction, mbs, t: 1.001 * power(friction, mbs, t))
    assert sentences(findings_of(study, "exudyn", {"top": 850.0}), Verdict.DIFFERS) == {study.BALANCE}


def run_up_with(orders, until=6000.0):
    """Return data of a run-up in which the disc circles with the given orders of the engine, by amplitude in m."""
    times = np.linspace(0.0, 5.0, 10001)
    start, end = 800.0 * RPM, until * RPM
    speed = start + (end - start) * times / times[-1]
    angle = start * times + 0.5 * (end - start) * times**2 / times[-1]
    z = sum(amplitude * np.exp(1j * order * angle) for order, amplitude in orders.items())
    disc = np.column_stack((z.real, z.imag, angle))
    return {
        "times": times,
        "engine": np.column_stack((angle, speed)),
        "disc": disc,
        "slip": 12.0 + 0.0 * times,
    }


def test_the_spectrum_finds_amplitude_order_and_sense_of_a_whirl():
    speed, orders, amplitude = pictures.order_spectrum(run_up_with({0.9: 5e-4, -0.9: 1e-4, 0.0: 2e-4}))
    assert speed[0] > 800.0 * RPM
    assert speed[-1] < 6000.0 * RPM
    width = orders[1] - orders[0]
    for order, expected in ((0.9, 5e-4), (-0.9, 1e-4), (0.0, 2e-4)):
        near = np.abs(orders - order) < 0.2
        peak = amplitude[near].max(axis=0)
        # A window of Hann loses up to 4 % of a line half way between two of twice its own spacing.
        np.testing.assert_allclose(peak, expected, rtol=0.05)
        assert np.all(np.abs(orders[near][amplitude[near].argmax(axis=0)] - order) <= width)


def test_the_envelope_goes_from_the_least_to_the_largest_distance():
    data = run_up_with({0.0: 2e-4, 1.0: 1e-4})
    speed, least, largest = pictures.envelope(data, np.abs(pictures.centre(data["disc"])))
    np.testing.assert_allclose(least[1:-1], 1e-4, rtol=0.05)
    np.testing.assert_allclose(largest[1:-1], 3e-4, rtol=0.01)
    assert np.all(np.diff(speed) > 0.0)


def test_the_reference_predicts_self_centring_below_the_onset_and_a_whirl_above():
    data = study.theory().data
    car = passenger_car()
    speed, rest = data["rest"].T
    assert np.all(np.diff(rest) < 0.0)
    assert rest[0] < car.offset
    assert speed[-1] < data["onset"][0] < data["whirl"][0, 0]
    assert data["onset"][0] == onset_speed(car, study.SLIP, study.transmitted(car))
    assert np.all(data["whirl"][:, 1] > car.stop_gap)
    # The unbalance resonates where the disc itself, which slips, turns at k.
    assert speed[np.argmax(data["unbalance"])] == pytest.approx(data["onset"][1] + study.SLIP, rel=0.02)


def as_predicted(off=0.0):
    """Return data of a run-up on the lines of the claim, but for ``off`` orders, as it turns faster."""
    data = run_up_with({1.0: 1e-4})
    car = passenger_car()
    times, (angle, speed) = data["times"], data["engine"].T
    circling, _, frequency = study.whirls_above_onset(car).T
    below = speed < 0.5 * (circling[0] + pictures.natural_frequency(car))
    own = np.where(below, speed - study.SLIP, np.interp(speed, circling, frequency)) + off * speed
    phase = np.concatenate(([0.0], np.cumsum(0.5 * (own[1:] + own[:-1]) * np.diff(times))))
    z = 3e-4 * np.exp(1j * phase) + 1e-4
    return data | {"disc": np.column_stack((z.real, z.imag, angle))}


def test_a_disc_on_the_lines_is_found_on_them():
    claim = study.lines_claim("exudyn", as_predicted(), as_predicted())
    assert claim.verdict is Verdict.AGREES
    assert np.max(claim.difference) < 0.5 / pictures.TURNS


@pytest.mark.parametrize(
    ("wrong", "windows"),
    [
        (run_up_with({0.98: 3e-4, 0.0: 1e-4}), "above"),  # it follows its unbalance all the way
        (run_up_with({0.88: 3e-4, 0.0: 1e-4}), "below"),  # it whirls from the beginning
        (as_predicted(off=1.5 / pictures.TURNS), "above"),
    ],
)
def test_a_disc_beside_its_line_is_found_out(wrong, windows):
    claim = study.lines_claim("exudyn", wrong, wrong)
    assert claim.verdict is Verdict.DIFFERS
    speeds, _ = pictures.strongest_line(wrong)
    ends = pictures.natural_frequency(passenger_car()), study.whirls_above_onset(passenger_car())[0, 0]
    chosen = speeds[(speeds < ends[0]) | (speeds >= ends[1])]
    off = claim.difference > claim.budget.total
    assert np.all(off[chosen >= ends[1]] if windows == "above" else off[chosen < 0.8 * ends[0]])


def test_a_run_up_shorter_than_a_window_claims_nothing_of_the_spectrum(findings):
    assert study.LINES not in verdicts(findings)


def test_figures_and_animation_are_drawn_of_what_is_there(findings, monkeypatch):
    monkeypatch.setattr(pictures, "FRAMES", 1)
    drawn = {"exudyn": run_up_with({0.9: 5e-4, 0.0: 2e-4}), "theory": study.theory().data}
    figures = study.STUDY.draw(drawn)
    gifs = study.STUDY.animations(drawn)
    assert {*figures, *gifs} == set(study.STUDY.figures)
    assert all(each.startswith(b"GIF89a") for each in gifs.values())
    assert study.STUDY.draw({"theory": study.theory().data}) == {}
    assert study.STUDY.animations({}) == {}
    assert set(drawn["exudyn"]) == set(findings.data)
