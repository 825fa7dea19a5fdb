"""Whirls of a pin without offset under a load that falls with the distance from the axis, in closed form.

On a circle the pin moves with k = √(C/m) as in eq. 11, and friction gives what its damper takes: μN(ρ) = βkρ.
"""

import numpy as np
import pytest

from exudyn_models import add_ring_friction, build_pin_on_disc
from exudyn_models.solver.solver_run import solve
from reference_model.systems import PinOnDisc

PIN = PinOnDisc(mass=1.3, stiffness=2.0, damping=0.2, friction_force=0.09, disc_speed=2.5, offset=0.0)
ALONG = PIN.damping * PIN.natural_frequency  # βk in N/m
LENGTH = 0.5
FRICTION = PIN.friction_force

WHIRLS = {
    # μN₀(1 − ρ/a) = βkρ
    "linear": (lambda radius: FRICTION * (1.0 - radius / LENGTH), FRICTION / (ALONG + FRICTION / LENGTH)),
    # μN₀/(1 + ρ²/a²) = βkρ for ρ = a/2
    "rational": (
        lambda radius: ALONG * LENGTH / 2.0 * 1.25 / (1.0 + (radius / LENGTH) ** 2),
        LENGTH / 2.0,
    ),
}


@pytest.mark.parametrize("law", WHIRLS)
def test_a_pin_settles_on_the_whirl_at_which_its_load_feeds_what_damping_takes(law):
    load, radius = WHIRLS[law]

    def friction(mbs, master, disc, **contact):
        return add_ring_friction(mbs, master, disc, **contact | {"normal_load": load})

    start = np.array([0.15, 0.02, 0.0, 0.1])
    model = build_pin_on_disc(PIN, start, regularisation=1e-6, friction=friction)
    # The slowest eigenvalue of both whirls is −0.107/s, so that exp(−26) = 6e-12 is left of the start after 240 s.
    steps = solve(model, 0.0, 250.0, integrator="DOPRI5", step=0.2, tolerance=1e-12)
    late = steps.times > 240.0
    z, w = (steps.states[late, i] + 1j * steps.states[late, i + 1] for i in (0, 2))
    np.testing.assert_allclose(abs(z), radius, rtol=0.0, atol=1e-10)
    np.testing.assert_allclose(w / z, 1j * PIN.natural_frequency, rtol=0.0, atol=1e-9)
