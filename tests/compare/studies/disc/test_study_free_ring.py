"""The study of the free ring: its integrals are those of the motion in time."""

import math
from dataclasses import replace

import numpy as np
import pytest
from faults.reference import simulate
from scipy.integrate import solve_ivp

from compare.engines import EVERY_KIND, Engine
from compare.studies.disc.free_ring.study import other_ratios, powers
from compare.studies.disc.free_ring.theory import LOPSIDED, OTHERS, approach_constant, deviation
from compare.studies.toolkit.free_bodies import Slowing
from reference_model.contact.elliptic import mean_directions


@pytest.mark.parametrize(("claim", "throws"), [(other_ratios, OTHERS[::3]), (powers, LOPSIDED[1:3])])
def test_error_of_the_time_to_rest_is_within_the_estimates_of_claims_that_sample_by_it(claim, throws):
    def simulated(system, state, times, *, tolerance=1e-9):
        later = replace(system, friction_force=(1.0 - 1e5 * tolerance) * system.friction_force)
        return simulate(later, state, times, tolerance=tolerance)

    measured = claim(Engine("late", simulated, EVERY_KIND), throws)
    off = np.abs(np.subtract(measured.value, measured.predicted))
    assert np.all(off <= np.add(measured.error, measured.model))


@pytest.mark.parametrize(("inertia", "sliding", "rim"), [(1.0, 1.0, 0.3), (0.7, 0.2, 1.0), (1.4, 1.0, 0.2)])
def test_the_integrals_are_those_of_the_motion_in_time(inertia, sliding, rim):
    """Also across the ratio 1, where the slopes of friction are infinite."""
    rest = Slowing(inertia).stop(sliding, rim)

    def rates(_, y):
        along_slip, along_rim = mean_directions(y[0], y[1])
        return -along_slip, -along_rim / inertia, y[0], y[1]

    share = 1e-6  # of the time, that is left out
    end = rest.time * (1.0 - share)
    y = solve_ivp(rates, (0.0, end), (sliding, rim, 0.0, 0.0), rtol=1e-11, atol=1e-13, method="DOP853").y[
        :, -1
    ]
    assert y[0] == pytest.approx(math.exp(Slowing(inertia).terminal) * y[1], rel=1e-4)
    assert y[2:] == pytest.approx([rest.slid, rest.turned], abs=1e-9)
    _, along_rim = mean_directions(y[0], y[1])
    assert y[1] * inertia / along_rim == pytest.approx(share * rest.time, rel=1e-3)


def test_the_terminal_ratio_of_a_ring_is_one_and_symmetric_in_both_motions():
    assert Slowing(1.0).terminal == 0.0
    for inertia in (0.55, 0.8, 1.7):
        assert Slowing(inertia).terminal == pytest.approx(-Slowing(1.0 / inertia).terminal, abs=1e-13)


@pytest.mark.parametrize("limit", [0.5, 2.0])
def test_the_terminal_ratio_leaves_all_bounds_at_the_limits(limit):
    inside = [abs(Slowing(limit + (1.0 - limit) * share).terminal) for share in (1e-1, 1e-3, 1e-5)]
    assert inside[0] < inside[1] < inside[2]
    assert inside[2] > 4.0


def test_the_constant_of_the_approach_does_not_depend_on_where_it_is_taken():
    far, near = (approach_constant(1.0, 0.1, near) for near in (1e-4, 1e-7))
    assert far == pytest.approx(near, rel=1e-7)
    assert deviation(near / 0.001) < 1e-9
