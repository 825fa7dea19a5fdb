"""Records: what is declared is what lies in memory, and the numbers of a lane go where they belong."""

from typing import Annotated, NamedTuple

import numba
import numpy as np

from reference_model.ensemble.core.records import LANES, Record, Row, Rows, at, clear, fill, layout, put
from reference_model.systems import FloatArray


class Spring(NamedTuple):
    points: tuple[float, ...]
    stiffness: float
    rest: float


class Side(Record):
    spring: Rows[Spring]
    length: Row


class Pair(Record):
    left: Side
    right: Side


class Extremes(NamedTuple):
    least: float
    largest: float


class Seen(Record):
    number: int
    place: complex
    extremes: Extremes
    values: Annotated[FloatArray, 3]


@numba.njit
def exchange(pair, lane):
    spring = Spring((1.0, 2.0), *at(pair.left.spring, lane))
    put(pair.left.spring, lane, at(pair.right.spring, lane))
    put(pair.right.spring, lane, spring)


@numba.njit
def take_over(pair):
    pair.left = pair.right


@numba.njit
def widen(seen, by):
    extremes = seen.extremes
    fill(seen.extremes, Extremes(extremes.least - by, extremes.largest + by))
    seen.number += 1
    seen.place *= 1j


@numba.njit
def forget(seen):
    clear(seen)


def test_a_record_lies_in_memory_without_gaps_each_number_of_a_tuple_in_a_row_of_all_lanes():
    pair = layout(Pair)
    assert pair.itemsize == 2 * 3 * LANES * 8
    assert pair["left"]["spring"].names == ("stiffness", "rest")
    assert pair["left"]["spring"]["rest"].shape == (LANES,)


def test_numbers_go_to_their_lane_by_name_and_in_order():
    room = np.arange(6.0 * LANES).view(layout(Pair))
    before = room.copy()
    exchange(room[0], 5)
    for name in ("stiffness", "rest"):
        left, right = (room[side]["spring"][name][0] for side in ("left", "right"))
        old_left, old_right = (before[side]["spring"][name][0] for side in ("left", "right"))
        assert (left[5], right[5]) == (old_right[5], old_left[5])
        others = np.arange(LANES) != 5
        np.testing.assert_array_equal(left[others], old_left[others])
        np.testing.assert_array_equal(right[others], old_right[others])
    np.testing.assert_array_equal(room["left"]["length"], before["left"]["length"])


def test_a_record_within_a_record_is_taken_over_whole_and_is_no_alias_of_the_other():
    room = np.arange(6.0 * LANES).view(layout(Pair))
    take_over(room[0])
    assert room["left"].tobytes() == room["right"].tobytes()
    assert room["right"]["length"][0, -1] == 6.0 * LANES - 1.0
    exchange(room[0], 0)
    room["left"]["length"] = 0.0
    assert np.all(room["right"]["length"] > 0.0)


def test_numbers_of_a_record_are_changed_by_name_and_all_of_them_forgotten():
    seen = np.zeros(2, layout(Seen))
    seen["place"], seen["values"] = 2.0, 7.0
    widen(seen[1], 0.5)
    assert seen[1]["extremes"].tolist() == (-0.5, 0.5)
    assert (seen[1]["number"], seen[1]["place"]) == (1, 2j)
    forget(seen[1])
    assert seen[1].tobytes() == np.zeros(1, layout(Seen)).tobytes()
    assert seen[0]["place"] == 2.0
