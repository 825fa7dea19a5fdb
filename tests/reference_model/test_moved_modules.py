"""Older paths of modules work, and say where what was asked for is now."""

import importlib
import subprocess
import sys

import pytest

MOVED = {
    "integrate": ("simulation", "simulate"),
    "pin_formulas": ("formulas.pin", "whirl_radius"),
    "disc_formulas": ("formulas.disc", "pin_of"),
    "steady_states": ("steady.steady_states", "whirls"),
    "stability": ("steady.stability", "onset_load"),
}


@pytest.mark.parametrize("old", MOVED)
def test_what_has_moved_is_found_and_its_new_place_named(old):
    new, name = MOVED[old]
    module = importlib.import_module(f"reference_model.{old}")
    sentence = f"reference_model.{old} has moved: import {name} from reference_model.{new}"
    with pytest.warns(DeprecationWarning, match=sentence) as warned:
        assert getattr(module, name) is getattr(importlib.import_module(f"reference_model.{new}"), name)
    assert warned[0].filename == __file__
    with pytest.warns(DeprecationWarning, match="has moved"), pytest.raises(AttributeError, match="nonsense"):
        module.nonsense  # noqa: B018


def test_importing_the_package_warns_of_nothing():
    everything = "import reference_model; from reference_model import *; import reference_model.stability"
    for module in ("reference_model", "__main__"):
        strict = ["-W", f"error::DeprecationWarning:{module}"]
        subprocess.run([sys.executable, *strict, "-c", everything], check=True)
