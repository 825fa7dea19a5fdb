"""The force of a support that hardens and has a stop, its derivatives and inverse, and formulas that refuse it."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from plain_engines import support_force
from test_systems import refusal

from compare.claims.parameters import FIG11
from reference_model import PinOnDisc, stick_slip_orbits, whirls
from reference_model import smallest_load_with_whirl as smallest_load
from reference_model.contact.contact_law import Ring
from reference_model.formulas import disc as disc_formulas
from reference_model.formulas import pin as pin_formulas
from reference_model.formulas import torque_balance as disc_balance
from reference_model.formulas.characteristic_polynomial import characteristic_coefficients
from reference_model.formulas.pin.whirl import speed_ratio
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
def test_force_is_the_sum_of_spring_hardening_and_stop(pin, x, y):
    force = Support.of(pin).force(complex(x, y))
    assert [force.real, force.imag] == pytest.approx(
        support_force(pin, [x, y, 0.0, 0.0]), rel=1e-13, abs=1e-14
    )


@given(supports, coordinates, coordinates)
def test_force_is_the_gradient_of_the_energy_and_stiffness_its_derivative(pin, x, y):
    support, z, h = Support.of(pin), complex(x, y), 1e-5
    if abs(abs(z - pin.offset) - pin.stop_gap) < 2.0 * h:  # no derivative at the edge of the stop
        return
    force, steps = support.force(z), (h, 1j * h)
    slopes = [
        (support.energy(abs(z + s - pin.offset)) - support.energy(abs(z - s - pin.offset))) / (2.0 * h)
        for s in steps
    ]
    # Third derivatives are up to 6·7 N/m³ and C_s/gap²; energies of 5 J have rounding errors of 1e-15.
    assert [-force.real, -force.imag] == pytest.approx(slopes, abs=h**2 * 500.0 + 1e-9)
    columns = [(support.force(z + s) - support.force(z - s)) / (2.0 * h) for s in steps]
    expected = -np.array([[column.real, column.imag] for column in columns]).T
    assert support.stiffness_matrix(z) == pytest.approx(expected, abs=h**2 * 2500.0 + 1e-9)


def test_stiffness_at_the_edge_of_the_stop_is_refused():
    support = replace(Support.of(PIN), offset=0.0)
    assert refusal(support.stiffness_matrix, 0.2 + 0j).startswith("deflection = stop_gap = 0.2 m")
    assert replace(support, stop_stiffness=0.0).stiffness_matrix(0.2 + 0j)[0, 0] == pytest.approx(
        1.5 + 3 * 7 * 0.04
    )


@given(supports, st.floats(1e-6, 10.0))
def test_deflection_is_the_inverse_of_the_pull(pin, pull):
    support = Support.of(pin)
    assert support.pull(support.deflection(pull)) == pytest.approx(pull, rel=1e-13)


@given(supports, st.floats(1e-6, 10.0))
def test_pull_on_the_circle_is_centripetal(pin, twice_kinetic_energy):
    support = Support.of(pin)
    radius = support.circle(twice_kinetic_energy)
    assert support.pull(radius) * radius == pytest.approx(twice_kinetic_energy, rel=1e-13)


def test_stop_alone_has_no_force_within_its_gap():
    support = Support.of(replace(PIN, stiffness=0.0, hardening=0.0))
    assert support.force(0.25 + 0.1j) == 0.0
    assert not support.centring
    assert support.deflection(1.1) == pytest.approx(0.3, rel=1e-14)  # 11 N/m · 0.1 m
    assert Support(stiffness=0.0, offset=0.1).deflection(1.0) == math.inf


@given(supports, coordinates, coordinates, st.floats(0.01, 100.0), st.floats(0.01, 100.0))
def test_scaled_support_has_the_scaled_force_at_the_scaled_position(pin, x, y, factor, length):
    support, z = Support.of(pin), complex(x, y)
    if abs(abs(z - pin.offset) - pin.stop_gap) < 1e-12:
        return
    expected = factor / length * support.force(z)
    assert support.scaled(factor, length).force(z / length) == pytest.approx(
        expected, rel=1e-12, abs=1e-13 * factor
    )


OF_A_PIN = {
    "stick-slip orbits": lambda pin: stick_slip_orbits(replace(pin, offset=0.0)),
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
    "places by 26": lambda disc: disc_formulas.positions_by_26(replace(disc, offset=0.1)),
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


LINEAR_PIN = replace(PIN, friction_force=0.1, hardening=0.0, stop_stiffness=0.0)
FORMULAS = [
    *(pytest.param(formula, LINEAR_PIN, id=name) for name, formula in OF_A_PIN.items()),
    *(pytest.param(formula, FIG11, id=name) for name, formula in OF_A_DISC.items()),
]


@pytest.mark.parametrize(("formula", "linear"), FORMULAS)
def test_formula_for_linear_supports_refuses_other_supports(formula, linear):
    formula(linear)
    message = "{}: it must be 0 here, because only linear supports are covered".format
    assert refusal(formula, replace(linear, hardening=7.0)) == message("hardening = 7 N/m³")
    assert refusal(formula, replace(linear, stop_stiffness=11.0)) == message("stop_stiffness = 11 N/m")


@pytest.mark.parametrize("name", ["hardening", "stop_gap", "stop_stiffness"])
def test_parameters_of_a_nonlinear_support_cannot_span_a_plane_of_boundaries(name):
    message = refusal(boundaries.ParameterPlane, FIG11, ("damping", name), (0.1, 0.0), (0.2, 1.0))
    assert "they must be two of" in message
