"""Formulas of section 4 of the paper, against the equations of motion and other independent results."""

import math
from dataclasses import replace

import numpy as np
import pytest
from disc_equations import LARGE, eq_23, mirrored
from plain_engines import in_units
from scipy.optimize import minimize_scalar

from compare.claims.parameters import FIG8, FIG11
from reference_model.contact.contact_law import Ring, ThreeTermRing
from reference_model.formulas import disc as formulas
from reference_model.formulas import pin as pin_formulas
from reference_model.steady.stability import onset_load
from reference_model.steady.steady_states import self_centred_equilibria, whirls

ROUNDING = 1e-13


@pytest.mark.parametrize(("slip", "rim_speed"), [(0.3 - 0.7j, -2.0), (2j, 0.1), (1e-6 + 0j, 1.0), (0j, -1.0)])
def test_23_is_the_average_of_three_terms_of_22(slip, rim_speed):
    """The errata show that it is not that of the two printed terms."""
    unit = replace(FIG8, friction_force=1.0, contact_radius=1.0)
    place = 2.0 * np.pi * np.arange(16) / 16  # averages are exact: cubic at most in sine and cosine
    velocity = slip - 1j * rim_speed * np.exp(1j * place)  # (21)
    along_rim = velocity.real * np.sin(place) - velocity.imag * np.cos(place)
    expansion = np.array([formulas.inverse_slip_speed(slip, rim_speed, at) for at in place.tolist()])
    inverse = expansion / math.hypot(abs(slip), rim_speed)
    found = np.mean([-velocity.real * inverse, -velocity.imag * inverse, along_rim * inverse], axis=1)
    assert found == pytest.approx(eq_23(unit)(slip.real, slip.imag, rim_speed, 0.0), abs=1e-14)


@pytest.mark.parametrize("share", [1e-3, 0.7, 0.98])
@pytest.mark.parametrize(
    "disc", [replace(FIG8, offset=-0.1), replace(FIG8, shaft_speed=3.0), mirrored(LARGE)]
)
def test_positions_by_the_corrected_26_are_the_equilibria_of_23_to_rounding(disc, share):
    disc = replace(disc, friction_force=share * disc.stiffness * abs(disc.offset))
    found = formulas.positions_by_26(disc)
    expected = self_centred_equilibria(disc, ThreeTermRing(disc.contact_radius))
    assert len(found) == len(expected) == 1
    assert found[0] == pytest.approx((expected[0].x, expected[0].y, expected[0].spin), abs=1e-12)
    residual = pin_formulas.semicircle_residual(formulas.pin_of(disc), found[0].x, found[0].y)
    assert residual == pytest.approx(0.0, abs=1e-14)


def test_parameters_25_are_two_lengths_and_a_number():
    load, shaft_damping, difference = formulas.reduced_parameters(FIG8)
    assert load == pytest.approx(0.05, rel=1e-15)
    assert shaft_damping == pytest.approx(0.01 * 0.8 / 0.12, rel=1e-15)
    assert difference == pytest.approx(0.375, rel=1e-15)
    scaled = formulas.reduced_parameters(in_units(FIG8, mass=3.0, length=0.2, time=7.0))
    assert scaled == pytest.approx((0.2 * load, 0.2 * shaft_damping, difference), rel=1e-14)


def test_26_gives_the_equilibrium_of_a_pin_if_shaft_and_master_disc_turn_alike():
    disc = replace(FIG8, shaft_speed=0.8)
    (place,) = formulas.positions_by_26(disc)
    x, y = pin_formulas.equilibrium_position(formulas.pin_of(disc))
    assert place == pytest.approx((x, y, 0.8), rel=1e-14)
    assert formulas.positions_by_26(replace(disc, friction_force=0.1001)) == ()


