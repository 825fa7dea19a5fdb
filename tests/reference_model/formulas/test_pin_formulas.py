"""Formulas of sections 2 and 3 of the paper, against the equations of motion and other independent results."""

import math
from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest
from scipy.optimize import root

from reference_model.formulas import pin as formulas
from reference_model.systems import PinOnDisc

ROUNDING = 1e-13  # some hundred operations on numbers of order one

FIG_4 = PinOnDisc(mass=1.0, stiffness=1.0, damping=0.1, friction_force=0.12, disc_speed=1.5, offset=0.1)
FIG_5 = replace(FIG_4, friction_force=0.09)
HEAVY = PinOnDisc(mass=2.3, stiffness=5.1, damping=0.7, friction_force=0.4, disc_speed=2.2, offset=0.15)


SAMPLES, ORDERS = 64, np.arange(-12, 13)
WAVES = np.exp(2j * np.pi / SAMPLES * np.outer(np.arange(SAMPLES), ORDERS))


def residual_of_eq_1(pin, z, v, a):
    """Return the left side minus the right side of (1) in N, as x + iy."""
    slip = v - 1j * pin.disc_speed * z
    friction = pin.friction_force * slip / np.abs(slip)
    return pin.mass * a + pin.damping * v + pin.stiffness * (z - pin.offset) + friction


def residual_of_eq_1_on(pin, amplitudes, frequency):
    """Return the residual of (1) over one period for z = Σ amplitudes[n]·exp(in·frequency·t), n in ``ORDERS``."""
    return residual_of_eq_1(pin, *(WAVES @ (amplitudes * (1j * ORDERS * frequency) ** k) for k in range(3)))


def test_equilibrium_at_the_largest_load_is_on_the_axis():
    limit = formulas.largest_load_with_equilibrium(HEAVY)
    at_limit = replace(HEAVY, friction_force=limit)
    assert formulas.equilibrium_radius(at_limit) == 0.0
    assert formulas.equilibrium_position(at_limit) == (0.0, 0.0)


def test_equilibrium_radius_near_the_largest_load_is_exact_to_rounding():
    offset, load = 0.7, 0.7 * (1.0 - 1e-12)
    pin = replace(FIG_4, offset=offset, friction_force=load)
    exact = float(Fraction(offset) ** 2 - Fraction(load) ** 2)
    assert formulas.equilibrium_radius(pin) ** 2 == pytest.approx(exact, rel=1e-15, abs=0.0)


STUCK = [
    replace(FIG_4, disc_speed=speed, offset=offset, friction_force=0.3)
    for speed in (0.7, 2.0, -0.7, -2.0)
    for offset in (0.1, -0.1)
]


def force_on_a_stuck_pin(pin, radius, disc_angle):
    """Return the left side of (6), as a complex number, for a pin that turns with the disc."""
    z = radius * np.exp(1j * np.asarray(disc_angle))
    v, a = 1j * pin.disc_speed * z, -(pin.disc_speed**2) * z
    return pin.mass * a + pin.damping * v + pin.stiffness * (z - pin.offset)


@pytest.mark.parametrize("pin", [*STUCK, HEAVY])
def test_holding_force_balances_the_equations_of_motion_of_a_stuck_pin(pin):
    angle = np.linspace(-3.0, 7.0, 23)
    expected = np.abs(force_on_a_stuck_pin(pin, 0.4, angle)) ** 2
    assert formulas.squared_holding_force(pin, 0.4, angle) == pytest.approx(expected, rel=ROUNDING)


def test_pin_on_a_disc_at_rest_sticks_permanently_if_friction_exceeds_the_spring_force():
    pin = replace(FIG_4, disc_speed=0.0)  # holds up to 0.12 m from (0.1, 0)
    assert formulas.release_time(pin, 0.2, 0.0) == math.inf
    assert formulas.release_time(pin, 0.2, math.pi) == 0.0


