"""The study of the clutch's scale: its systems are the paper's in other units."""

import pytest
from tested_studies import CLUTCH_SCALE

from compare.claims.parameters import FIG5, FIG8
from compare.studies.engines.clutch_scale import CLUTCH


def test_the_ensemble_has_starts_for_both_ends():
    (shares,) = CLUTCH_SCALE.found("theory").claims
    assert 0.0 < shares.measured[0] < 1.0


def test_scaling_keeps_the_dimensionless_numbers():
    pin = CLUTCH.system(FIG5)
    assert pin.offset == pytest.approx(1e-4)
    assert pin.disc_speed == pytest.approx(300.0)
    assert pin.disc_speed / pin.natural_frequency == pytest.approx(1.5)
    assert pin.friction_force / (pin.stiffness * pin.offset) == pytest.approx(0.9)
    disc = CLUTCH.system(FIG8)
    for one in (
        lambda d: d.polar_inertia / (d.mass * d.contact_radius**2),
        lambda d: d.shaft_damping / (d.polar_inertia * d.disc_speed),
        lambda d: d.shaft_speed / d.disc_speed,
        lambda d: d.contact_radius / d.offset,
        lambda d: d.damping / (d.mass * d.disc_speed),
    ):
        assert one(disc) == pytest.approx(one(FIG8))
