"""The study of convergence: known exponents, orders and shifts by creep are found."""

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
def test_figures_are_drawn_for_any_finished_engines(names):
    figures = STUDY.draw({name: ENGINE_CONVERGENCE.found(name).data for name in names})
    assert set(figures) <= set(STUDY.figures)
    assert ("engine-convergence-orders" in figures) == ("exudyn" in names)


def test_the_shift_of_a_release_by_creep_agrees_with_an_integration():
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


def test_the_exponent_of_a_power_law_with_a_next_term():
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


@pytest.mark.parametrize("bad", [np.nan, np.inf, 0.0])
def test_an_order_of_invalid_errors_is_nan(bad):
    errors = np.array([1e-2, 1e-3, bad, 1e-5, 1e-6])
    assert np.isnan(observed_exponent(errors, errors, next_term=1.0)[0])
    assert np.isnan(extrapolated_order(errors, 0.0)[0])
