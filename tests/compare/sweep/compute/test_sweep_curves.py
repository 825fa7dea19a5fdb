from dataclasses import replace

import numpy as np

from compare.claims.parameters import FIG5, FIG11
from compare.sweep.compute.theory import MEANINGS, NODES, PIN, curves
from compare.sweep.plan import Map
from compare.sweep.quantities import Axis
from reference_model.steady.bifurcation_curves import ParameterPlane, crossings

COMMON = {"duration": 100.0, "tolerance": 1e-9, "seed": 1}


def points_of(plan, meaning):
    return np.concatenate([curve.points for curve in curves(plan) if curve.meaning == meaning])


def test_a_pin_loses_its_equilibrium_at_the_load_of_eq_5():
    x, y = Axis("offset", -0.2, 0.2, 3), Axis("friction_force", 0.01, 0.15, 3)
    pin = replace(FIG5, stiffness=0.8)
    points = points_of(Map(system=pin, starts=((0.0,) * 4,), x=x, y=y, **COMMON), PIN[0].meaning)
    np.testing.assert_allclose(points[:, 1], 0.8 * np.abs(points[:, 0]), atol=1e-12)
    assert np.ptp(np.sign(points[:, 0])) == 2.0  # both signs of the offset


def test_a_pin_whirls_above_its_natural_frequency():
    x, y = Axis("disc_speed", -3.0, 3.0, 3), Axis("stiffness", 0.5, 4.0, 3)
    points = points_of(Map(system=FIG5, starts=((0.0,) * 4,), x=x, y=y, **COMMON), PIN[1].meaning)
    # straight lines between nodes at distance h: |ω''|h²/8 with ω = √(C/m)
    h = 3.5 / (NODES - 1)
    np.testing.assert_allclose(
        np.abs(points[:, 0]), np.sqrt(points[:, 1]), atol=0.25 * 0.5**-1.5 * h**2 / 8.0
    )


def test_curves_of_a_disc_pass_through_the_crossings_that_the_reference_finds():
    x, y = Axis("disc_speed", 1.05, 1.95, 3), Axis("friction_force", 0.005, 0.06, 3)
    plan = Map(system=replace(FIG11, offset=0.1, contact_points=6), starts=((0.0,) * 6,), x=x, y=y, **COMMON)
    plane = ParameterPlane(FIG11, (x.name, y.name), (x.low, y.low), (x.high, y.high))
    for kind in ("Hopf", "onset"):
        found = points_of(plan, MEANINGS[kind])
        for load in crossings(plane, kind, "disc_speed", FIG11.disc_speed):
            distance = np.hypot(
                (found[:, 0] - FIG11.disc_speed) / (x.high - x.low), (found[:, 1] - load) / (y.high - y.low)
            )
            assert np.min(distance) < 0.03  # distance of neighbouring points


def test_a_plane_that_the_reference_does_not_support_has_the_other_curves():
    x, y = Axis("disc_speed", -1.0, 2.0, 3), Axis("contact_radius", 0.01, 0.5, 3)
    plan = Map(system=FIG11, starts=((0.0,) * 6,), x=x, y=y, **COMMON)
    (only,) = {curve.meaning for curve in curves(plan)}
    assert only.startswith("sticking on the axis")
    torque = FIG11.shaft_damping * np.abs(points_of(plan, only)[:, 0] - FIG11.shaft_speed)
    held = FIG11.friction_force * points_of(plan, only)[:, 1]
    np.testing.assert_allclose(torque, held, atol=1e-12)
