"""Equilibria and whirls on hardening supports with stops, against eqs. 1 and 19, searches and simulations."""

import math
from dataclasses import replace

import numpy as np
import pytest
from disc_equations import assert_same_eigenvalues
from plain_engines import support_force

from compare.claims.parameters import FIG8, FIG11
from reference_model import (
    PinOnDisc,
    onset_load,
    self_centred_equilibria,
    simulate,
    whirls,
    why_no_equilibrium,
    why_no_whirl,
)
from reference_model.formulas import pin as formulas

FIG_5 = PinOnDisc(mass=1.0, stiffness=1.0, damping=0.1, friction_force=0.09, disc_speed=1.5, offset=0.1)
SUPPORTS = [
    {"stop_gap": 0.5, "stop_stiffness": 2.0},
    {"hardening": 5.0, "stop_gap": 0.04, "stop_stiffness": 20.0},
]


@pytest.mark.parametrize("support", SUPPORTS)
def test_equilibrium_exists_up_to_the_support_force_at_the_offset(support):
    pin = replace(FIG_5, **support)
    most = math.hypot(*support_force(pin, [0.0, 0.0, 0.0, 0.0]))
    assert formulas.largest_load_with_equilibrium(pin) == pytest.approx(most, rel=1e-14)
    assert len(self_centred_equilibria(replace(pin, friction_force=(1.0 - 1e-9) * most))) == 1
    above = replace(pin, friction_force=(1.0 + 1e-9) * most)
    assert self_centred_equilibria(above) == ()
    assert "force of the support at |offset|" in why_no_equilibrium(above)
    exactly = replace(pin, friction_force=formulas.largest_load_with_equilibrium(pin))
    assert self_centred_equilibria(exactly) == ()
    assert why_no_equilibrium(exactly).endswith("the pin sticks on the axis")


def centred(base, **support):
    return replace(base, offset=0.0, **support)


def formulas_turning(pin):
    """Return the angular speed of the circle with the speed μN/β, even if it is not a whirl."""
    radius = formulas.driven_radius(pin, pin.friction_force)
    return formulas.circling_speed(pin, radius)


@pytest.mark.parametrize("support", [{"hardening": 2.0}, {"stop_gap": 0.4, "stop_stiffness": 20.0}])
def test_pin_ends_by_sticking_if_the_support_would_carry_it_faster_than_the_disc(support):
    pin = centred(replace(FIG_5, friction_force=0.3), **support)
    assert whirls(pin) == ()
    reason = why_no_whirl(pin)
    assert f"|disc_speed| > {formulas_turning(pin):g} rad/s" in reason
    assert formulas_turning(pin) > pin.disc_speed
    trajectory = simulate(pin, [0.5, 0.0, 0.0, 0.5], np.linspace(0.0, 200.0, 201))
    assert trajectory.phases[-1].kind == "stick"
    assert trajectory.phases[-1].end - trajectory.phases[-1].start > 50.0


@pytest.mark.parametrize("disc", [FIG8, replace(FIG8, disc_speed=1.5, offset=0.0)])
def test_disc_on_a_stop_without_a_gap_moves_as_on_a_stiffer_spring(disc):
    stop = replace(disc, stiffness=0.4, stop_stiffness=0.6)
    for found, expected in zip(self_centred_equilibria(stop), self_centred_equilibria(disc), strict=True):
        assert found.state == pytest.approx(expected.state, rel=1e-12)
        assert_same_eigenvalues(found.eigenvalues, expected.eigenvalues)
    start, times = [0.3, 0.1, 0.0, 0.0, 0.2, 1.0], [0.0, 2.0, 8.0]
    plain, other = (simulate(d, start, times, tolerance=1e-12).states for d in (disc, stop))
    assert np.abs(plain - other).max() < 1e-10
    if disc.offset == 0.0:
        assert onset_load(stop) == pytest.approx(onset_load(disc), rel=1e-14)
        for found, expected in zip(whirls(stop), whirls(disc), strict=True):
            assert found.state == pytest.approx(expected.state, rel=1e-10)
            assert_same_eigenvalues(found.eigenvalues, expected.eigenvalues, tolerance=1e-10)


def test_hardening_and_a_stop_with_a_gap_do_not_move_the_onset():
    assert onset_load(replace(FIG11, hardening=10.0, stop_gap=0.02, stop_stiffness=1.0)) == onset_load(FIG11)
    # Just above the onset the whirl is small, because its square is proportional to the excess load.
    load = 1.0001 * onset_load(FIG11)
    linear, hard = (
        whirls(replace(disc, friction_force=load)) for disc in (FIG11, replace(FIG11, hardening=40.0))
    )
    assert linear[-1].radius < 0.002
    assert hard[-1].radius == pytest.approx(linear[-1].radius, rel=0.05)
