"""Coefficients as in drivetrains: a table of slip speeds, a peak at rest, different values for drag and coast."""

import exudyn as exu
import numpy as np
import pytest
from free_bodies import drive, new_model, rate_of, rotor, run_explicitly, settings_of

from exudyn_models import add_ring_friction, solve_dynamic
from exudyn_models.forces.friction_laws import CONTINUOUS, NONE_HELD
from exudyn_models.forces.laws.curves import peak_over_sliding
from exudyn_models.forces.load_and_coefficient import LoadAndCoefficient

RING = {"contact_radius": 0.12, "friction_coefficient": 0.25, "normal_load": 2.0, "regularisation": 1e-3}
TABLE = [[0.0, 0.5], [0.05, 0.35], [0.2, 0.3], [1.0, 0.28], [40.0, 0.4]]


def curve(table, slip_speed):
    factors = LoadAndCoefficient((0.12, CONTINUOUS, 1.0, 1e-3, NONE_HELD, 0.12), table, 1.0)
    return factors.friction_force(0.0, 0.0, slip_speed, 0.0)


def test_a_table_is_linear_between_its_rows_and_beyond_the_last_one():
    speeds, values = np.transpose(TABLE)
    slips = np.array([*speeds, 0.01, 0.1, 0.7, 20.0])
    np.testing.assert_allclose([curve(TABLE, v) for v in slips], np.interp(slips, speeds, values), rtol=1e-15)
    assert curve(TABLE, 79.0) == pytest.approx(0.4 + 0.12, rel=1e-15)
    assert curve([[0.0, 0.5], [1.0, 0.3]], 2.0) == pytest.approx(0.1, rel=1e-15)
    assert curve([[0.0, 0.5], [1.0, 0.3]], 3.0) == 0.0
    assert curve([[0.0, 0.5]], 3.0) == 0.5


def test_rotors_on_one_axis_slow_down_by_the_table():
    mbs = new_model()
    master, disc = rotor(mbs, 0.7, 5.0), rotor(mbs, 0.02, 0.0)
    add_ring_friction(mbs, master, disc, **RING | {"friction_coefficient": [[0.0, 0.2], [1.0, 0.4]]})
    mbs.Assemble()
    run_explicitly(mbs, 0.05, 200)
    # Two rows are a line: with r·|S| = s, ds/dt = −k·(0.2 + 0.2·s), k = r²·N·(1/J₁ + 1/J₂).
    k = 0.12**2 * 2.0 * (1.0 / 0.7 + 1.0 / 0.02)
    slip = (0.12 * 5.0 + 1.0) * np.exp(-0.2 * k * 0.05) - 1.0
    assert rate_of(mbs, master) - rate_of(mbs, disc) == pytest.approx(slip / 0.12, rel=1e-12)


@pytest.mark.parametrize("spin", [3.0, -3.0])
def test_drag_and_coast_differ_by_the_sign_of_the_relative_spin(spin):
    mbs = new_model()
    disc = rotor(mbs, 0.02, spin)
    law = {"friction_coefficient": lambda relative_spin: 0.4 if relative_spin > 0.0 else 0.2}
    add_ring_friction(mbs, None, disc, **RING | law)
    mbs.Assemble()
    run_explicitly(mbs, 0.1, 100)
    deceleration = (0.4 if spin > 0.0 else 0.2) * 2.0 * 0.12 / 0.02
    assert abs(rate_of(mbs, disc)) == pytest.approx(3.0 - 0.1 * deceleration, rel=1e-13)


def slip_after_release(epsilon, static_ratio):
    """Return slip in rad/s of two rotors 20 ms after torques ∓320 N m/s·t overcome static friction of 32 N m."""
    mbs = new_model()
    nodes = rotor(mbs, 0.2, 0.0), rotor(mbs, 0.01, 0.0)
    for node, sign in zip(nodes, (-1.0, 1.0), strict=True):
        drive(mbs, node, lambda t, sign=sign: sign * 320.0 * t)
    contact = {"contact_radius": 0.1, "friction_coefficient": 0.4 / static_ratio, "normal_load": 800.0}
    add_ring_friction(mbs, *nodes, **contact, static_ratio=static_ratio, regularisation=epsilon)
    settings = settings_of(0.12, 120)
    settings.timeIntegration.absoluteTolerance, settings.timeIntegration.relativeTolerance = 1e-9, 0.0
    solve_dynamic(mbs, settings, exu.DynamicSolverType.DOPRI5)
    return rate_of(mbs, nodes[1]) - rate_of(mbs, nodes[0])


def test_a_contact_breaks_away_at_its_static_friction_with_an_error_of_first_order():
    ratio = 2.0
    sliding = 0.4 / ratio * 800.0 * 0.1
    exact = (160.0 * (0.12**2 - 0.1**2) - sliding * 0.02) * (1.0 / 0.2 + 1.0 / 0.01)
    errors = np.array([slip_after_release(epsilon, ratio) - exact for epsilon in (1e-2, 5e-3, 2.5e-3)])
    assert np.abs(errors).max() < 2e-3 * exact
    orders = np.log2(errors[:-1] / errors[1:])
    np.testing.assert_allclose(orders, 1.0, atol=0.15, err_msg=str(errors))


def test_the_peak_holds_up_to_the_regularisation_and_is_gone_at_twice_that():
    shares = np.linspace(0.0, 3.0, 301)
    values = np.array([peak_over_sliding(share, 1.5) for share in shares])
    assert (values[shares <= 1.0] == 1.5).all()
    assert (values[shares >= 2.0] == 1.0).all()
    assert (np.diff(values[(shares >= 1.0) & (shares <= 2.0)]) < 0.0).all()
    # The fall is a square root, so a release takes the time ε: it loses a third in the first tenth beyond ε.
    assert peak_over_sliding(1.1, 1.5) == pytest.approx(1.5 - 0.5 * np.sqrt(0.1), abs=0.01)
