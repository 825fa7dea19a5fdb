"""Error messages for invalid systems, states, times and tolerances: one line with the parameter and its value."""

import datetime
import importlib
import inspect
import math
from dataclasses import FrozenInstanceError, replace
from decimal import Decimal
from fractions import Fraction

import numpy as np
import pytest

import reference_model
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
from reference_model.ensemble import simulate_ensemble
from reference_model.systems import UNITS, checked_state, number_in_text, shown

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


LEAST = {"mass": "> 0"} | dict.fromkeys(
    ("stiffness", "damping", "friction_force", "hardening", "stop_gap", "stop_stiffness"), ">= 0"
)


class Container:
    """A container of numbers that converts itself to an array, such as a series of pandas."""

    def __init__(self, values):
        self.values = values

    def __array__(self, dtype=None, copy=None):
        return np.array(self.values, dtype)


class InMillimetres(Container):
    """Numbers with a unit."""

    units = "mm"

    def __init__(self):
        super().__init__([1.0, 2.0, 3.0, 4.0])


NOT_NUMBERS = [
    "heavy", "", "0.25", "1_0", "\N{ARABIC-INDIC DIGIT THREE}", b"1", None, True, np.True_, 1j, np.complex64(1),
    10**400, np.timedelta64(5, "ms"), np.datetime64("2026-01-01"), datetime.timedelta(1), Decimal(1), Fraction(1, 2),
    [1.0, 2.0], np.array([1.0]), np.array("2"), np.array(None), np.ma.masked, np.ma.array(1.0, mask=True), {}, {1.0},
    object(), len, InMillimetres(),
]  # fmt: skip

NOT_LISTS = [
    "1 2 3 4", b"1234", None, [True, 0.0, 0.0, 0.0], ["0.1", 0.0, 0.0, 0.0], [0.1, None, 0.0, 0.0],
    [[1.0], [1.0, 2.0]], np.array([1, 2, 3, 4], dtype="m8[ms]"), np.array([1, 2, 3, 4], dtype="M8[ms]"),
    np.array([1j, 2, 3, 4]), np.array(["1", "2", "3", "4"]), np.array([False, True, True, True]),
    np.ma.array([1.0, 2, 3, 4], mask=[0, 0, 1, 0]), np.array([0.1, "a", 0.0, 0.0], dtype=object),
    np.zeros(4, dtype=[("a", float)]), iter([0.0, 1.0]), {0.0, 1.0}, InMillimetres(), [0, 10**400, 10**401, 10**402],
]  # fmt: skip


@pytest.mark.parametrize("name", ["initial_state", "times"])
@pytest.mark.parametrize("value", NOT_LISTS, ids=lambda value: type(value).__name__)
def test_only_real_numbers_without_mask_or_unit_enter_an_array(name, value):
    message = refusal(simulate, FIG5, **VALID | {name: value})
    assert message.startswith(f"{name} = {shown(value)}: it ")


def test_arrays_of_numbers_of_any_container_are_the_same():
    plain = [0.1, 0.0, 0.03, 0.0]
    for values in (
        tuple(plain),
        np.array(plain)[::-1][::-1],
        np.array(plain, dtype=object),
        Container(plain),
    ):
        np.testing.assert_array_equal(checked_state(FIG5, values), plain)


@pytest.mark.parametrize("value", ["no", None, 1, 0.0, []])
def test_a_flag_is_true_or_false(value):
    message = f"early_end = {value!r}: it must be True or False"
    assert refusal(simulate_ensemble, FIG5, [[0.1, 0.0, 0.0, 0.0]], duration=1.0, early_end=value) == message
    if value is not None:  # the faster of both
        assert refusal(simulate, FIG5, **VALID, compiled=value) == message.replace("early_end", "compiled")


@pytest.mark.parametrize(
    ("text", "number"),
    [
        ("1", 1.0),
        (" -1.5E-3 ", -1.5e-3),
        (".5", 0.5),
        ("1_0", None),
        ("٣", None),
        ("0x1", None),
        ("1,5", None),
    ],
)
def test_numbers_in_text_are_ascii_numerals(text, number):
    if number is None:
        assert refusal(number_in_text, "mass", text).startswith(f"mass = {text!r}: it must be a number")
    else:
        assert number_in_text("mass", text) == number


