"""The study of the warm clutch agrees, its claims fail for wrong parts, and its closed forms are the equations'."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from study_harness import BLIND, SEES
from wrong_parts import WrongPartTests

import compare.studies.drivetrain.warm_clutch.model as model
from compare.studies.drivetrain.warm_clutch.claims import STUDY
from compare.studies.drivetrain.warm_clutch.parameters import (
    CAPACITY,
    CONDUCTANCE,
    ENGAGED,
    FADE,
    HELD,
    LOAD,
    RADIUS,
    SLIP,
    SLOW_SLIP,
    SURROUNDINGS,
)
from compare.studies.drivetrain.warm_clutch.theory import REDUCED, held, slip, slipping_time, warmed
from exudyn_models import add_ring_friction, add_thermal_node


def off(name, factor):
    """Let the model be built with a number that is off."""
    return lambda patch: patch.setattr(model, name, factor * getattr(model, name))


def conductance_off(patch):
    def leaky(*arguments, conductance, **options):
        return add_thermal_node(*arguments, conductance=1.001 * conductance, **options)

    patch.setattr("exudyn_models.add_thermal_node", leaky)


def heat_astray(patch):
    def added(*arguments, thermal_node, **options):
        friction = add_ring_friction(*arguments, thermal_node=thermal_node, **options)
        thermal_node.heated_by(lambda mbs, t: -1e-3 * friction.power(mbs, t))
        return friction

    patch.setattr("exudyn_models.add_ring_friction", added)


class TestWarmClutch(WrongPartTests):
    study = STUDY
    faults = {
        "load 0.1 % too large": off("LOAD", 1.001),
        "fade 0.1 % too large": off("FADE", 1.001),
        "conductance 0.1 % too large": conductance_off,
        "0.1 % of the heat goes astray": heat_astray,
    }
    columns = ("slips", "warms", "takes_longer", "settles", "balance")
    table = {
        "load 0.1 % too large": (SEES, SEES, SEES, SEES, BLIND),
        "fade 0.1 % too large": (SEES, SEES, SEES, SEES, BLIND),
        "conductance 0.1 % too large": (BLIND, BLIND, BLIND, SEES, BLIND),
        "0.1 % of the heat goes astray": (SEES, SEES, SEES, SEES, SEES),
    }


def integrated(rates, start, times):
    return solve_ivp(rates, (0.0, times[-1]), start, t_eval=times, rtol=1e-12, atol=1e-12, method="DOP853").y


def moment(temperature):
    return model.COEFFICIENT * (1.0 - FADE * (temperature - SURROUNDINGS)) * LOAD * RADIUS


def test_the_closed_form_is_the_engagement():
    def rates(t, y):
        return [-moment(y[1]) / REDUCED, moment(y[1]) * y[0] / CAPACITY]

    slips, temperatures = integrated(rates, [SLIP, SURROUNDINGS], ENGAGED)
    np.testing.assert_allclose(slip(ENGAGED), slips, atol=1e-8)
    np.testing.assert_allclose(warmed(slips), temperatures, atol=1e-8)
    assert slip(np.array([slipping_time(1.0)]))[0] == pytest.approx(1.0, rel=1e-11)


def test_the_closed_form_is_that_of_a_held_slip():
    def rates(t, y):
        return (moment(y) * SLOW_SLIP - CONDUCTANCE * (y - SURROUNDINGS)) / CAPACITY

    np.testing.assert_allclose(held(HELD), integrated(rates, [SURROUNDINGS], HELD)[0], atol=1e-8)
