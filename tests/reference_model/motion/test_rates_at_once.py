"""Vectorised rates for collocation, against the rates of single states."""

from dataclasses import asdict, replace

import numpy as np
import pytest

from reference_model.contact.contact_law import contact_of
from reference_model.motion.bodies import PinBody, RingBody
from reference_model.motion.disc_equations import DiscMotion
from reference_model.motion.disc_on_points import PointsBody
from reference_model.motion.pin_equations import SlipMotion
from reference_model.motion.stepper import Run, Thresholds
from reference_model.systems import DiscOnDisc, PinOnDisc

SUPPORTS = [{}, {"hardening": 3.0}, {"stop_gap": 0.7, "stop_stiffness": 5.0}, {"stop_stiffness": 5.0}]
PIN = PinOnDisc(mass=1.0, stiffness=1.0, damping=0.3, friction_force=0.4, disc_speed=-1.3, offset=0.2)
DISC = DiscOnDisc(**asdict(PIN), polar_inertia=0.6, contact_radius=0.9, shaft_damping=0.1, shaft_speed=-2.0)


def descriptions(system):
    run = Run(np.linspace(0.0, 1.0, 3), system.state_size, float, Thresholds(), 1e-9, 1.0)
    if isinstance(system, PinOnDisc):
        return [PinBody(run, SlipMotion.of(system)).coordinates]
    law = contact_of(system)
    motion = replace(DiscMotion.of(system, law), length=1.7)
    if system.contact_points is None:
        return [RingBody(run, motion, law).coordinates]
    body = PointsBody(run, motion, law)
    return [body.coordinates, body.slipping[1], body.pivoting[1]]


@pytest.mark.parametrize("support", SUPPORTS, ids=str)
@pytest.mark.parametrize("points", ["pin", None, 4, 12])
def test_vectorised_rates_equal_the_rates_of_single_states(points, support):
    system = replace(PIN, **support) if points == "pin" else replace(DISC, **support, contact_points=points)
    sizes = {("pin", 2): 4, (None, 3): 6, (4, 3): 6, (12, 3): 6, (4, 2): 6, (12, 2): 6, (4, 1): 4, (12, 1): 4}
    rng = np.random.default_rng(7)
    for motion in descriptions(system):
        unknowns = rng.normal(size=(sizes[points, motion.slip], 300))
        unknowns[-motion.slip :] *= 10.0 ** rng.uniform(-100.0, 0.0, 300)  # slip from zero to order one
        each = np.array([motion.rates(row) for row in unknowns.T.tolist()]).T
        assert np.max(abs(motion.rates_at(unknowns) - each)) < 1e-13  # sums of some ten terms of order one