@pytest.mark.parametrize("parameter", PARAMETERS)
def test_invalid_parameter_is_refused_with_its_unit_and_range(parameter):
    if parameter in LEAST:
        for value in (-1.5, -1e-300, *([0.0, -0.0] if parameter == "mass" else [])):
            expected = f"{parameter} = {value:g} {UNITS[parameter]}: it must be {LEAST[parameter]}"
            assert refusal(replace, FIG5, **{parameter: value}) == expected
    for value, name in ((math.nan, "nan"), (-math.inf, "-inf"), (np.float64("inf"), "inf")):
        assert refusal(replace, FIG5, **{parameter: value}) == f"{parameter} = {name}: it must be finite"
    for value in NOT_NUMBERS:
        message = refusal(replace, FIG5, **{parameter: value})
        assert message.startswith(f"{parameter} = {shown(value)}: it ")


@pytest.mark.parametrize("system", [None, "pin", PinOnDisc])
def test_argument_that_is_not_a_system_is_refused(system):
    message = f"system = {shown(system)}: it must be a PinOnDisc or a DiscOnDisc"
    assert refusal(simulate, system, [0.0] * 4, [0.0, 1.0]) == message
    for function in (self_centred_equilibria, whirls, whirl_orbit):
        assert refusal(function, system) == message


@pytest.mark.parametrize("function", [onset_load, smallest_load_with_whirl])
def test_pin_is_refused_by_functions_of_a_disc(function):
    assert refusal(function, replace(FIG5, offset=0.0)).endswith("it must be a DiscOnDisc")


@pytest.mark.parametrize("points", [2, 2.5, 1001])
def test_contact_of_too_few_or_too_many_points_is_refused(points):
    message = f"contact_points = {points}: it must be a whole number from 3 to 1000, or None for"
    assert refusal(replace, FIG11, contact_points=points).startswith(message)


def test_numbers_of_any_kind_become_floats():
    pin = replace(
        FIG5,
        mass=2,
        stiffness=np.float32(0.5),
        damping=np.int64(1),
        friction_force=np.array(0.25),
        disc_speed=-1,
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


VALID = {"initial_state": [0.1, 0.0, 0.0, 0.0], "times": [0.0, 1.0], "tolerance": 1e-9}
INVALID = [
    *(("initial_state", value, f"initial_state = {value}: PinOnDisc takes 4 numbers, not shape {shape}")
      for value, shape in (
        ([0.1] * 6, "(6,)"), (0.1, "()"), ([[0.1, 0.0, 0.0, 0.0]], "(1, 4)"),
    )),
    ("initial_state", bytearray(4), "initial_state = b'\\x00\\x00\\x00\\x00': it must be a number"),
    ("initial_state", [0.1, 0.0, math.nan, 0.0], "initial_state[2] = nan: it must be finite"),
    ("initial_state", [0.1, 0.0, -1e60, 0.0], "initial_state[2] = -1e+60: it must not be larger than 1e+50"),
    *(("times", value, f"times has shape {shape}: it must be a list of at least one time") for value, shape in (
        ([], "(0,)"), (3.0, "()"), ([[0.0, 1.0]], "(1, 2)"),
    )),
    ("times", [0.0, 1.0, 1.0], "times must increase, but times[2] = 1 follows times[1] = 1"),
    ("times", [0.0, math.nan], "times[1] = nan: it must be finite"),
    ("tolerance", 1e-15, "tolerance = 1e-15: it must lie between 1e-14 and 1e-2"),
    ("tolerance", 0.5, "tolerance = 0.5: it must lie between 1e-14 and 1e-2"),
    ("tolerance", math.nan, "tolerance = nan: it must be finite"),
    ("tolerance", None, "tolerance = None: it must be a number"),
]  # fmt: skip


@pytest.mark.parametrize(("argument", "value", "message"), INVALID)
def test_invalid_argument_of_a_simulation_is_refused(argument, value, message):
    assert refusal(simulate, FIG5, **VALID | {argument: value}).startswith(message)


def test_arguments_are_not_changed():
    state, times = np.array([0.1, 0.0, 0.03, 0.0]), np.linspace(0.0, 1.0, 5)
    simulate(FIG5, state, times)
    state[0], times[0] = 0.2, -1.0  # still writable and independent of the result
    assert simulate(FIG5, state, times).states[0] == pytest.approx(state, abs=0.0)


def test_public_names_are_not_modules_even_if_a_module_has_the_same_name():
    importlib.import_module("reference_model.orbits.basin_boundary")
    for name in reference_model.__all__:
        assert not inspect.ismodule(getattr(reference_model, name)), name
    with pytest.raises(AttributeError, match="module 'reference_model' has no attribute 'nothing'"):
        reference_model.nothing  # noqa: B018
