from __future__ import annotations

import math

import numpy as np
import pytest

from compare.engines import EVERY_KIND, Engine
from compare.studies.disc.fig11 import STUDY, pictures, theory, whirl
from compare.studies.disc.fig11.theory import TIMES, UNTIL
from reference_model import Trajectory


def states_of(z):
    """Return states whose centre has the complex positions ``z``."""
    return np.column_stack((z.real, z.imag, *np.zeros((4, len(z)))))


def test_fitted_growth_of_an_exponential_and_its_scatter():
    times = np.linspace(0.0, 200.0, 33)
    share = 0.7j * np.exp((0.01 + 0.03j) * times)
    slopes, scatter = whirl.fitted(times, share)
    assert slopes == pytest.approx([0.01, 0.03], abs=1e-12)
    assert np.all(scatter < 1e-12)
    noise = 1e-4 * np.random.default_rng(3).standard_normal(len(times))
    slopes, scatter = whirl.fitted(times, share * (1.0 + noise))
    assert 0.0 < abs(slopes[0] - 0.01) < 2.0 * scatter[0] < 1e-5


def test_a_modulated_carrier_has_one_side_band_on_each_side():
    """A cosine modulation of the amplitude gives two side bands with half of its size."""
    period, carrier = 230.0, 1.002
    size = 0.02 + 0.01 * np.cos(2.0 * math.pi * TIMES / period)
    states = states_of(size * np.exp(1j * carrier * TIMES))
    heights = pictures.harmonics(states, period, carrier)
    expected = np.zeros(2 * pictures.SIDE_BANDS + 1)
    expected[pictures.SIDE_BANDS - 1 : pictures.SIDE_BANDS + 2] = 0.005, 0.02, 0.005
    # A cubic spline's error, of a function with derivatives below 0.03.
    assert heights == pytest.approx(expected, abs=0.03 * TIMES[1] ** 4 / 384.0)
    frequency, amplitude = pictures.spectrum(states)
    assert frequency[np.argmax(amplitude)] == pytest.approx(carrier, abs=math.pi / UNTIL)
    assert np.max(amplitude) == pytest.approx(0.02, rel=0.05)


def test_a_steady_whirl_has_no_modulation():
    last, change = theory.last_modulation(states_of(0.02 * np.exp(1j * TIMES)))
    assert last.shape == change.shape == (6,)


def test_resting_points_are_not_claimed_for_an_engine_without_phases():
    def at_rest(system, initial_state, times, *, tolerance=1e-9):
        return Trajectory(system, np.array(times), np.zeros((len(times), system.state_size)))

    found = STUDY.measure(Engine("mine", at_rest, EVERY_KIND, phases=False), only=("points_rest",))
    assert (found.claims, found.not_simulated) == ((), "mine does not report when single points rest")
