"""The study of judder, heat and energy agrees, and each of its claims fails for a wrong part."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from study_harness import BLIND, LEFT_OUT, OPEN, SEES
from wrong_parts import WrongPartTests

import compare.studies.drivetrain.clutch_parts as study
from compare.studies.drivetrain.clutch_parts import STUDY, held, slipping_time
from exudyn_models import add_ring_friction, add_thermal_node


def off(**factors):
    """Build the models with parameters that are off by ``factors``; the prediction keeps the right ones."""

    def put(patch):
        juddering, heating = study.juddering, study.heating

        def wrong(build):
            def built(*arguments):
                with pytest.MonkeyPatch.context() as inner:
                    for name, factor in factors.items():
                        inner.setattr(study, name, factor * getattr(study, name))
                    return build(*arguments)

            return built

        patch.setattr(study, "juddering", wrong(juddering))
        patch.setattr(study, "heating", wrong(heating))

    return put


def coefficient_without_its_slope(patch):
    def constant(*arguments, friction_coefficient, **options):
        return add_ring_friction(*arguments, friction_coefficient=study.COEFFICIENT, **options)

    patch.setattr("exudyn_models.add_ring_friction", constant)


def conductance_off(patch):
    def leaky(*arguments, conductance, **options):
        return add_thermal_node(*arguments, conductance=1.001 * conductance, **options)

    patch.setattr("exudyn_models.add_thermal_node", leaky)


def heat_astray(patch):
    def added(*arguments, **options):
        friction = add_ring_friction(*arguments, **options)
        options["thermal_node"].heated_by(lambda mbs, t: -1e-3 * friction.power(mbs, t))
        return friction

    patch.setattr("exudyn_models.add_ring_friction", added)


class TestClutchParts(WrongPartTests):
    study = STUDY
    faults = {
        "judder: load 0.1 % too large": off(LOAD=1.001),
        "judder: damping 0.1 % too large": off(DAMPING=1.001),
        "judder: stiffness 0.1 % too large": off(STIFFNESS=1.001),
        "judder: coefficient without its slope": coefficient_without_its_slope,
        "heat: load 0.1 % too large": off(PRESSED=1.001),
        "heat: fade 0.1 % too large": off(FADE=1.001),
        "heat: conductance 0.1 % too large": conductance_off,
        "heat: 0.1 % of it goes astray": heat_astray,
    }
    columns = ("onset", "takes_longer", "settles", "balance")
    table = {
        "judder: load 0.1 % too large": (SEES, LEFT_OUT, LEFT_OUT, LEFT_OUT),
        "judder: damping 0.1 % too large": (SEES, LEFT_OUT, LEFT_OUT, LEFT_OUT),
        "judder: stiffness 0.1 % too large": (BLIND, LEFT_OUT, LEFT_OUT, LEFT_OUT),
        # The growth is the same for all gradients, so it has no root.
        "judder: coefficient without its slope": (OPEN, LEFT_OUT, LEFT_OUT, LEFT_OUT),
        "heat: load 0.1 % too large": (LEFT_OUT, SEES, SEES, BLIND),
        "heat: fade 0.1 % too large": (LEFT_OUT, SEES, SEES, BLIND),
        "heat: conductance 0.1 % too large": (LEFT_OUT, BLIND, SEES, BLIND),
        "heat: 0.1 % of it goes astray": (LEFT_OUT, SEES, SEES, SEES),
    }


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
