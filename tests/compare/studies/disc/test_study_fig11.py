"""The study of Fig. 11: eigenvalues, multipliers and spectra agree with each other."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from compare.engines import EVERY_KIND, Engine
from compare.studies.disc.fig11 import STUDY, pictures, theory, whirl
from compare.studies.disc.fig11.parameters import TIMES, UNTIL
from compare.studies.toolkit.fig11 import DISCS, RING
from reference_model import Trajectory, self_centred_equilibria, whirl_orbit, whirls


def states_of(z):
    """Return states whose centre moves like the complex ``z``."""
    return np.column_stack((z.real, z.imag, *np.zeros((4, len(z)))))


def test_many_points_lose_their_stability_like_the_ring():
    """Points are a quadrature of the ring, which converges faster than any power while no point comes to rest."""
    exact = theory.steady_whirl(RING).eigenvalue
    errors = [
        abs(theory.steady_whirl(replace(RING, contact_points=points)).eigenvalue - exact)
        for points in (6, 12, 24)
    ]
    # If the error fell like a power, each doubling would divide it by the same number.
    assert errors[0] / errors[1] < errors[1] / errors[2]
    assert errors[2] < 1e-3 * abs(exact)


def test_modes_of_the_whirl_are_eigenvectors_of_its_growth():
    """The share of the pair in a deviation along the mode is a half, and not that of the conjugate."""
    for disc in DISCS.values():
        one = theory.steady_whirl(disc)
        assert one.projection @ one.mode == pytest.approx(1.0, abs=1e-9)
        assert abs(one.projection @ one.mode.conj()) < 1e-5


def test_the_growth_of_an_exponential_is_found_with_its_scatter():
    times = np.linspace(0.0, 200.0, 33)
    share = 0.7j * np.exp((0.01 + 0.03j) * times)
    slopes, scatter = whirl.fitted(times, share)
    assert slopes == pytest.approx([0.01, 0.03], abs=1e-12)
    assert np.all(scatter < 1e-12)
    noise = 1e-4 * np.random.default_rng(3).standard_normal(len(times))
    slopes, scatter = whirl.fitted(times, share * (1.0 + noise))
    assert 0.0 < abs(slopes[0] - 0.01) < 2.0 * scatter[0] < 1e-5


def test_multipliers_by_variation_are_the_exponentials_of_the_eigenvalues_of_the_circle():
    circle = whirl_orbit(RING, tolerance=1e-10, samples=2)
    multipliers = theory.multipliers_by_variation(RING, circle)
    exact = np.exp(np.array(whirls(RING)[0].eigenvalues) * 2.0 * math.pi / RING.natural_frequency)
    assert sorted(np.abs(multipliers)) == pytest.approx(sorted(np.abs(exact)), abs=1e-8)


def test_the_whirl_ends_where_a_pair_of_eigenvalues_of_the_equilibrium_crosses_the_axis():
    below, above = (
        self_centred_equilibria(theory.disc_at(theory.rest_offset() + shift))[0] for shift in (-1e-5, 1e-5)
    )
    assert above.stable
    assert not below.stable
    assert abs(below.eigenvalues[0].imag) == pytest.approx(RING.natural_frequency, rel=0.01)


def test_lines_of_a_known_modulation_are_its_side_bands():
    """A carrier whose size swings by a cosine has one side band on each side, with half of the swing."""
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


def test_a_motion_without_a_modulation_has_none():
    last, change = theory.last_modulation(states_of(0.02 * np.exp(1j * TIMES)))
    assert last.shape == change.shape == (6,)


def test_an_engine_that_tells_no_phases_is_not_asked_when_single_points_rest():
    def at_rest(system, initial_state, times, *, tolerance=1e-9):
        return Trajectory(system, np.array(times), np.zeros((len(times), system.state_size)))

    found = STUDY.measure(Engine("mine", at_rest, EVERY_KIND, phases=False), only=("points_rest",))
    assert (found.claims, found.not_simulated) == ((), "mine does not report when single points rest")
