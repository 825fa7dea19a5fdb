"""Contacts that hold each other, prescribed motions, and user functions in runs with exact stick."""

import itertools
import math
import threading

import exudyn as exu
import numpy as np
import pytest
from free_bodies import (
    ball,
    changes_of,
    coordinate,
    drive,
    items,
    new_model,
    planar_body,
    rate_of,
    rotor,
    settings_of,
)

from exudyn_models import add_ring_friction, solve_dynamic
from exudyn_models.solver.rows.active_set import unloaded
from exudyn_models.solver.stick.complementarity import Sets, rest_or_slip
from exudyn_models.solver.stick.resting import least_maximum
from reference_model.trajectory import SimulationError

SOLVERS = exu.DynamicSolverType
IMPLICIT = pytest.mark.parametrize("solver", [SOLVERS.TrapezoidalIndex2, SOLVERS.GeneralizedAlpha])


def clutch(mbs, master, disc, moment, ratio=1.0, **more):
    law = {"contact_radius": 1.0, "friction_coefficient": 1.0, "normal_load": moment, "static_ratio": ratio}
    return add_ring_friction(mbs, master, disc, **law | more)


def prescribe(mbs, node, angle, speed):
    """Prescribe the motion of the first coordinate of a node."""
    mbs.AddObject(
        items.CoordinateConstraint(
            markerNumbers=[coordinate(mbs, None), coordinate(mbs, node)],
            offsetUserFunction=lambda mbs, t, item, offset: angle(t),
            offsetUserFunction_t=lambda mbs, t, item, offset: speed(t),
        )
    )


def test_forces_between_limits_are_those_of_the_least_sum_over_all_modes():
    """Slip accelerations oppose forces at their limits, and are zero within; A may be singular."""
    rng = np.random.default_rng(3)
    for size, rank in itertools.product((1, 3, 6), (1, 2, 6)):
        root = rng.normal(size=(size, rank))
        to_rates, limits = root @ root.T, rng.uniform(0.1, 2.0, size)
        rates = root @ rng.normal(size=rank)
        forces, left = unloaded(size).forces(to_rates, rates, np.repeat(limits[:, None], 2, axis=1))
        assert (np.abs(forces) <= limits).all()
        assert np.abs(left[np.abs(forces) < limits * (1.0 - 1e-9)]).max(initial=0.0) < 1e-9
        assert (left * forces < 1e-9).all()


def test_of_two_contacts_the_weaker_one_slips_and_then_has_sliding_friction():
    chain = np.array([[2.0, -1.0], [-1.0, 1.0]])
    sets = Sets([slice(0, 1), slice(1, 2)], [None, None])
    found = rest_or_slip(
        chain, np.array([0.0, 3.0]), np.zeros(2), sets, np.full((2, 2), 2.0), np.full((2, 2), 1.0)
    )
    assert np.sign(found).tolist() == [0.0, 1.0]


@pytest.mark.parametrize("loads", [(0.0, 0.0), (5.0, -3.0), (-2.0, 6.0)])
def test_a_shared_load_has_the_least_largest_share(loads):
    """Two contacts hold three others; a search over their forces finds nothing better."""
    rng = np.random.default_rng(1)
    by_chosen, limits = rng.normal(size=(3, 2)), np.repeat(rng.uniform(1.0, 3.0, (5, 1)), 2, axis=1)
    to_forces, start = np.vstack((-by_chosen.T, np.eye(3))), np.array([*loads, 0.0, 0.0, 0.0])
    to_shares = np.vstack((to_forces, -to_forces)) / np.tile(limits[:, :1], (2, 1))

    def shares(x):
        forces = start + to_forces @ x
        return np.concatenate((forces, -forces)) / np.tile(limits[:, 0], 2), to_shares

    found = least_maximum(shares, np.zeros(3))
    forces, share = start + to_forces @ found, shares(found)[0].max()
    for change in rng.normal(size=(2000, 3)):
        other = forces + 0.1 * np.concatenate((-by_chosen.T @ change, change))
        assert np.max(np.abs(other) / limits[:, 0]) > share - 1e-12


@IMPLICIT
@pytest.mark.parametrize("order", list(itertools.permutations((10.0, 8.0, 4.0))))
def test_brakes_with_static_friction_hold_the_sum_of_their_static_moments(solver, order):
    mbs = new_model()
    wheel = rotor(mbs, 0.5, 0.0)
    drive(mbs, wheel, lambda t: 100.0 * t)
    shares = [clutch(mbs, None, wheel, moment, 1.5).add_sensor("capacity_share") for moment in order]
    changes = changes_of(mbs, 0.5, 1e-3, solver)
    assert [change[2:] for change in changes] == [(0, 1)] * 3
    assert [time for time, *_ in changes] == pytest.approx([0.33] * 3, abs=1e-9)
    for sensor in shares:
        times, share = mbs.GetSensorStoredData(sensor).T
        assert share[times < 0.33] == pytest.approx(100.0 * times[times < 0.33] / 33.0, abs=1e-8)


