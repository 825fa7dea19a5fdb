"""The run-up balances its energy, its figures show what is there, and its spectrum finds a known whirl."""

from types import SimpleNamespace

import numpy as np
import pytest
from study_harness import BLIND, LEFT_OUT, SEES
from wrong_parts import WrongPartTests

from compare.studies.drivetrain.run_up import pictures, study
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
from exudyn_models.parts.friction_sensors import RingFriction

SHORT = 1100.0
"""Turns a minute; before a window of the spectrum is full."""


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


def as_predicted(off=0.0):
    """Return data of a run-up on the lines of the claim, but for ``off`` orders, as it turns faster."""
    data = run_up_with({1.0: 1e-4})
    car = passenger_car()
    times, (angle, speed) = data["times"], data["engine"].T
    circling, _, frequency = whirls_above_onset(car).T
    below = speed < 0.5 * (circling[0] + natural_frequency(car))
    own = np.where(below, speed - SLIP, np.interp(speed, circling, frequency)) + off * speed
    phase = np.concatenate(([0.0], np.cumsum(0.5 * (own[1:] + own[:-1]) * np.diff(times))))
    z = 3e-4 * np.exp(1j * phase) + 1e-4
    return data | {"disc": np.column_stack((z.real, z.imag, angle))}


MOVES = {
    "on its lines": as_predicted,
    "follows its unbalance all the way": lambda: run_up_with({0.98: 3e-4, 0.0: 1e-4}),
    "whirls from the beginning": lambda: run_up_with({0.88: 3e-4, 0.0: 1e-4}),
    "beside its lines": lambda: as_predicted(off=1.5 / TURNS),
}


def moving(move):
    """Let every run-up be one with the data of ``move()``."""

    def put(patch):
        data = move()
        angle, speed = data["engine"].T
        motion = SimpleNamespace(**data | {"engine_angle": angle, "engine_speed": speed})
        patch.setattr(study, "_run_ups", lambda engine, top: (motion, motion))

    return put


def heat_counted_wrong_by_a_thousandth(patch):
    power = RingFriction.power
    patch.setattr(RingFriction, "power", lambda friction, mbs, t: 1.001 * power(friction, mbs, t))


class TestDrivetrainRunUp(WrongPartTests):
    study = study.STUDY
    few = {"balance": {"top": SHORT}, "lines": {"top": SHORT}, "curves": {"count": 40}}
    # A run-up shorter than a window claims nothing of the spectrum.
    not_claimed = {"exudyn": ("lines",)}
    few_of_faults = {"balance": {"top": 850.0}}
    faults = {"heat": heat_counted_wrong_by_a_thousandth} | {
        name: moving(move) for name, move in MOVES.items()
    }
    columns = ("balance", "lines")
    table = {
        "heat": (SEES, LEFT_OUT),
        "on its lines": (LEFT_OUT, BLIND),
        "follows its unbalance all the way": (LEFT_OUT, SEES),
        "whirls from the beginning": (LEFT_OUT, SEES),
        "beside its lines": (LEFT_OUT, SEES),
    }

    def test_a_disc_on_the_lines_is_found_on_them(self):
        (claim,) = self.claims_of_fault("on its lines", "lines")
        assert np.max(claim.difference) < 0.5 / TURNS

    @pytest.mark.parametrize(
        ("move", "windows"),
        [
            ("follows its unbalance all the way", "above"),
            ("whirls from the beginning", "below"),
            ("beside its lines", "above"),
        ],
    )
    def test_a_disc_beside_its_line_is_found_out_in_the_windows_where_it_is(self, move, windows):
        (claim,) = self.claims_of_fault(move, "lines")
        speeds, _ = strongest_line(MOVES[move]())
        ends = natural_frequency(passenger_car()), whirls_above_onset(passenger_car())[0, 0]
        chosen = speeds[(speeds < ends[0]) | (speeds >= ends[1])]
        off = claim.difference > claim.budget.total
        assert np.all(off[chosen >= ends[1]] if windows == "above" else off[chosen < 0.8 * ends[0]])

    def test_the_mean_torque_brings_the_engine_to_the_end(self):
        data = self.found("exudyn").data
        assert data["engine"][-1, 1] == pytest.approx(SHORT * RPM, rel=0.02)
        assert data["slip"][-1] == pytest.approx(SLIP, abs=4.0)

    def test_the_reference_predicts_self_centring_below_the_onset_and_a_whirl_above(self):
        data = self.found("theory").data
        car = passenger_car()
        speed, rest = data["rest"].T
        assert np.all(np.diff(rest) < 0.0)
        assert rest[0] < car.offset
        assert speed[-1] < data["onset"][0] < data["whirl"][0, 0]
        assert data["onset"][0] == onset_speed(car, SLIP, transmitted(car))
        assert np.all(data["whirl"][:, 1] > car.stop_gap)
        # The unbalance resonates where the disc itself, which slips, turns at k.
        assert speed[np.argmax(data["unbalance"])] == pytest.approx(data["onset"][1] + SLIP, rel=0.02)

    def test_figures_are_drawn_whatever_is_there(self, monkeypatch):
        monkeypatch.setattr(pictures, "FRAMES", 1)
        theory = self.found("theory").data
        drawn = {"exudyn": run_up_with({0.9: 5e-4, 0.0: 2e-4}), "theory": theory}
        figures = self.study.draw(drawn)
        gifs = self.study.animate(drawn)
        assert {*figures, *gifs} == set(self.study.figures)
        assert all(each.startswith(b"GIF89a") for each in gifs.values())
        assert self.study.draw({"theory": theory}) == {}
        assert self.study.animate({}) == {}
        assert set(drawn["exudyn"]) == set(self.found("exudyn").data)


def test_the_spectrum_finds_amplitude_order_and_sense_of_a_whirl():
    speed, orders, amplitude = order_spectrum(run_up_with({0.9: 5e-4, -0.9: 1e-4, 0.0: 2e-4}))
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
    speed, least, largest = pictures.envelope(data, np.abs(centre(data["disc"])))
    np.testing.assert_allclose(least[1:-1], 1e-4, rtol=0.05)
    np.testing.assert_allclose(largest[1:-1], 3e-4, rtol=0.01)
    assert np.all(np.diff(speed) > 0.0)
