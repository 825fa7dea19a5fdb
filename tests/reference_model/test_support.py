"""The force of a support that hardens and has a stop, its derivatives, its inverse, and which formulas refuse it."""

import importlib
import inspect
import math
import pkgutil
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from plain_engines import support_force
from test_systems import refusal

import reference_model
from compare.claims.parameters import FIG11
from reference_model import PinOnDisc, stick_slip_orbits, whirls
from reference_model import smallest_load_with_whirl as smallest_load
from reference_model.contact.contact_law import Ring
from reference_model.formulas import disc as disc_formulas
from reference_model.formulas import pin as pin_formulas
from reference_model.formulas import torque_balance as disc_balance
from reference_model.formulas.characteristic_polynomial import characteristic_coefficients
from reference_model.formulas.pin.conditions import speed_ratio
from reference_model.motion.pin_equations import simulate_polar_form
from reference_model.steady import bifurcation_curves as boundaries
from reference_model.steady import lyapunov_coefficient as modulation
from reference_model.support import Support

PIN = PinOnDisc(
    mass=2.0, stiffness=1.5, damping=0.3, friction_force=0.4, disc_speed=3.0, offset=0.1,
    hardening=7.0, stop_gap=0.2, stop_stiffness=11.0,
)  # fmt: skip
SUPPORTS = [
    PIN,
    replace(PIN, stop_stiffness=0.0),
    replace(PIN, hardening=0.0),
    replace(PIN, stiffness=0.0),
    replace(PIN, stop_gap=0.0),
    replace(PIN, hardening=0.0, stop_stiffness=0.0),
]
coordinates = st.floats(-0.6, 0.6)
supports = st.sampled_from(SUPPORTS)


@given(supports, coordinates, coordinates)
def test_force_is_that_of_spring_hardening_and_stop(pin, x, y):
    force = Support.of(pin).force(complex(x, y))
    assert [force.real, force.imag] == pytest.approx(
        support_force(pin, [x, y, 0.0, 0.0]), rel=1e-13, abs=1e-14
    )


@given(supports, coordinates, coordinates)
def test_force_is_the_gradient_of_the_energy_and_stiffness_that_of_the_force(pin, x, y):
    support, z, h = Support.of(pin), complex(x, y), 1e-5
    if abs(abs(z - pin.offset) - pin.stop_gap) < 2.0 * h:  # no derivative there
        return
    force, steps = support.force(z), (h, 1j * h)
    slopes = [
        (support.energy(abs(z + s - pin.offset)) - support.energy(abs(z - s - pin.offset))) / (2.0 * h)
        for s in steps
    ]
    # Differences of third derivatives up to 6·7 N/m³ and C_s/gap², and of numbers of 5 J with an error of 1e-15.
    assert [-force.real, -force.imag] == pytest.approx(slopes, abs=h**2 * 500.0 + 1e-9)
    columns = [(support.force(z + s) - support.force(z - s)) / (2.0 * h) for s in steps]
    expected = -np.array([[column.real, column.imag] for column in columns]).T
    assert support.stiffness_matrix(z) == pytest.approx(expected, abs=h**2 * 2500.0 + 1e-9)


def test_where_the_stop_begins_there_is_no_stiffness():
    support = replace(Support.of(PIN), offset=0.0)
    assert refusal(support.stiffness_matrix, 0.2 + 0j).startswith("deflection = stop_gap = 0.2 m")
    assert replace(support, stop_stiffness=0.0).stiffness_matrix(0.2 + 0j)[0, 0] == pytest.approx(
        1.5 + 3 * 7 * 0.04
    )


@given(supports, st.floats(1e-6, 10.0))
def test_deflection_is_where_the_force_is_that_pull(pin, pull):
    support = Support.of(pin)
    assert support.pull(support.deflection(pull)) == pytest.approx(pull, rel=1e-13)


@given(supports, st.floats(1e-6, 10.0))
def test_on_the_circle_the_force_is_centripetal(pin, twice_kinetic_energy):
    support = Support.of(pin)
    radius = support.circle(twice_kinetic_energy)
    assert support.pull(radius) * radius == pytest.approx(twice_kinetic_energy, rel=1e-13)