@IMPLICIT
def test_a_ring_of_contacts_at_rest_reports_no_change(solver):
    mbs = new_model()
    rotors = [rotor(mbs, 1.0, 0.0) for _ in range(3)]
    for one, other in itertools.combinations(rotors, 2):
        clutch(mbs, one, other, 5.0)
    drive(mbs, rotors[0], lambda t: math.sin(20.0 * t))
    assert changes_of(mbs, 0.5, 1e-3, solver) == []


@IMPLICIT
def test_friction_follows_a_prescribed_motion_that_reverses(solver):
    """30 N m times the way of 2·2.5 rad."""
    mbs = new_model()
    wheel = rotor(mbs, 1.0, 10.0)
    prescribe(mbs, wheel, lambda t: 10.0 * t - 10.0 * t * t, lambda t: 10.0 - 20.0 * t)
    heat = clutch(mbs, None, wheel, 30.0).add_sensor("heat")
    assert [change[2:] for change in changes_of(mbs, 1.0, 1e-3, solver)] == [(1, -1)]
    assert mbs.GetSensorValues(heat) == pytest.approx(150.0, abs=1e-6)


@IMPLICIT
@pytest.mark.parametrize("radius", [0.0, 0.05])
def test_a_block_on_a_prescribed_path_feels_friction(solver, radius):
    mbs = new_model()
    block = planar_body(mbs, 2.0, 0.01, [0.0] * 3, [0.0] * 3)
    prescribe(mbs, block, lambda t: 1.5 * t * t, lambda t: 3.0 * t)
    heat = clutch(mbs, None, block, 30.0, contact_radius=radius).add_sensor("heat")
    solve_dynamic(mbs, settings_of(0.5, 500), solver)
    assert mbs.GetSensorValues(heat) == pytest.approx(30.0 * 1.5 * 0.25, rel=1e-4)


@IMPLICIT
@pytest.mark.parametrize("radius", [0.0, 0.1])
@pytest.mark.parametrize("across", [0.0, 0.2])
def test_a_block_on_a_path_that_reverses_passes_through_zero_slip(solver, radius, across):
    """It may move sideways: at the reversal its slip turns over without a rest."""
    mbs, rate = new_model(), 5.3
    block = planar_body(mbs, 1.0, 0.01, [0.0] * 3, [0.2 * rate, across, 0.0])
    prescribe(mbs, block, lambda t: 0.2 * math.sin(rate * t), lambda t: 0.2 * rate * math.cos(rate * t))
    heat = clutch(mbs, None, block, 20.0, contact_radius=radius).add_sensor("heat")
    assert changes_of(mbs, 1.0, 1e-3, solver) == []
    way = 0.2 * (4.0 + math.sin(rate))
    assert mbs.GetSensorValues(heat) == pytest.approx(
        20.0 * way + 0.5 * across**2, abs=0.02 if across else 1e-4
    )


def test_a_disc_that_slides_on_a_prescribed_path_loses_its_spin_slowly():
    """At a slip u much faster than its rim, a ring of radius R has the moment μN·R²·S/(2u)."""
    mbs = new_model()
    disc = planar_body(mbs, 1.0, 0.05, [0.0] * 3, [0.5, 0.0, 0.1])
    prescribe(mbs, disc, lambda t: 0.5 * t, lambda t: 0.5)
    mbs.AddObject(items.CoordinateConstraint(markerNumbers=[coordinate(mbs, None), coordinate(mbs, disc, 1)]))
    clutch(mbs, None, disc, 4.0, contact_radius=0.2)
    assert changes_of(mbs, 0.2, 1e-3) == []
    spin = mbs.GetNodeOutput(disc, exu.OutputVariableType.Coordinates_t)[2]
    assert spin == pytest.approx(0.1 * math.exp(-4.0 * 0.2**2 * 0.2 / (2.0 * 0.5 * 0.05)), rel=1e-3)