@pytest.mark.parametrize("pin", STUCK)
def test_largest_holding_force_at_the_sticking_radius_is_the_friction_force(pin):
    radius = formulas.sticking_radius(pin)
    angles = np.linspace(0.0, 2.0 * np.pi, 20_001)
    # The grid misses the peak by 1.6e-4 rad at most: by some 1e-8 of the force.
    largest = np.sqrt(formulas.squared_holding_force(pin, radius, angles).max())
    assert largest == pytest.approx(pin.friction_force, rel=3e-8)
    assert formulas.sticking_margin(pin, radius) == pytest.approx(0.0, abs=ROUNDING)
    assert formulas.sticking_margin(pin, 0.9 * radius) > 0.0 > formulas.sticking_margin(pin, 1.1 * radius)


def test_sticking_radius_of_an_undamped_pin_is_infinite_at_its_natural_frequency():
    assert formulas.sticking_radius(replace(FIG_4, damping=0.0, disc_speed=-1.0)) == math.inf
    with pytest.raises(ValueError, match=r"radius = -0\.1 m"):
        formulas.turn_until_release(FIG_5, -0.1, 0.0)


def pins_below_and_above_resonance():
    for damping in (0.01, 0.5, 2.5, 8.0):
        for disc_speed in (0.0, 0.05, 0.15, 0.3, 0.6, 0.8, 0.95, 0.999, 1.001, 1.1, 1.5, 3.0, 20.0):
            yield replace(FIG_4, damping=damping, disc_speed=disc_speed)


def test_13_to_16_are_the_determinant_of_12_and_its_hurwitz_conditions():
    verdicts = []
    for pin in pins_below_and_above_resonance():
        matrix = formulas.variational_matrix(pin)
        determinant, found = np.poly(matrix), formulas.characteristic_coefficients(pin)
        # The smaller coefficients contain the rounding errors of the largest one.
        assert np.abs(np.subtract(found, determinant)).max() < 1e-12 * np.abs(determinant).max()
        printed = formulas.characteristic_coefficients_as_printed(pin)
        assert printed[1] - determinant[1] == pytest.approx(1.0 - pin.damping / pin.mass, abs=1e-9)
        _, quadratic, linear, constant = found
        positive = [margin > 0.0 for margin in formulas.coefficient_margins(pin)]
        assert positive == [quadratic > 0.0, linear > 0.0], pin
        lower, upper = formulas.lower_branch_margin(pin) > 0.0, formulas.upper_branch_margin(pin) > 0.0
        assert (lower or upper) == (quadratic * linear > constant), pin
        verdicts.append(np.linalg.eigvals(matrix).real.max() < 0.0)
        assert upper == verdicts[-1], pin
    assert 0.2 < np.mean(verdicts) < 0.9  # the pins are both stable and unstable


def test_threshold_of_16_tends_to_minus_a_half_for_weak_damping():
    at_rest = replace(FIG_4, disc_speed=0.0)  # ω/(ω − k) = 0
    for damping in (1e-3, 1e-9, 1e-200):
        margin = formulas.upper_branch_margin(replace(at_rest, damping=damping))
        assert margin == pytest.approx(0.5, abs=damping**2)


whirling = pytest.mark.parametrize(
    "pin", [replace(FIG_4, disc_speed=1.1), replace(FIG_4, disc_speed=-1.3), replace(HEAVY, disc_speed=1.9)]
)

MEAN, FIRST, SECOND = (int(np.argmax(n == ORDERS)) for n in range(3))


def whirl_with_offset(pin):
    """Return the amplitudes of the periodic orbit of (1), by Newton's method on its harmonics."""

    def defect(unknowns):
        amplitudes = unknowns[: ORDERS.size] + 1j * unknowns[ORDERS.size : -1]
        balance = WAVES.conj().T @ residual_of_eq_1_on(pin, amplitudes, unknowns[-1]) / SAMPLES
        return np.concatenate((balance.real, balance.imag, [amplitudes[FIRST].imag]))

    guess = np.zeros(2 * ORDERS.size + 1)
    guess[FIRST], guess[-1] = formulas.whirl_radius(pin), formulas.whirl_frequency(pin)
    found = root(defect, guess, tol=1e-14)
    assert np.abs(found.fun).max() < 1e-13, found.message
    return found.x[: ORDERS.size] + 1j * found.x[ORDERS.size : -1]