def test_a_stop_alone_lets_the_mass_go_up_to_its_gap():
    support = Support.of(replace(PIN, stiffness=0.0, hardening=0.0))
    assert support.force(0.25 + 0.1j) == 0.0
    assert not support.centring
    assert support.deflection(1.1) == pytest.approx(0.3, rel=1e-14)  # 11 N/m · 0.1 m
    assert Support(stiffness=0.0, offset=0.1).deflection(1.0) == math.inf


@given(supports, coordinates, coordinates, st.floats(0.01, 100.0), st.floats(0.01, 100.0))
def test_scaled_support_has_the_scaled_force_at_the_scaled_place(pin, x, y, factor, length):
    support, z = Support.of(pin), complex(x, y)
    if abs(abs(z - pin.offset) - pin.stop_gap) < 1e-12:
        return
    expected = factor / length * support.force(z)
    assert support.scaled(factor, length).force(z / length) == pytest.approx(
        expected, rel=1e-12, abs=1e-13 * factor
    )


# ---------------------------------------------------------------- formulas of a linear support

HARD_PIN = replace(PIN, friction_force=0.1, stop_stiffness=0.0)
WITH_STOP = replace(PIN, friction_force=0.1, hardening=0.0)
LINEAR_PIN = replace(HARD_PIN, hardening=0.0)

OF_A_PIN = {
    "stick-slip orbits": lambda pin: stick_slip_orbits(replace(pin, friction_force=0.09)),
    "7": lambda pin: pin_formulas.squared_holding_force(pin, 0.1, 0.2),
    "turn until release": lambda pin: pin_formulas.turn_until_release(pin, 0.1, 0.2),
    "release time": lambda pin: pin_formulas.release_time(pin, 0.1, 0.2),
    "8": lambda pin: pin_formulas.sticking_margin(pin, 0.1),
    "9": lambda pin: pin_formulas.sticking_radius(replace(pin, friction_force=3.0)),
    "below 9": pin_formulas.resonant_disc_speed,
    "ω/(ω − k)": speed_ratio,
    "12": pin_formulas.variational_matrix,
    "13": pin_formulas.characteristic_coefficients,
    "13 as printed": pin_formulas.characteristic_coefficients_as_printed,
    "14": pin_formulas.coefficient_margins,
    "15": pin_formulas.lower_branch_margin,
    "16": pin_formulas.upper_branch_margin,
    "18": pin_formulas.whirl_shift,
    "first-order response": pin_formulas.first_order_whirl_response,
    "first-order shift": pin_formulas.first_order_whirl_shift,
    "limit of the error of 18": pin_formulas.whirl_shift_error_limit,
    "third order of the shift": pin_formulas.third_order_of_whirl_shift,
    "10": lambda pin: simulate_polar_form(pin, np.array([0.3, 0.0, 0.0, 0.3]), np.linspace(0.0, 0.1, 3)),
}
OF_A_DISC = {
    "25": disc_formulas.reduced_parameters,
    "26, first line": lambda disc: disc_formulas.speed_difference_at(disc, 0.1, 0.2),
    "26, second line": lambda disc: disc_formulas.squared_distance(disc, 0.2),
    "26 as printed": lambda disc: disc_formulas.squared_distance_as_printed(disc, 0.2),
    "places by 26": lambda disc: disc_formulas.places_by_26(replace(disc, offset=0.1)),
    "whirl at a ratio": lambda disc: disc_formulas.whirl_at(disc, 0.7),
    "smallest load": smallest_load,
    "least load": lambda disc: disc_balance.least_load_with_whirl(disc, Ring(0.12)),
    "arm of the whirl": lambda disc: disc_formulas.whirl_arm(disc, Ring(0.12)),
    "characteristic equation": lambda disc: characteristic_coefficients(disc, 1.0, 0.5),
    "boundaries": lambda disc: boundaries.ParameterPlane(
        disc, ("damping", "friction_force"), (0.1, 0.1), (0.2, 0.2)
    ),
    "modulation": lambda disc: modulation.growth_by_amplitude(disc, whirls(FIG11)[0].state),
}


@pytest.mark.parametrize("formula", OF_A_PIN)
def test_formula_of_the_pin_that_takes_a_linear_support_refuses_any_other(formula):
    OF_A_PIN[formula](LINEAR_PIN)
    message = "hardening = 7 N/m³: it must be 0 here, because only linear supports are covered"
    assert refusal(OF_A_PIN[formula], HARD_PIN) == message
    assert (
        refusal(OF_A_PIN[formula], WITH_STOP)
        == "stop_stiffness = 11 N/m: it must be 0 here, because only linear supports are covered"
    )