@IMPLICIT
def test_a_prescribed_speed_that_jumps_at_a_break_lets_a_locked_clutch_slip(solver):
    def run(**breaks):
        mbs = new_model()
        shaft, wheel = rotor(mbs, 1.0, 0.0), rotor(mbs, 1.0, 0.0)
        prescribe(mbs, shaft, lambda t: 2.0 * max(0.0, t - 0.1), lambda t: 2.0 if t > 0.1 else 0.0)
        clutch(mbs, shaft, wheel, 5.0)
        return changes_of(mbs, 0.6, 1e-2, solver, **breaks)

    assert [time for time, *_ in run(breaks=(0.1,))] == pytest.approx([0.1, 0.1 + 2.0 / 5.0], abs=1e-9)
    with pytest.raises(SimulationError, match="a speed that a constraint prescribes jumps there"):
        run()


@IMPLICIT
def test_a_locked_rotor_follows_a_prescribed_shaft_with_a_constant_moment(solver):
    mbs = new_model()
    shaft, wheel = rotor(mbs, 1.0, 0.0), rotor(mbs, 1.0, 0.0)
    prescribe(mbs, shaft, lambda t: 1.5 * t * t, lambda t: 3.0 * t)
    moment = clutch(mbs, shaft, wheel, 7.0).add_sensor("transmitted_moment")
    assert changes_of(mbs, 0.2, 1e-3, solver) == []
    assert mbs.GetSensorStoredData(moment)[:, 1] == pytest.approx(3.0, abs=1e-6)
    assert rate_of(mbs, wheel) == pytest.approx(0.6, abs=1e-9)


@pytest.mark.parametrize("speed", [0.0, 2.0, 8.0])
@pytest.mark.parametrize("node", ["RotationRotationVector", "RotationEulerParameters"])
def test_a_brake_in_a_joint_that_turns_releases_once_at_its_static_moment(speed, node):
    """The axis of the wheel is tilted by 40° from the axis of the turret, which turns freely."""
    mbs, node = new_model(), getattr(exu.NodeType, node)
    turned = exu.rigidBodyUtilities.RotationMatrixX(math.radians(40.0))
    turret = ball(mbs, node, 5.0, 50.0, np.zeros(3), np.zeros(3), [0.0, 0.0, speed])
    wheel = ball(mbs, node, 1.0, 0.5, np.zeros(3), np.zeros(3), [0.0, 0.0, speed], turned)
    ground = mbs.AddObject(items.ObjectGround())

    def joint(one, other, axes):
        markers = [mbs.AddMarker(items.MarkerBodyRigid(bodyNumber=body)) for body in (one, other)]
        mbs.AddObject(
            items.GenericJoint(markerNumbers=markers, rotationMarker0=axes, constrainedAxes=[1] * 5 + [0])
        )

    joint(ground, turret, np.eye(3))
    joint(turret, wheel, turned)
    for body, axis in ((wheel, np.eye(3)[2]), (turret, -turned[:, 2])):  # a motor between both
        marker = mbs.AddMarker(items.MarkerBodyRigid(bodyNumber=body))
        mbs.AddLoad(
            items.Torque(
                markerNumber=marker,
                bodyFixed=True,
                loadVector=[0.0] * 3,
                loadVectorUserFunction=lambda mbs, t, vector, axis=axis: (10.0 * t * axis).tolist(),
            )
        )
    clutch(mbs, turret, wheel, 2.0, 1.5, master_rotation=turned)
    (change,) = changes_of(mbs, 0.4, 1e-3)
    assert change[0] == pytest.approx(0.3, abs=1e-5)


def test_a_function_before_steps_is_called_forward_in_time():
    mbs = new_model()
    wheel = rotor(mbs, 1.0, 1.0)
    drive(mbs, wheel, lambda t: 20.0 * math.sin(30.0 * t))
    clutch(mbs, None, wheel, 10.0, 1.3)
    times = []
    mbs.SetPreStepUserFunction(lambda mbs, t: times.append(t) or True)
    assert len(changes_of(mbs, 1.0, 1e-2)) > 10
    assert times == pytest.approx(np.arange(1, 101) * 1e-2, abs=1e-12)


def test_runs_in_threads_may_share_their_settings():
    def turned(moment, settings):
        mbs = new_model()
        wheel = rotor(mbs, 1.0, 10.0)
        drive(mbs, wheel, lambda t: moment * math.sin(10.0 * t))
        clutch(mbs, None, wheel, 10.0, 1.3)
        solve_dynamic(mbs, settings, SOLVERS.TrapezoidalIndex2)
        return rate_of(mbs, wheel)

    shared, found = settings_of(1.0, 500), {}
    moments = [15.0, 17.0, 19.0, 21.0]
    threads = [
        threading.Thread(target=lambda moment=moment: found.update({moment: turned(moment, shared)}))
        for moment in moments
    ]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert found == {moment: turned(moment, settings_of(1.0, 500)) for moment in moments}
