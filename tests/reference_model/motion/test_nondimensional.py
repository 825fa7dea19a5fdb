"""Units in which a motion is of size one: what is fastest makes the unit of time."""

from dataclasses import replace

import numpy as np
import pytest

from reference_model import DiscOnDisc
from reference_model.motion.nondimensional import Units

FREE = DiscOnDisc(
    mass=2.0, polar_inertia=0.5, stiffness=0.0, damping=0.0, friction_force=0.6, disc_speed=0.0, offset=0.0,
    contact_radius=0.1, shaft_damping=0.0, shaft_speed=0.0,
)  # fmt: skip
MOVING = np.array([0.1, 0.2, 0.0, 3.0, 4.0, 24.0])
"""Slips at 5 m/s and, on the radius of gyration of 0.5 m, at 12 m/s: together at 13 m/s."""


@pytest.mark.parametrize(
    ("changes", "time"),
    [
        ({}, 13.0 / (0.6 / 2.0)),  # until friction has taken the slip away
        ({"damping": 5.0}, 2.0 / 5.0),
        ({"shaft_damping": 5.0}, 0.5 / 5.0),  # without it the spin would decay in a small part of the unit
        ({"damping": 5.0, "shaft_damping": 0.5}, 2.0 / 5.0),
        ({"damping": 5.0, "shaft_damping": 5.0, "disc_speed": -4.0}, 1.0 / 4.0),
        ({"stiffness": 72.0, "disc_speed": -4.0}, 1.0 / 6.0),
        ({"friction_force": 0.0}, 1.0),
    ],
)
def test_time_goes_by_springs_and_master_disc_else_by_dampers_else_by_friction(changes, time):
    assert Units.of(replace(FREE, **changes), MOVING).time == pytest.approx(time)
