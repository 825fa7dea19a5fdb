"""Older paths of modules work, and say where what was asked for is now."""

import importlib
import subprocess
import sys

import pytest

from reference_model import simulate
from reference_model.formulas.disc import pin_of
from reference_model.formulas.pin import whirl_radius
from reference_model.orbits import whirl_orbit
from reference_model.steady.stability import onset_load
from reference_model.steady.steady_states import whirls

MOVED = {
    "integrate": ("simulation", simulate),
    "pin_formulas": ("formulas.pin", whirl_radius),
    "disc_formulas": ("formulas.disc", pin_of),
    "steady_states": ("steady.steady_states", whirls),
    "stability": ("steady.stability", onset_load),
}


@pytest.mark.parametrize("old", MOVED)
def test_what_has_moved_is_found_and_its_new_place_named(old):
    new, function = MOVED[old]
    module = importlib.import_module(f"reference_model.{old}")
    with pytest.warns(DeprecationWarning, match=f"reference_model.{old} has moved") as warned:
        assert getattr(module, function.__name__) is function
    assert str(warned[0].message) == (
        f"reference_model.{old} has moved: import {function.__name__} from reference_model.{new}"
    )
    assert warned[0].filename == __file__


def test_an_import_statement_works_and_warns():
    with pytest.warns(DeprecationWarning, match="import onset_load from reference_model.steady.stability"):
        exec(
            "from reference_model.stability import onset_load as moved; assert moved is onset_load", globals()
        )


def test_an_import_of_the_module_by_its_whole_name_works_and_warns():
    with pytest.warns(DeprecationWarning, match="import onset_load from reference_model.steady.stability"):
        exec(
            "import reference_model.stability; assert reference_model.stability.onset_load is onset_load",
            globals(),
        )


def test_the_package_of_orbits_hands_on_what_the_module_had():
    assert importlib.import_module("reference_model.orbits").whirl_orbit is whirl_orbit


def test_what_never_was_there_is_missed_as_usual():
    with pytest.warns(DeprecationWarning, match="has moved"), pytest.raises(AttributeError, match="nonsense"):
        importlib.import_module("reference_model.stability").nonsense  # noqa: B018


def test_importing_the_package_warns_of_nothing():
    everything = "import reference_model; from reference_model import *; import reference_model.stability"
    subprocess.run(
        [sys.executable, "-W", "error::DeprecationWarning:reference_model", "-c", everything], check=True
    )
    subprocess.run([sys.executable, "-W", "error::DeprecationWarning:__main__", "-c", everything], check=True)