@pytest.mark.parametrize("formula", OF_A_DISC)
def test_formula_of_the_disc_that_takes_a_linear_support_refuses_any_other(formula):
    OF_A_DISC[formula](FIG11)
    message = "hardening = 2 N/m³: it must be 0 here, because only linear supports are covered"
    assert refusal(OF_A_DISC[formula], replace(FIG11, hardening=2.0)) == message
    message = "stop_stiffness = 5 N/m: it must be 0 here, because only linear supports are covered"
    assert refusal(OF_A_DISC[formula], replace(FIG11, stop_stiffness=5.0)) == message


@pytest.mark.parametrize("name", ["hardening", "stop_gap", "stop_stiffness"])
def test_boundaries_are_not_traced_over_what_makes_the_support_nonlinear(name):
    message = refusal(boundaries.ParameterPlane, FIG11, ("damping", name), (0.1, 0.0), (0.2, 1.0))
    assert "they must be two of" in message


GENERAL = {
    # Motions, balances and eigenvalues of any support; the tests of each module and test_nonlinear_* check them.
    "simulate", "simulate_with", "whirl_orbit", "modulated_cycle", "last_whirl",
    "self_centred_equilibria", "whirls", "why_no_equilibrium", "why_no_whirl", "onset_load",
    "resting_places", "circles", "sliding_jacobian", "jacobian_without_angle", "equilibrium_eigenvalues",
    "turning_frame_jacobian", "whirl_eigenvalues", "polar_rates", "held_pin", "whirl_by_harmonic_balance",
    "equilibrium_radius", "equilibrium_angle", "equilibrium_position", "largest_load_with_equilibrium",
    "largest_load_in_words", "whirl_radius", "whirl_frequency", "circling_speed", "driven_radius", "require_drive",
    "require_whirl", "rates", "stiffness",
    # Of geometry, contact or shaft alone.
    "semicircle_residual", "place_of", "polar_angle", "pin_of", "shaft_torque", "contact_of", "isotropic_contact_of",
    "turning_direction", "size_of",
    # Checks of input.
    "require_system", "checked_state", "require_linear_support", "require_positive", "require_start",
}  # fmt: skip
REFUSING = {
    "squared_holding_force", "turn_until_release", "release_time", "sticking_margin", "sticking_radius",
    "resonant_disc_speed", "variational_matrix", "characteristic_coefficients",
    "characteristic_coefficients_as_printed", "coefficient_margins", "lower_branch_margin", "upper_branch_margin",
    "whirl_shift", "first_order_whirl_response", "first_order_whirl_shift", "whirl_shift_error_limit",
    "third_order_of_whirl_shift", "speed_ratio",
    "simulate_polar_form", "reduced_parameters", "speed_difference_at", "squared_distance",
    "squared_distance_as_printed", "places_by_26", "whirl_at", "smallest_load_with_whirl", "growth_by_amplitude",
    "whirl_arm", "least_load_with_whirl", "stick_slip_orbits",
}  # fmt: skip
CHECKED_ELSEWHERE = {"simulate_ensemble", "smallest_shock"}  # see ensemble/test_door, orbits/test_shock


def test_every_function_of_a_system_is_known_to_take_any_support_or_to_refuse_it():
    found = set()
    for module in pkgutil.walk_packages(reference_model.__path__, "reference_model."):
        if module.name.startswith("reference_model.ensemble."):
            continue  # behind its door, simulate_ensemble()
        content = vars(importlib.import_module(module.name))
        for name, function in content.items():
            own = inspect.isfunction(function) and function.__name__ == name
            if own and not name.startswith("_"):
                kinds = {
                    parameter.annotation for parameter in inspect.signature(function).parameters.values()
                }
                if kinds & {"System", "PinOnDisc", "DiscOnDisc"}:
                    found.add(name)
    assert found == GENERAL | REFUSING | CHECKED_ELSEWHERE
    # Both modules have characteristic_coefficients, and a plane of boundaries is a class.
    assert len(OF_A_PIN) + len(OF_A_DISC) == len(REFUSING) + 2
