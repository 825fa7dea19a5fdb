"""The picture of a limit surface shows loads that the contact just holds."""

import numpy as np
import pytest

from compare.output.figures import new_figure
from compare.output.limit_surface import draw_limit_surface
from reference_model.contact import Points, Ring

FEET = Points([(0.05, 0.0, 0.5), (-0.03, 0.04, 0.2), (-0.02, -0.05, 0.3)])


@pytest.mark.parametrize("contact", [FEET, Ring(0.1)])
def test_no_slip_takes_more_power_from_a_drawn_load_than_friction_dissipates(contact):
    _, (panel,) = new_figure()
    draw_limit_surface(panel, contact, directions=(0.0, 1.0))
    rng = np.random.default_rng(1)
    for curve, direction in zip(panel.get_lines(), (0.0, 1.0), strict=True):
        forces, moments = curve.get_data()
        loads = forces * np.exp(1j * direction)
        most = np.zeros(len(forces))
        slips = list(zip(rng.normal(size=(3000, 2)) @ [0.1, 0.1j], rng.normal(size=3000), strict=True))
        # Turns about a resting point drive the loads on the flat faces.
        slips += [
            (-1j * w * arm, w) for w in (1.0, -1.0) for arm in getattr(contact, "arms", lambda _: [])(0.0)
        ]
        for u, w in slips:
            friction, moment = contact.force_and_moment(u, -w, 0.0)
            dissipated = -(friction.conjugate() * u).real - moment * w
            power = (loads.conj() * u).real + moments * w
            most = np.maximum(most, power / dissipated)
        assert most.max() < 1.0 + 1e-12
        assert most.min() > 0.99  # 3000 slips leave gaps between them