@pytest.mark.parametrize("law", [Ring, ThreeTermRing])
@pytest.mark.parametrize("alpha", [0.05, 0.7, 0.9, 1.5])
@pytest.mark.parametrize("disc", [mirrored(FIG11), replace(FIG11, shaft_speed=1.75, damping=0.03)])
def test_whirl_at_a_ratio_is_one_of_the_whirls_at_its_load(disc, alpha, law):
    contact = law(disc.contact_radius)
    load, radius, spin = formulas.whirl_at(disc, alpha, contact)
    found = whirls(replace(disc, friction_force=load), contact)
    nearest = min(found, key=lambda whirl: abs(whirl.radius - radius))
    assert (nearest.radius, nearest.spin) == pytest.approx((radius, spin), rel=1e-12)


def test_load_of_a_very_small_whirl_is_the_onset_load():
    for law in (Ring, ThreeTermRing):
        load = formulas.whirl_at(FIG11, math.pi / 2.0 - 1e-7, law(0.12)).load
        assert load == pytest.approx(onset_load(FIG11, law(0.12)), rel=1e-13)
        arm = formulas.whirl_arm(FIG11, law(0.12))
        assert arm(0.0, 1.0) == pytest.approx(arm(1e-8, 1.0), rel=ROUNDING)
        assert arm(3.0, 2.0) == pytest.approx(arm(0.3, 0.2), rel=ROUNDING)


def mean_slip_speed(slip, rim):
    """Return P by the trapezoidal rule, with an error of order 1/n² at a kink."""
    places = 2.0 * np.pi * (np.arange(4096) + 0.5) / 4096
    return float(np.mean(np.abs(slip - rim * np.exp(1j * places))))


@pytest.mark.parametrize("torque_share", [-0.9, 0.0, 0.05, 0.5, 0.97])
def test_held_force_lies_on_the_limit_surface(torque_share):
    """P is the support function of the forces and moments that friction can hold: F·U + M·S <= μN·P(U, S)."""
    disc = replace(LARGE, shaft_speed=2.2 - torque_share * 0.4 * 0.5 / 0.3)
    held = formulas.held_pin(disc)
    moment = abs(torque_share) * 0.4 * 0.5
    bound = minimize_scalar(
        lambda spin: 0.4 * mean_slip_speed(1.0, 0.5 * spin) - moment * spin,
        bounds=(0.0, 40.0),
        method="bounded",
    )
    assert held.friction_force == pytest.approx(bound.fun, rel=1e-6)
    assert replace(held, friction_force=0.4) == formulas.pin_of(disc)


def at_distance(distance):
    return lambda disc: formulas.polar_angle(disc, distance, 0.0)


def at_ratio(alpha):
    return lambda disc: formulas.whirl_at(disc, alpha)


@pytest.mark.parametrize(
    ("formula", "disc", "changes", "message"),
    [
        *((formulas.positions_by_26, FIG8, {name: 0.0}, f"{name} = 0") for name in (
            "stiffness", "disc_speed", "shaft_damping", "offset",
        )),
        (at_distance(0.2), FIG8, {}, r"A·cos\(alpha\) = 0\.2 m.*\|offset\| = 0\.1 m"),
        (formulas.held_pin, FIG8, {"friction_force": 0.02}, r"holds only 0\.0024 N m of the shaft's 0\.003 N m"),
        (formulas.held_pin, FIG8, {"contact_points": 6}, "contact_points = 6"),
        (at_ratio(0.0), FIG11, {}, "alpha = 0 rad"),
        (at_ratio(1.6), FIG11, {}, r"alpha = 1\.6 rad"),
        (at_ratio(1.0), FIG11, {"shaft_speed": 1.5}, "disc_speed - shaft_speed = 0 rad/s"),
        (at_ratio(1.0), FIG11, {"shaft_damping": 0.0}, "shaft_damping = 0"),
        (at_ratio(1.0), FIG11, {"disc_speed": 0.7}, r"disc_speed = 0\.7 rad/s"),
        (at_ratio(1.0), FIG11, {"damping": 0.0}, "damping = 0"),
        (at_ratio(1.0), FIG11, {"contact_points": 6}, "contact_points = 6"),
    ],
)  # fmt: skip
def test_disc_outside_the_domain_of_a_formula_is_refused(formula, disc, changes, message):
    with pytest.raises(ValueError, match=message):
        formula(replace(disc, **changes))