@whirling
def test_first_order_response_is_exact_up_to_the_third_power_of_the_offset(pin):
    offsets = np.array([0.02, 0.01]) * formulas.whirl_radius(pin)
    errors = []
    for offset in offsets:
        small = replace(pin, offset=offset)
        response = formulas.first_order_whirl_response(small)
        amplitudes = whirl_with_offset(small)
        errors.append([response.mean - amplitudes[MEAN], response.second_harmonic - amplitudes[SECOND]])
        assert formulas.first_order_whirl_shift(small) == (response.mean.real, response.mean.imag)
    orders = np.log2(np.abs(errors[0]) / np.abs(errors[1]))
    assert orders == pytest.approx([3.0, 3.0], abs=0.05)


@whirling
def test_relative_error_of_18_tends_to_the_limit_formula(pin):
    small = replace(pin, offset=1e-4 * formulas.whirl_radius(pin))
    found = complex(*formulas.whirl_shift(small)) / whirl_with_offset(small)[MEAN] - 1.0
    limit = formulas.whirl_shift_error_limit(pin)
    assert limit == pytest.approx(formulas.whirl_shift_error_limit(replace(pin, offset=0.0)), rel=1e-15)
    assert found == pytest.approx(limit, abs=1e-6)  # of order (wX0/ρ_c)² with w = ω/(ω − k) <= 11


@whirling
def test_third_order_of_the_shift_is_exact_in_first_order_of_the_damping(pin):
    """The neglected terms are of relative order d, so they halve with the damping."""
    offset, errors = 2e-3, []
    for damping in (0.02, 0.01):
        # Damping and load fall together, so the radius of the whirl stays the same.
        weak = replace(
            pin, damping=damping * pin.mass * pin.natural_frequency, friction_force=1.0, offset=0.0
        )
        load = pin.stiffness * weak.damping / (pin.mass * pin.natural_frequency)  # ρ_c = 1 m
        small = replace(weak, friction_force=load, offset=offset)
        first = complex(*formulas.first_order_whirl_shift(small))
        relative = whirl_with_offset(small)[MEAN] / first - 1.0
        errors.append(abs(relative / (1j * formulas.third_order_of_whirl_shift(small)) - 1.0))
    assert errors[1] < 0.1
    assert errors[0] / errors[1] == pytest.approx(2.0, abs=0.1)


NEED_A_WHIRL = (
    "whirl_frequency", "whirl_shift", "first_order_whirl_shift", "whirl_shift_error_limit",
    "third_order_of_whirl_shift",
)  # fmt: skip
NEED_A_RATIO = (
    "variational_matrix", "characteristic_coefficients", "coefficient_margins", "lower_branch_margin",
    "upper_branch_margin",
)  # fmt: skip
REFUSED = [
    ("equilibrium_radius", {"friction_force": 0.102}, r"friction_force = 0\.102 N.* = 0\.1 N \(eq\. 5\)"),
    ("equilibrium_angle", {"disc_speed": 0.0}, "disc_speed = 0 rad/s"),
    ("equilibrium_angle", {"stiffness": 0.0}, "stiffness = 0 N/m"),
    ("equilibrium_angle", {"offset": 0.0, "friction_force": 0.0}, "offset = 0 m"),
    ("sticking_radius", {"friction_force": 0.05, "offset": -0.1}, r"force = 0\.05 N.* = 0\.1 N \(eq\. 9\)"),
    ("sticking_radius", {"friction_force": 0.1}, r"friction_force = 0\.1 N.* = 0\.1 N \(eq\. 9\)"),
    ("resonant_disc_speed", {"damping": 2.0, "stiffness": 2.0}, r"damping = 2 N s/m.* = 2 N s/m"),
    ("whirl_radius", {"disc_speed": 1.0}, "disc_speed = 1 rad/s.*natural frequency 1 rad/s"),
    *(("whirl_radius", {name: 0.0}, f"{name} = 0") for name in ("damping", "friction_force", "stiffness")),
    *((formula, {"disc_speed": -0.5}, r"disc_speed = -0\.5 rad/s") for formula in NEED_A_WHIRL),
    *((formula, {"disc_speed": -1.0}, "disc_speed = -1 rad/s: ω/") for formula in NEED_A_RATIO),
]


@pytest.mark.parametrize(("formula", "changes", "message"), REFUSED)
def test_pin_outside_the_domain_of_a_formula_is_refused(formula, changes, message):
    with pytest.raises(ValueError, match=message):
        getattr(formulas, formula)(replace(FIG_5, **changes))
