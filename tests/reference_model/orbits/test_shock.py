"""The smallest shock from the equilibrium that leads to the whirl."""

from dataclasses import replace

import numpy as np
import pytest

from compare.claims.parameters import FIG5
from reference_model import (
    basin_boundary,
    onset_load,
    self_centred_equilibria,
    smallest_load_with_whirl,
    smallest_shock,
    stick_slip_orbits,
    sticking_radius,
    whirl_branch,
)
from reference_model.orbits.shock import by_bisection


@pytest.fixture(scope="module")
def shock():
    return smallest_shock(FIG5)


def test_smallest_shock_agrees_with_bisection_by_end_states(shock):
    assert by_bisection(shock) == pytest.approx(shock.speed, rel=1e-6)


def test_smallest_shock_is_the_nearest_point_of_the_boundary(shock):
    (rest,) = self_centred_equilibria(FIG5)
    (saddle,) = stick_slip_orbits(FIG5, tolerance=1e-6)
    around = [(v - 0.3 * shock.speed, v + 0.3 * shock.speed) for v in (shock.vx, shock.vy)]
    curves = basin_boundary(
        saddle, components=("vx", "vy"), ranges=around, others=(rest.x, rest.y, 0.0, 0.0), cells=2
    )
    nearest = min(np.min(np.hypot(*curve.points.T)) for curve in curves)
    assert shock.speed * (1.0 - 1e-6) <= nearest < 1.05 * shock.speed


def test_pin_without_a_smallest_shock_is_refused(monkeypatch):
    for call in (smallest_shock, stick_slip_orbits, sticking_radius):
        with pytest.raises(ValueError, match="pin = 1: it must be a PinOnDisc"):
            call(1)
    for call in (onset_load, smallest_load_with_whirl):
        with pytest.raises(ValueError, match="disc = 1: it must be a DiscOnDisc"):
            call(1)
    with pytest.raises(ValueError, match="orbit = 1: it must be an Orbit"):
        next(whirl_branch(1, 0.5))
    with pytest.raises(ValueError, match="the self-centred equilibrium exists only"):
        smallest_shock(replace(FIG5, offset=0.0))
    with pytest.raises(ValueError, match="only linear supports are covered"):
        smallest_shock(replace(FIG5, hardening=3.0))
    monkeypatch.setattr("reference_model.orbits.shock.stick_slip_orbits", lambda pin, tolerance: ())
    with pytest.raises(ValueError, match="no saddle-type stick-slip orbit"):
        smallest_shock(FIG5)


def test_a_boundary_below_the_smallest_tried_shock_is_found(shock, monkeypatch):
    """In most directions the smallest of these two shocks already leads to the whirl."""
    monkeypatch.setattr("reference_model.orbits.shock.SIZES", np.array([0.5, 1.0]))
    assert smallest_shock(FIG5).speed == pytest.approx(shock.speed, rel=1e-6)
