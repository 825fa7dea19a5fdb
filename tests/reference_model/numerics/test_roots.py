"""Zeros and maxima of functions with known ones."""

import math

import numpy as np
import pytest

from reference_model.numerics.roots import largest_between, nodes_between, zero_between, zeros_between


def test_nodes_lie_in_the_interval_and_are_densest_at_its_ends():
    nodes = nodes_between(0.0, 1.0)
    steps = np.diff(nodes)
    assert (nodes[0], nodes[-1]) == (0.0, 1.0)
    assert np.all(steps > 0.0)
    assert steps.max() < 0.05
    assert nodes[1] < 1e-17
    assert 1.0 - nodes[-2] <= np.finfo(float).eps


@pytest.mark.parametrize("roots", [[], [0.3], [0.1, 0.5, 0.9], [0.4, 0.4 + 1e-6], [1e-12, 0.2, 1.0 - 1e-12]])
def test_all_zeros_of_a_polynomial_are_found(roots):
    found = zeros_between(lambda x: math.prod(x - root for root in roots), 0.0, 1.0)
    # Near 1 the rounding error of 1 limits the accuracy of a root.
    assert found == pytest.approx(roots, rel=1e-9, abs=1e-16)


def test_zero_on_a_node_or_at_an_end_is_found_once():
    assert zeros_between(lambda x: x - 0.5, 0.0, 1.0) == [0.5]
    assert zeros_between(lambda x: x * (x - 1.0), 0.0, 1.0) == [0.0, 1.0]
    assert zeros_between(lambda x: x, 0.0, 0.0) == [0.0]


@pytest.mark.parametrize("least", [1e-3, 1e-7, 1e-11])
def test_pair_of_zeros_about_a_logarithmic_dip_next_to_an_end_is_found(least):
    """x·ln(x/a) has its minimum −a/e at a/e, so the shifted function has zeros on both sides of it."""
    scale = least * math.e

    def dip(x):
        return x * math.log(x / scale) + 0.9 * least if x > 0.0 else 0.9 * least

    found = zeros_between(dip, 0.0, 1.0)
    assert len(found) == 2
    assert found[0] < least < found[1] < scale
    assert [abs(dip(x)) for x in found] == pytest.approx([0.0, 0.0], abs=1e-14 * least)


def test_tiny_zero_is_accurate_to_rounding():
    assert zeros_between(lambda x: x - 1e-200, 0.0, 1.0) == pytest.approx([1e-200], rel=1e-14, abs=0.0)
    assert zero_between(lambda x: x - 3e-200, 0.0, 1.0) == pytest.approx(3e-200, rel=1e-14, abs=0.0)


@pytest.mark.parametrize("place", [0.0, 1e-9, 0.37, 1.0])
def test_largest_value_is_found_inside_and_at_the_ends(place):
    assert largest_between(lambda x: 2.0 - (x - place) ** 2, 0.0, 1.0) == pytest.approx(2.0, rel=1e-15)
