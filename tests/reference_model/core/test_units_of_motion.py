"""Units that make a motion of order one; the fastest process defines the unit of time."""

from dataclasses import replace

import numpy as np
import pytest

from reference_model import DiscOnDisc
from reference_model.core.units import Units

FREE = DiscOnDisc(
    mass=2.0, polar_inertia=0.5, stiffness=0.0, damping=0.0, friction_force=0.6, disc_speed=0.0, offset=0.0,
    contact_radius=0.1, shaft_damping=0.0, shaft_speed=0.0,
)  # fmt: skip
MOVING = np.array([0.1, 0.2, 0.0, 3.0, 4.0, 24.0])
"""A disc that slips at 5 m/s and spins at 12 m/s at its radius of gyration of 0.5 m, together 13 m/s."""


@pytest.mark.parametrize(
    ("changes", "time"),
    [
        ({}, 13.0 / (0.6 / 2.0)),  # until friction ends the slip
        ({"damping": 5.0}, 2.0 / 5.0),
        ({"shaft_damping": 5.0}, 0.5 / 5.0),  # otherwise the spin would decay within a small part of the unit
        ({"damping": 5.0, "shaft_damping": 0.5}, 2.0 / 5.0),
        ({"damping": 5.0, "shaft_damping": 5.0, "disc_speed": -4.0}, 1.0 / 4.0),
        ({"stiffness": 72.0, "disc_speed": -4.0}, 1.0 / 6.0),
        ({"friction_force": 0.0}, 1.0),
    ],
)
def test_unit_of_time_follows_springs_and_master_disc_then_dampers_then_friction(changes, time):
    assert Units.of(replace(FREE, **changes), MOVING).time == pytest.approx(time)
