"""Order of a step and its error estimate, and the dense output between steps."""

import numba
import numpy as np
import pytest

from reference_model.ensemble.core.stepping.dense_output import Motion, dense_output, position_on, velocity_on
from reference_model.ensemble.core.stepping.runge_kutta import step


@numba.njit
def pendulum(y, law):
    return y[1], -law * np.sin(y[0]), 1.0


@numba.njit
def swing(start, law, h, steps):
    y = start
    for _ in range(steps):
        mean, _, _ = step(pendulum, law, y, pendulum(y, law), h)
        y = (y[0] + h * mean[0], y[1] + h * mean[1])
    return y


def test_step_is_of_eighth_order():
    exact = np.array(swing((1.0, 0.5), 2.0, 0.005, 800))
    errors = [np.abs(np.array(swing((1.0, 0.5), 2.0, 4.0 / n, n)) - exact).max() for n in (10, 20, 40)]
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    assert np.all(orders > 7.5), orders


def motion_at(x, y, t):
    places = [
        complex(p(t), q(t)) for p, q in ((x.deriv(i) if i else x, y.deriv(i) if i else y) for i in range(4))
    ]
    return Motion(*places)


def test_dense_output_is_exact_for_polynomials_of_degree_seven():
    rng = np.random.default_rng(0)
    x, y = (np.polynomial.Polynomial(rng.normal(size=8)) for _ in range(2))
    between = dense_output(0.8, motion_at(x, y, 0.3), motion_at(x, y, 1.1))
    for u in np.linspace(0.0, 1.0, 7):
        t = 0.3 + 0.8 * u
        assert position_on(between, u) == pytest.approx(complex(x(t), y(t)), rel=1e-12, abs=1e-12)
        assert velocity_on(between, u) == pytest.approx(
            complex(x.deriv()(t), y.deriv()(t)), rel=1e-11, abs=1e-11
        )
