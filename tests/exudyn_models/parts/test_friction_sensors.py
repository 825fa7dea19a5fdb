"""Sensors of a clutch: slip in rad/s, the share of its capacity, and its mode."""

import exudyn as exu
import numpy as np
import pytest
from free_bodies import drive, new_model, rotor, settings_of

from exudyn_models import add_ring_friction, solve_dynamic
from exudyn_models.parts.friction_sensors import BAND, _Mode

INERTIA, RADIUS, LOAD, EPSILON = 0.02, 0.12, 100.0, 5e-4
CAPACITY = 0.3 * LOAD * RADIUS
RING = {"contact_radius": RADIUS, "friction_coefficient": 0.3, "normal_load": LOAD, "regularisation": EPSILON}
QUANTITIES = ("relative_spin", "capacity_share", "mode")


def told(torque, end, spin=0.0, step=1e-3, **contact):
    """Return times and sensor values of a brake on a rotor under a torque in N m, a function of time."""
    mbs = new_model()
    disc = rotor(mbs, INERTIA, spin)
    drive(mbs, disc, torque)
    brake = add_ring_friction(mbs, None, disc, **RING | contact)
    sensors = [brake.add_sensor(name) for name in QUANTITIES]
    settings = settings_of(end, round(end / step))
    settings.solution.sensors.writePeriod = 0.0
    options = settings.timeIntegration
    options.absoluteTolerance, options.relativeTolerance = 1e-9, 0.0
    solve_dynamic(mbs, settings, exu.DynamicSolverType.DOPRI5)
    stored = [mbs.GetSensorStoredData(sensor) for sensor in sensors]
    return stored[0][:, 0], *(values[:, 1] for values in stored)


def test_the_mode_follows_break_away_in_either_direction_and_stick():
    period = 2.0

    def torque(t):
        return 1.5 * CAPACITY * np.sin(2.0 * np.pi * t / period)

    times, spin, share, mode = told(torque, 1.1 * period)
    assert set(mode) == {-1.0, 0.0, 1.0}
    assert (np.sign(spin[mode != 0.0]) == mode[mode != 0.0]).all()
    assert (share[mode != 0.0] > 0.99).all()
    assert (spin[mode == 0.0] < 1.01 * EPSILON / RADIUS).all()
    changes = times[1:][np.diff(mode) != 0.0]
    assert mode[0] == 0.0
    # By hand: it breaks away where 1.5·sin(2πt/T) = 1, and half a period later in the other direction.
    first = period / (2.0 * np.pi) * np.arcsin(1.0 / 1.5)
    assert changes[0] == pytest.approx(first, abs=2e-3)
    assert len(changes) == 4
    assert changes[2] == pytest.approx(first + period / 2.0, abs=2e-3)


def test_a_contact_that_holds_nearly_all_it_can_is_locked_once_its_slip_has_ended():
    times, spin, share, mode = told(lambda t: 0.97 * CAPACITY, 0.5, spin=0.5)
    stop = 0.5 * INERTIA / (0.03 * CAPACITY)
    assert (mode[times < 0.99 * stop] == 1.0).all()
    locked = times > 1.01 * stop
    assert (mode[locked] == 0.0).all()
    np.testing.assert_allclose(share[locked], 0.97, atol=1e-3)
    np.testing.assert_allclose(spin[locked], share[locked] * EPSILON / RADIUS, rtol=1e-9)


def test_the_mode_does_not_flicker_where_a_torque_shakes_a_contact_at_its_capacity():
    period = 5e-4

    def torque(t):
        return CAPACITY * (1.0 - 0.001 * np.sin(2.0 * np.pi * t / period))

    # By hand, the torque changes the slip by 2·0.001·CAPACITY/INERTIA·period/(2π) = 2.9e-5 rad/s, 0.7 % of ε/R.
    start, swing = 0.995 * EPSILON / RADIUS, 2.0 * 0.001 * CAPACITY / INERTIA * period / (2.0 * np.pi)
    _, spin, _, mode = told(torque, 6.0 * period, spin=start, step=period / 20.0)
    slips = spin * RADIUS / EPSILON >= 1.0
    assert spin.max() * RADIUS / EPSILON < 1.0 + 1.1 * swing * RADIUS / EPSILON < 1.01
    assert np.count_nonzero(np.diff(slips)) > 5
    assert (mode == 0.0).all()


def test_a_new_run_forgets_the_mode_of_the_last_one():
    within_band, mode = 1.0 - 0.5 * BAND, _Mode()
    assert [mode.at(t, creep, 1.0) for t, creep in ((0.0, 2.0), (1.0, within_band))] == [1.0, 1.0]
    assert mode.at(0.0, within_band, 1.0) == 0.0


def test_a_clutch_without_load_is_open():
    _, spin, share, mode = told(lambda t: 0.0, 0.3, spin=1.0, normal_load=lambda time: max(0.0, time - 0.1))
    opened = mode == 2.0
    assert (share[opened] == 0.0).all()
    np.testing.assert_allclose(spin[opened], 1.0, rtol=1e-15)
    assert opened[:2].all()
    assert opened.sum() < len(mode)
    assert (mode[~opened] == 1.0).all()


def test_a_contact_that_closes_while_it_slips_at_its_capacity_slips():
    """Within the band the mode keeps its value; a contact that was open counts as slipping."""
    closes = 0.0105

    def when_closed(value):
        return lambda time: value if time >= closes else 0.0

    # The torque balances friction, so the slip stays at ε.
    times, _, share, mode = told(
        when_closed(CAPACITY), 0.02, spin=EPSILON / RADIUS, normal_load=when_closed(LOAD)
    )
    closed = times >= closes
    np.testing.assert_allclose(share[closed], 1.0, rtol=1e-6)
    assert set(mode[~closed]) == {2.0}
    assert set(mode[closed]) == {1.0}
