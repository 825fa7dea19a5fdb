"""The equations of motion in the complex plane and in polar form, against eq. 1 in x and y."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from plain_engines import coulomb, rates, slip_velocity
from plain_slip import slide

from reference_model import PinOnDisc
from reference_model.motion.pin_equations import SlipMotion, simulate_polar_form

FIG_5 = PinOnDisc(mass=1.0, stiffness=1.0, damping=0.1, friction_force=0.09, disc_speed=1.5, offset=0.1)
HEAVY = PinOnDisc(mass=2.3, stiffness=5.1, damping=0.7, friction_force=0.4, disc_speed=-2.2, offset=-0.15)

coordinates = st.floats(-2.0, 2.0)


@given(st.lists(coordinates, min_size=4, max_size=4), st.sampled_from([FIG_5, HEAVY]))
def test_slip_acceleration_is_that_of_eq_1_seen_from_the_disc(state, pin):
    motion = SlipMotion.of(pin)
    z, w = complex(*state[:2]), complex(*slip_velocity(pin, state))
    if abs(w) < 1e-3:
        return
    acceleration = complex(*rates(pin, np.array(state), coulomb(pin))[2:])
    seen_from_disc = acceleration - 1j * pin.disc_speed * complex(*state[2:])  # ẇ = z̈ − iωż
    assert motion.pull(z, w) - motion.friction * w / abs(w) == pytest.approx(seen_from_disc, abs=1e-13)


@pytest.mark.parametrize("pin", [FIG_5, HEAVY])
def test_polar_form_is_eq_1(pin):
    turn = math.copysign(1.0, pin.disc_speed)
    start = np.array([0.9, 0.2, -0.1, 0.8 * turn])
    times = np.linspace(2.0, 12.0, 21)
    assert np.abs(simulate_polar_form(pin, start, times) - slide(pin, start, times).y.T).max() < 1e-11
