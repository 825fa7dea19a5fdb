"""The force of a support that hardens and has a stop, its derivatives and inverse, and formulas that refuse it."""

import math
from dataclasses import replace
from inspect import signature

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
from reference_model.formulas.characteristic_polynomial import characteristic_coefficients
from reference_model.formulas.pin.polar_form import simulate_polar_form
from reference_model.formulas.pin.whirl import speed_ratio
from reference_model.formulas.torque_balance import least_load_with_whirl
from reference_model.steady.bifurcation_curves import ParameterPlane
from reference_model.steady.lyapunov_coefficient import growth_by_amplitude
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
    expected = support_force(pin, [x, y, 0.0, 0.0])
    assert [force.real, force.imag] == pytest.approx(expected, rel=1e-13, abs=1e-14)


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


@given(supports, st.floats(1e-6, 1e4))
def test_deflection_has_the_pull_and_the_circle_the_centripetal_force(pin, value):
    support = Support.of(pin)
    assert support.pull(support.deflection(value)) == pytest.approx(value, rel=1e-13)
    radius = support.circle(value)
    assert support.pull(radius) * radius == pytest.approx(value, rel=1e-13)


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


ALSO_NONLINEAR = {
    "circling_speed", "driven_radius", "equilibrium_angle", "equilibrium_position", "equilibrium_radius",
    "largest_load_in_words", "largest_load_with_equilibrium", "require_drive", "semicircle_residual",
    "whirl_frequency", "whirl_radius", "WhirlResponse",
}  # fmt: skip
LINEAR_PIN = replace(PIN, hardening=0.0, stop_stiffness=0.0)
LINEAR_DISC = replace(FIG11, offset=0.1)
TIMES = np.linspace(0.0, 0.1, 3)
PLANE = ("damping", "friction_force"), (0.1, 0.1), (0.2, 0.2)
FORMULAS = [
    *((getattr(pin_formulas, name), LINEAR_PIN) for name in set(pin_formulas.__all__) - ALSO_NONLINEAR),
    (speed_ratio, LINEAR_PIN),
    (simulate_polar_form, LINEAR_PIN, np.array([0.3, 0.0, 0.0, 0.3]), TIMES),
    (stick_slip_orbits, replace(LINEAR_PIN, offset=0.0)),
    (disc_formulas.reduced_parameters, FIG11),
    (disc_formulas.speed_difference_at, FIG11),
    (disc_formulas.squared_distance, FIG11),
    (disc_formulas.squared_distance_as_printed, FIG11),
    (disc_formulas.positions_by_26, LINEAR_DISC),
    (disc_formulas.whirl_at, FIG11),
    (smallest_load, FIG11),
    (least_load_with_whirl, FIG11, Ring(0.12)),
    (disc_formulas.whirl_arm, FIG11, Ring(0.12)),
    (characteristic_coefficients, FIG11, 1.0, 0.5),
    (ParameterPlane, FIG11, *PLANE),
    (growth_by_amplitude, FIG11, whirls(FIG11)[0].state),
]


@pytest.mark.parametrize(
    "call", sorted(FORMULAS, key=lambda call: call[0].__name__), ids=lambda call: call[0].__name__
)
def test_formula_for_linear_supports_refuses_other_supports(call):
    formula, linear, *others = call
    required = [p for p in signature(formula).parameters.values() if p.default is p.empty]
    others = others or [0.2] * (len(required) - 1)
    formula(linear, *others)
    message = "{}: it must be 0 here, because only linear supports are covered".format
    assert refusal(formula, replace(linear, hardening=7.0), *others) == message("hardening = 7 N/m³")
    assert refusal(formula, replace(linear, stop_stiffness=11.0), *others) == message(
        "stop_stiffness = 11 N/m"
    )


@pytest.mark.parametrize("name", ["hardening", "stop_gap", "stop_stiffness"])
def test_parameters_of_a_nonlinear_support_cannot_span_a_plane_of_boundaries(name):
    message = refusal(ParameterPlane, FIG11, ("damping", name), (0.1, 0.0), (0.2, 1.0))
    assert "they must be two of" in message
