"""The study of judder, heat and energy: its closed forms solve the equations."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import compare.studies.drivetrain.clutch_parts as study
from compare.studies.drivetrain.clutch_parts import held, slipping_time


def moment(temperature):
    return study.MOMENT * (1.0 - study.FADE * (temperature - study.SURROUNDINGS))


@pytest.mark.parametrize("end", [150.0, 10.0, 1.0])
def test_the_closed_form_of_the_slipping_time_solves_the_equations(end):
    def rates(t, y):
        return [-moment(y[1]) / study.REDUCED, moment(y[1]) * y[0] / study.CAPACITY]

    start, until = [study.SLIP, study.SURROUNDINGS], (0.0, slipping_time(end))
    run = solve_ivp(rates, until, start, rtol=1e-12, atol=1e-12, method="DOP853")
    assert run.y[0, -1] == pytest.approx(end, abs=1e-8)


def test_the_closed_form_of_the_held_slip_solves_its_equation():
    def rate(t, y):
        loss = study.CONDUCTANCE * (y - study.SURROUNDINGS)
        return (moment(y) * study.SLOW_SLIP - loss) / study.CAPACITY

    until, start = (0.0, study.HELD[-1]), [study.SURROUNDINGS]
    run = solve_ivp(rate, until, start, t_eval=study.HELD, rtol=1e-12, atol=1e-12, method="DOP853")
    np.testing.assert_allclose(held(study.HELD), run.y[0], atol=1e-8)
