"""Error messages for invalid systems, states, times and tolerances: one line with the parameter and its value."""

import math
from dataclasses import FrozenInstanceError, replace

import numpy as np
import pytest

from compare.claims.parameters import FIG5, FIG11
from reference_model import (
    PinOnDisc,
    onset_load,
    self_centred_equilibria,
    simulate,
    smallest_load_with_whirl,
    whirl_orbit,
    whirls,
)
from reference_model.systems import checked_times

PARAMETERS = (
    "mass", "stiffness", "damping", "friction_force", "disc_speed", "offset", "hardening", "stop_gap",
    "stop_stiffness",
)  # fmt: skip


def refusal(function, *args, **kwargs):
    """Return the message of the ``ValueError`` that ``function`` raises, which is one line."""
    with pytest.raises(ValueError, match=r"\w") as caught:
        function(*args, **kwargs)
    message = str(caught.value)
    assert "\n" not in message
    assert len(message) < 250
    # The traceback shows one error only.
    assert caught.value.__suppress_context__ or caught.value.__context__ is None
    return message


@pytest.mark.parametrize(
    ("parameter", "value", "message"),
    [
        ("mass", 0.0, "mass = 0 kg: it must be > 0"),
        ("mass", -0.0, "mass = -0 kg: it must be > 0"),
        ("mass", -1.5, "mass = -1.5 kg: it must be > 0"),
        ("stiffness", -1.0, "stiffness = -1 N/m: it must be >= 0"),
        ("damping", -0.1, "damping = -0.1 N s/m: it must be >= 0"),
        ("friction_force", -1e-300, "friction_force = -1e-300 N: it must be >= 0"),
        ("hardening", -2.0, "hardening = -2 N/m³: it must be >= 0"),
        ("stop_gap", -1e-3, "stop_gap = -0.001 m: it must be >= 0"),
        ("stop_stiffness", -5.0, "stop_stiffness = -5 N/m: it must be >= 0"),
    ],
)
def test_value_outside_of_its_range_is_refused_with_its_unit_and_range(parameter, value, message):
    assert refusal(replace, FIG5, **{parameter: value}) == message


@pytest.mark.parametrize("parameter", PARAMETERS)
@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf, "nan", np.float64("inf")])
def test_value_that_is_not_finite_is_refused(parameter, value):
    assert refusal(replace, FIG5, **{parameter: value}) == f"{parameter} = {float(value)}: it must be finite"


@pytest.mark.parametrize("parameter", PARAMETERS)
@pytest.mark.parametrize("value", ["heavy", "", None, [1.0, 2.0], 1j, {}])
def test_value_that_is_not_a_number_is_refused(parameter, value):
    assert refusal(replace, FIG5, **{parameter: value}) == f"{parameter} = {value!r}: it must be a number"


def test_integer_beyond_all_floats_is_refused():
    assert refusal(replace, FIG5, mass=10**400) == "mass = inf: it must be finite"
    assert "times holds an integer too large" in refusal(checked_times, [0, 10**400])


@pytest.mark.parametrize("system", [None, "pin", {}, PinOnDisc])
def test_argument_that_is_not_a_system_is_refused(system):
    message = f"system = {system!r}: it must be a PinOnDisc or a DiscOnDisc"
    assert refusal(simulate, system, [0.0] * 4, [0.0, 1.0]) == message
    for function in (self_centred_equilibria, whirls, whirl_orbit):
        assert refusal(function, system) == message


@pytest.mark.parametrize("function", [onset_load, smallest_load_with_whirl])
def test_pin_is_refused_by_functions_of_a_disc(function):
    assert refusal(function, replace(FIG5, offset=0.0)).endswith("it must be a DiscOnDisc")


@pytest.mark.parametrize("points", [1, 2, 2.5, -6, 0, True, 1001, 10**6, 1e6])
def test_contact_of_too_few_or_too_many_points_is_refused(points):
    message = refusal(replace, FIG11, contact_points=points)
    assert message.startswith(
        f"contact_points = {points}: it must be a whole number from 3 to 1000, or None for"
    )


