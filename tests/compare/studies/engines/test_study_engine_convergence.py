"""The study of convergence: exponents, orders and the shift by creep are found where they are known."""

import numpy as np
import pytest
from faults.reference import simulate
from scipy.integrate import solve_ivp
from tested_studies import ENGINE_CONVERGENCE

from compare.claims.error_estimates import extrapolated_order, observed_exponent
from compare.claims.parameters import FIG5, FIG5_STARTS
from compare.studies.engines.engine_convergence.study import STUDY
from compare.studies.engines.engine_convergence.theory import release_shift_by_creep
from reference_model.motion.pin_equations import SlipMotion


@pytest.mark.parametrize("names", [("exudyn", "reference"), ("reference",), ("exudyn",), ()])
def test_figures_are_drawn_from_whatever_engines_have_finished(names):
    figures = STUDY.draw({name: ENGINE_CONVERGENCE.found(name).data for name in names})
    assert set(figures) <= set(STUDY.figures)
    assert ("engine-convergence-orders" in figures) == ("exudyn" in names)


def test_creep_shifts_a_release_as_an_integration_of_the_creep_says():
    epsilon = 1e-6
    for start in FIG5_STARTS.values():
        stick = simulate(FIG5, start, [0.0, 8.0], tolerance=1e-12).stick_phases[0]
        motion = SlipMotion.of(FIG5)

        def creep(_, z, motion=motion):
            z = complex(*z)
            v = 1j * motion.disc_speed * z + epsilon * motion.pull(z, 0j) / motion.friction
            return [v.real, v.imag]

        def excess(_, z, motion=motion):
            return abs(motion.pull(complex(*z), 0j)) - motion.friction

        excess.terminal = True
        run = solve_ivp(
            creep,
            (stick.start, stick.end + 1.0),
            stick.initial_state[:2],
            method="DOP853",
            events=excess,
            rtol=1e-13,
            atol=1e-14,
        )
        shift = (run.t_events[0][0] - stick.end) / epsilon
        assert release_shift_by_creep(FIG5, stick) == pytest.approx(shift, rel=1e-4)


def test_exponent_of_a_power_with_a_next_term_is_found():
    x = np.geomspace(1e-1, 1e-4, 16)
    exponent, numerical, model = observed_exponent(x, 3.0 * x**1.5 * np.exp(0.4 * x**0.25), next_term=0.25)
    assert exponent == pytest.approx(1.5, abs=1e-9)
    assert numerical < 1e-9
    assert 0.001 < model < 0.1


def test_scatter_widens_the_budget_of_an_exponent():
    random = np.random.default_rng(1)
    x = np.geomspace(1e-1, 1e-7, 25)
    inside = 0
    for _ in range(200):
        errors = x * np.exp(0.2 * random.standard_normal(25))
        exponent, numerical, _ = observed_exponent(x, errors, next_term=0.125)
        inside += abs(exponent - 1.0) <= numerical
    assert 0.9 <= inside / 200 <= 0.99


def test_order_is_extrapolated_to_small_steps():
    h = 0.5 ** np.arange(2, 8)
    order, numerical, model = extrapolated_order(h**4 * (1.0 + h), 0.0)
    assert order == pytest.approx(4.0, abs=1e-3)
    assert abs(order - 4.0) <= numerical + model < 0.05


@pytest.mark.parametrize("bad", [np.nan, np.inf, 0.0])
def test_without_numbers_there_is_no_order(bad):
    errors = np.array([1e-2, 1e-3, bad, 1e-5, 1e-6])
    assert np.isnan(observed_exponent(errors, errors, next_term=1.0)[0])
    assert np.isnan(extrapolated_order(errors, 0.0)[0])
