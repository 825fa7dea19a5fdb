"""Published reference values, and the same values by another way."""

import math

import numpy as np
import pytest
from scipy.integrate import dblquad
from scipy.optimize import brentq

from compare.studies.disc.free_ring.study import annulus_ratio
from compare.studies.plane.block.study import RELEASED, SWINGING
from reference_model import PinOnDisc, simulate


def test_a_block_on_a_spring_stops_as_in_sdnd100():
    """Code_aster, V5.01.100: k = 10⁴ N/m, m = 1 kg, g = 10 m/s², μ = 0.1, released at 0.85 mm at 45 degrees."""
    published, ends = [-0.65, 0.45, -0.25, 0.05], 0.12566
    assert (SWINGING.stiffness, SWINGING.mass, SWINGING.friction_force) == (1e4, 1.0, 0.1 * 1.0 * 10.0)
    length = SWINGING.friction_force / SWINGING.stiffness
    balance, place = [], RELEASED * length
    while abs(place) > length:  # the spring's energy falls by the friction work: (a² − b²)·C/2 = μN·(a + b)
        place = -math.copysign(abs(place) - 2.0 * length, place)
        balance.append(1e3 * place)
    start = RELEASED * length / math.sqrt(2.0)
    times = math.pi / SWINGING.natural_frequency * np.arange(6.0)
    run = simulate(SWINGING, [start, start, 0.0, 0.0], times)
    along = 1e3 * (run.states[:, 0] + run.states[:, 1]) / math.sqrt(2.0)
    assert balance == pytest.approx(published)
    assert along[1:5] == pytest.approx(published, abs=1e-6)
    assert along[5] == pytest.approx(0.05, abs=1e-6)
    assert run.phases[-1].kind == "stick"
    assert run.phases[-1].start == pytest.approx(ends, abs=5e-6)


@pytest.mark.parametrize(("inner", "published"), [(0.0, 0.653), (0.5, None), (0.9, None)])
def test_the_final_ratio_of_an_annulus_is_that_of_integrals_over_its_face(inner, published):
    """Weidman and Malhotra (2007): from 0.653 for a full disc to 1 for a ring."""

    def balance(ratio):
        def shares(radius, angle):  # for U = ratio and W = 1: friction along the slip and about the centre
            x, y = radius * math.cos(angle), radius * math.sin(angle)
            speed = math.hypot(ratio - y, x)
            return np.array([ratio - y, x * x - y * (ratio - y)]) / speed * radius

        force, moment = (
            dblquad(lambda r, a, i=i: shares(r, a)[i], 0.0, 2.0 * math.pi, inner, 1.0, epsabs=1e-5)[0]
            for i in (0, 1)
        )
        return force / ratio - moment / (0.5 * (1.0 + inner**2))

    found = brentq(balance, 0.5, 1.2, xtol=1e-4)
    assert annulus_ratio(inner) == pytest.approx(found, abs=3e-4)
    if published is not None:
        assert found == pytest.approx(published, abs=7e-4)


TURNTABLE = PinOnDisc(mass=0.01, stiffness=0.0, damping=0.0, friction_force=0.03, disc_speed=5.0)
LIMIT = TURNTABLE.friction_force / TURNTABLE.mass / TURNTABLE.disc_speed**2
"""Largest radius (m) of a coin at rest on the turntable: mω²r = μN."""


def test_a_coin_within_the_limit_rides_on_a_turntable():
    radius = 0.999 * LIMIT
    run = simulate(TURNTABLE, [radius, 0.0, 0.0, radius * TURNTABLE.disc_speed], [0.0, 100.0])
    assert [phase.kind for phase in run.phases] == ["stick"]
    assert run.radius[-1] == pytest.approx(radius)


@pytest.mark.parametrize("times_as_far", [2.0, 10.0, 100.0])
def test_a_coin_beyond_the_limit_leaves_a_turntable_in_the_time_of_a_hyperbolic_cosine(times_as_far):
    """The distance δ from the limit obeys δ̈ = ω²δ until friction turns with the slip, an effect of the order δ/r."""
    beyond = 1e-7 * LIMIT
    start = [LIMIT + beyond, 0.0, 0.0, (LIMIT + beyond) * TURNTABLE.disc_speed]
    run = simulate(TURNTABLE, start, [0.0, math.acosh(times_as_far) / TURNTABLE.disc_speed], tolerance=1e-12)
    assert (run.radius[-1] - LIMIT) / beyond == pytest.approx(times_as_far, rel=1e-4)