def test_numbers_of_any_kind_become_floats():
    pin = replace(
        FIG5, mass=2, stiffness=np.float32(0.5), damping=np.int64(1), friction_force="0.25", disc_speed=-1
    )
    assert all(type(getattr(pin, parameter)) is float for parameter in PARAMETERS)
    assert (pin.stiffness, pin.friction_force, pin.disc_speed) == (0.5, 0.25, -1.0)


def test_parameters_need_their_names_and_do_not_change():
    with pytest.raises(TypeError):
        PinOnDisc(1.0, 1.0, 0.1, 0.09, 1.5)
    with pytest.raises(TypeError, match="stifness"):
        replace(FIG5, stifness=1.0)
    with pytest.raises(FrozenInstanceError):
        FIG5.mass = 2.0
    assert replace(FIG5) == FIG5
    assert len({FIG5, replace(FIG5), replace(FIG5, mass=2.0)}) == 2


def test_support_is_linear_unless_it_hardens_or_has_a_stop():
    assert FIG5.linear_support
    assert replace(FIG5, stop_gap=0.1).linear_support  # a stop without stiffness
    assert not replace(FIG5, hardening=0.1).linear_support
    assert not replace(FIG5, stop_stiffness=0.1).linear_support


VALID = {"initial_state": [0.1, 0.0, 0.0, 0.0], "times": [0.0, 1.0], "tolerance": 1e-9}
INVALID = {
    "initial_state": [
        ([0.1, 0.0, 0.0], "initial_state has shape (3,): PinOnDisc takes 4 numbers"),
        ([0.1] * 6, "initial_state has shape (6,): PinOnDisc takes 4 numbers"),
        ([], "initial_state has shape (0,): PinOnDisc takes 4 numbers"),
        (0.1, "initial_state has shape (): PinOnDisc takes 4 numbers"),
        ([[0.1, 0.0, 0.0, 0.0]], "initial_state has shape (1, 4): PinOnDisc takes 4 numbers"),
        ([0.1, 0.0, math.nan, 0.0], "initial_state[2] = nan: it must be finite"),
        ([0.1, -math.inf, 0.0, 0.0], "initial_state[1] = -inf: it must be finite"),
        ([0.1, "a", 0.0, 0.0], "initial_state = [0.1, 'a', 0.0, 0.0]: it must be a list of numbers"),
        ([[1.0], [1.0, 2.0]], "initial_state = [[1.0], [1.0, 2.0]]: it must be a list of numbers"),
        (None, "initial_state"),
        ([0.1, 0.0, -1e60, 0.0], "initial_state[2] = -1e+60: it must not be larger than 1e+50"),
    ],
    "times": [
        ([], "times has shape (0,): it must be a list of at least one time"),
        (3.0, "times has shape (): it must be a list of at least one time"),
        ([[0.0, 1.0]], "times has shape (1, 2): it must be a list of at least one time"),
        ([0.0, 2.0, 1.0], "times must increase, but times[2] = 1 follows times[1] = 2"),
        ([0.0, 1.0, 1.0], "times must increase, but times[2] = 1 follows times[1] = 1"),
        ([0.0, math.nan], "times[1] = nan: it must be finite"),
        (["now"], "times = ['now']: it must be a list of numbers"),
    ],
    "tolerance": [
        *(
            (value, f"tolerance = {value:g}: it must lie between 1e-14 and 1e-2")
            for value in (0.0, -1e-9, 1e-15, 0.5)
        ),
        (math.nan, "tolerance = nan: it must be finite"),
        ("tight", "tolerance = 'tight': it must be a number"),
        (None, "tolerance = None: it must be a number"),
    ],
}


@pytest.mark.parametrize(
    ("argument", "value", "message"),
    [(argument, *case) for argument, cases in INVALID.items() for case in cases],
)
def test_invalid_argument_of_a_simulation_is_refused(argument, value, message):
    assert refusal(simulate, FIG5, **VALID | {argument: value}).startswith(message)


def test_arguments_are_not_changed():
    state, times = np.array([0.1, 0.0, 0.03, 0.0]), np.linspace(0.0, 1.0, 5)
    simulate(FIG5, state, times)
    state[0], times[0] = 0.2, -1.0  # still writable and independent of the result
    assert simulate(FIG5, state, times).states[0] == pytest.approx(state, abs=0.0)
