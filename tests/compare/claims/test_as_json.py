"""Conversion to JSON and back is lossless, even for values that JSON cannot represent."""

import json
from dataclasses import dataclass
from enum import Enum

import numpy as np
import pytest

from compare.claims.as_json import as_json, from_json
from compare.claims.parameters import FIG5, FIG11
from reference_model.systems import FloatArray, System


class Colour(Enum):
    RED = "red"


@dataclass(frozen=True)
class Part:
    name: str
    size: float


@dataclass(frozen=True, eq=False)
class Whole:
    system: System
    parts: tuple[Part, ...]
    starts: tuple[tuple[float, ...], ...]
    values: FloatArray
    count: int


def through_json(value):
    return json.loads(json.dumps(as_json(value), allow_nan=False))


@pytest.mark.parametrize("system", [FIG5, FIG11])
def test_a_dataclass_comes_back_to_the_last_bit(system):
    made = Whole(system, (Part("a", 0.1), Part("b", np.inf)), ((1 / 3, 2.0),), np.array([0.1, np.nan]), 3)
    back = from_json(Whole, through_json(made))
    assert (back.system, back.parts, back.starts, back.count) == (system, made.parts, made.starts, 3)
    np.testing.assert_array_equal(back.values, made.values)


@pytest.mark.parametrize(
    ("value", "content"),
    [
        (np.float64(0.1), 0.1),
        (-np.inf, "-inf"),
        (np.array(np.nan), "nan"),
        (np.array([[1, 2]]), [[1.0, 2.0]]),
        (np.int64(3), 3),
        (np.bool_(True), True),
        (Colour.RED, "red"),
        ({"speeds": (1.0, np.inf)}, {"speeds": [1.0, "inf"]}),
        ("a word", "a word"),
        (None, None),
    ],
)
def test_every_value_has_a_representation_in_json(value, content):
    assert through_json(value) == content


@pytest.mark.parametrize(
    "broken",
    [
        {"system": {"type": "Pendulum"}},
        {"system": {}},
        {"parts": [{"name": "a", "weight": 1.0}]},
        {"starts": [["far"]]},
        {"colour": "red"},
        {},
    ],
)
def test_json_of_another_class_is_rejected(broken):
    with pytest.raises((KeyError, TypeError, ValueError)):
        from_json(Whole, broken)
