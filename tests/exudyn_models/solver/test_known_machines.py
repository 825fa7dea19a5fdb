"""Exact stick in machines with known motions: a dry pendulum, a self-energising brake, and Modelica's examples."""

import math

import exudyn as exu
import numpy as np
import pytest
from free_bodies import (
    changes_of,
    coordinate,
    drive,
    items,
    new_model,
    node_sensor,
    planar_body,
    rate_of,
    rotor,
    settings_of,
)
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from exudyn_models import add_ring_friction, solve_dynamic
from reference_model.trajectory import SimulationError

TRAPEZOIDAL = exu.DynamicSolverType.TrapezoidalIndex2
IMPLICIT = [TRAPEZOIDAL, exu.DynamicSolverType.GeneralizedAlpha]

MASS, INERTIA, LENGTH, GRAVITY = 2.0, 0.1, 0.4, 9.81  # length: pivot to centre of mass
PIVOT, COEFFICIENT = 0.02, 0.3
SWING = 0.5  # initial speed in rad/s


def sensed(mbs, item, kind=exu.OutputVariableType.Force):
    """Return a function for the magnitude (N or N m) of the force of a connector."""
    sensor = mbs.AddSensor(items.SensorObject(objectNumber=item, outputVariableType=kind, writeToFile=False))
    return lambda: float(np.linalg.norm(mbs.GetSensorValues(sensor)))


def one_way_clutch(mbs, speed):
    """Return a driving and a driven rotor of 1 and 0.5 kg m² at one speed (rad/s), and the clutch between them."""
    driver, driven = rotor(mbs, 1.0, speed), rotor(mbs, 0.5, speed)
    law = {
        "friction_coefficient": lambda relative_spin: 0.3 if relative_spin < 0.0 else 0.0,
        "normal_load": 1e4,
    }
    return driver, driven, add_ring_friction(mbs, driver, driven, contact_radius=0.1, **law)


def pendulum(reaction):
    """Return a pendulum in its lowest position; the load of its dry pivot is the ``reaction`` or m·g."""
    mbs = new_model()
    down = [0.0, -LENGTH, -math.pi / 2.0]
    node = mbs.AddNode(
        items.NodeRigidBody2D(referenceCoordinates=down, initialVelocities=[LENGTH * SWING, 0.0, SWING])
    )
    rod = mbs.AddObject(items.ObjectRigidBody2D(nodeNumber=node, mass=MASS, inertia=INERTIA))
    centre = mbs.AddMarker(items.MarkerBodyRigid(bodyNumber=rod))
    mbs.AddLoad(items.Force(markerNumber=centre, loadVector=[0.0, -MASS * GRAVITY, 0.0]))
    pins = [
        mbs.AddMarker(items.MarkerBodyRigid(bodyNumber=body, localPosition=[place, 0.0, 0.0]))
        for body, place in ((mbs.AddObject(items.ObjectGround()), 0.0), (rod, -LENGTH))
    ]
    joint = mbs.AddObject(items.GenericJoint(markerNumbers=pins, constrainedAxes=[1, 1, 0, 0, 0, 0]))
    load = sensed(mbs, joint, exu.OutputVariableType.ForceLocal) if reaction else MASS * GRAVITY
    law = {"contact_radius": PIVOT, "friction_coefficient": COEFFICIENT, "normal_load": load}
    add_ring_friction(mbs, *pins, **law).add_sensor("heat")
    mbs.Assemble()
    return mbs


def exact_pendulum(reaction):
    """Return the times (s) of all reversals, ending with the stop, and the final angle (rad)."""
    inertia, weight = INERTIA + MASS * LENGTH**2, MASS * GRAVITY

    def missing(rate, angle, speed, sign):
        """Return the moment (N m) about the pivot that is missing for an acceleration ``rate`` (rad/s²)."""
        across = MASS * LENGTH * rate + weight * math.sin(angle)
        along = MASS * LENGTH * speed**2 + weight * math.cos(angle)
        load = math.hypot(across, along) if reaction else weight
        return inertia * rate + weight * LENGTH * math.sin(angle) + sign * COEFFICIENT * PIVOT * load

    def rates(t, state, sign):
        return [state[1], brentq(missing, -1e3, 1e3, args=(*state, sign), xtol=1e-14)]

    time, angle, speed, times = 0.0, 0.0, SWING, []
    while not times or weight * LENGTH * abs(math.sin(angle)) > COEFFICIENT * PIVOT * weight:
        sign = math.copysign(1.0, speed) if not times else -math.copysign(1.0, angle)

        def stop(t, state, sign):
            return state[1]

        stop.terminal, stop.direction = True, -sign
        swing = solve_ivp(
            rates, (time, time + 2.0), [angle, speed], args=(sign,), events=stop, rtol=1e-11, atol=1e-13
        )
        time, angle, speed = swing.t[-1], swing.y[0, -1], 0.0
        times.append(time)
    return times, angle


@pytest.mark.parametrize("reaction", [False, True], ids=["weight", "joint reaction that depends on friction"])
def test_a_dry_pendulum_comes_to_rest_at_the_exact_angle_and_keeps_it(reaction):
    times, angle = exact_pendulum(reaction)
    assert len(times) == 4
    errors = []
    for step in (4e-3, 2e-3):
        mbs = pendulum(reaction)
        changes = solve_dynamic(mbs, settings_of(3.0, round(3.0 / step)), TRAPEZOIDAL, True)
        errors.append(max(abs(change.time - time) for change, time in zip(changes, times, strict=True)))
    assert errors[1] < 4e-5
    assert 3.0 < errors[0] / errors[1] < 5.0
    rests_at = mbs.systemData.GetODE2Coordinates()[2]
    assert rests_at == pytest.approx(angle, abs=1e-6)
    rise = LENGTH * (1.0 - math.cos(rests_at))
    lost = (INERTIA + MASS * LENGTH**2) * SWING**2 / 2.0 - MASS * GRAVITY * rise
    heat = mbs.GetSensorValues(mbs.systemData.NumberOfSensors() - 1)
    assert heat == pytest.approx(lost, abs=1e-5)  # of second order
    assert solve_dynamic(mbs, settings_of(3603.0, 360, start=3.0), TRAPEZOIDAL) == []
    assert abs(mbs.systemData.GetODE2Coordinates()[2] - rests_at) < 1e-12


def self_energising_brake(gain):
    """Return a wheel of 20 rad/s and its node; the load of its brake grows with the moment between it and a flywheel.

    N = N₀ + c·|M| with M = J·μrN/(2J), so ``gain`` is c·μr/2.
    """
    mbs = new_model()
    wheel, flywheel = rotor(mbs, 0.5, 20.0), rotor(mbs, 0.5, 20.0)
    ends = [coordinate(mbs, node) for node in (wheel, flywheel)]
    moment = sensed(mbs, mbs.AddObject(items.CoordinateConstraint(markerNumbers=ends)))
    grows = 2.0 * gain / (0.1 * 0.5)
    law = {"friction_coefficient": 0.5, "normal_load": lambda: 40.0 + grows * moment()}
    add_ring_friction(mbs, None, wheel, contact_radius=0.1, **law)
    mbs.Assemble()
    return mbs, wheel


@pytest.mark.parametrize("solver", IMPLICIT)
@pytest.mark.parametrize("gain", [0.0, 0.8])
def test_a_self_energising_brake_has_the_load_of_the_closed_form(gain, solver):
    mbs, wheel = self_energising_brake(gain)
    solve_dynamic(mbs, settings_of(0.5, 50), solver)
    assert rate_of(mbs, wheel) == pytest.approx(20.0 - 0.1 * 0.5 * 40.0 / (1.0 - gain) * 0.5, abs=1e-7)


def test_a_self_locking_brake_is_an_error():
    mbs, _ = self_energising_brake(1.5)
    with pytest.raises(SimulationError, match=r"found no modes .* Coulomb's law at t = 0 s"):
        solve_dynamic(mbs, settings_of(0.5, 50), TRAPEZOIDAL)


TO_CARRIER = np.array([1.0, 1.5]) / 2.5  # speed of the carrier from the speeds of sun and ring
GEAR_MASSES = np.diag([1.0, 0.0]) + 10.0 * np.outer(TO_CARRIER, TO_CARRIER)


def road_load(speed):
    """Return the moment of the load in N m."""
    return -20.0 * (speed / 10.471975511966) ** 2 * np.sign(speed)


def clutch_share(time):
    """Return the load of the clutch as a share of its largest value; the brake gets the rest."""
    return min(max((time - 2.0) / 0.1, 0.0), 1.0)


def exact_gear_shift():
    """Return the times (s) when the brake slips and the clutch sticks, and the engine's speed (rad/s) at 5 s."""
    options = {"rtol": 1e-12, "atol": 1e-13, "method": "DOP853"}

    def braked(t, speed):
        moment = 20.0 - 100.0 * clutch_share(t) + TO_CARRIER[0] * road_load(TO_CARRIER[0] * speed[0])
        return [moment / GEAR_MASSES[0, 0]]

    def unused(t, speed):
        """Return the static friction of the brake minus the moment of the ring on it, in N m."""
        moment = 100.0 * clutch_share(t) + TO_CARRIER[1] * road_load(TO_CARRIER[0] * speed[0])
        return 100.0 * (1.0 - clutch_share(t)) - abs(moment - GEAR_MASSES[1, 0] * braked(t, speed)[0])

    def sliding(t, speeds):
        clutch, brake = 100.0 * clutch_share(t), 100.0 * (1.0 - clutch_share(t))
        moments = np.array([20.0 - clutch, clutch - brake]) + TO_CARRIER * road_load(TO_CARRIER @ speeds)
        return np.linalg.solve(GEAR_MASSES, moments)

    def slip(t, speeds):
        return speeds[0] - speeds[1]

    unused.terminal = slip.terminal = True
    first = solve_ivp(braked, (0.5, 2.0), [0.0], **options)
    shift = solve_ivp(braked, (2.0, 2.1), first.y[:, -1], events=unused, **options)
    both = solve_ivp(sliding, (shift.t[-1], 2.1), [shift.y[0, -1], 0.0], **options)
    clutch = solve_ivp(sliding, (2.1, 3.0), both.y[:, -1], events=slip, **options)
    together = solve_ivp(
        lambda t, speed: (20.0 + road_load(speed)) / 11.0, (clutch.t[-1], 5.0), clutch.y[:1, -1], **options
    )
    return shift.t[-1], clutch.t[-1], together.y[0, -1]


@pytest.mark.parametrize("solver", IMPLICIT)
def test_a_gear_shift_of_modelica_is_exact(solver):
    """SimpleGearShift: a clutch between the sun and the massless ring of a planetary gear, and a brake on the
    ring."""
    mbs = new_model()
    sun, ring = (mbs.AddNode(items.Node1D()) for _ in range(2))

    def moments(mbs, t, item, angles, speeds):
        return (TO_CARRIER * road_load(TO_CARRIER @ np.array(speeds))).tolist()

    mbs.AddObject(
        items.ObjectGenericODE2(nodeNumbers=[sun, ring], massMatrix=GEAR_MASSES, forceUserFunction=moments)
    )
    drive(mbs, sun, lambda t: 20.0 if t >= 0.5 else 0.0)
    law = {"contact_radius": 2.0, "friction_coefficient": 0.5}
    clutch = add_ring_friction(mbs, ring, sun, normal_load=lambda time: 100.0 * clutch_share(time), **law)
    brake = add_ring_friction(
        mbs, None, ring, normal_load=lambda time: 100.0 * (1.0 - clutch_share(time)), **law
    )
    changes = changes_of(mbs, 5.0, 1e-3, solver, breaks=[0.5, 2.0, 2.1])
    slips, sticks, speed = exact_gear_shift()
    clutch, brake = int(clutch.item), int(brake.item)
    assert changes == [
        (pytest.approx(2.0, abs=1e-9), clutch, 2, 1),
        (pytest.approx(slips, abs=1e-7), brake, 0, 1),
        (pytest.approx(2.1, abs=1e-9), brake, 1, 2),
        (pytest.approx(sticks, abs=1e-7), clutch, 1, 0),
    ]
    assert rate_of(mbs, sun) == pytest.approx(speed, abs=1e-6)
    # Published by the Modelica Association (MAP-LIB_ReferenceResults, BSD 3-clause), from DASSL at 1e-6:
    assert [changes[1][0], changes[3][0]] == pytest.approx([2.0408163581592942, 2.1107903791524119], abs=2e-7)


@pytest.mark.parametrize("sliding_mass", [False, True])
def test_a_brake_of_modelica_is_exact(sliding_mass):
    """Brake: μN = 1 N from 0.1 s on stops 1 kg at 1 m/s, or a rotor of 1 kg m² at 1 rad/s, at 1.1 s after 0.6 m."""
    mbs = new_model()
    spin = 5.0  # which a pin does not resist
    node = planar_body(mbs, 1.0, 1.0, [0.0] * 3, [1.0, 0.0, spin]) if sliding_mass else rotor(mbs, 1.0, 1.0)
    law = {"friction_coefficient": 1.0, "normal_load": lambda time: 1.0 if time >= 0.1 else 0.0}
    add_ring_friction(mbs, None, node, contact_radius=0.0 if sliding_mass else 1.0, **law)
    assert [(time, *modes) for time, _, *modes in changes_of(mbs, 2.0, 1e-3)] == [
        (pytest.approx(0.1, abs=1e-9), 2, 1),
        (pytest.approx(1.1, abs=1e-9), 1, 0),
    ]
    assert mbs.systemData.GetODE2Coordinates()[0] == pytest.approx(0.6, abs=1e-9)
    stopped = [0.0, 0.0, spin] if sliding_mass else [0.0]
    np.testing.assert_allclose(mbs.systemData.GetODE2Coordinates_t(), stopped, rtol=1e-12, atol=1e-12)


@pytest.mark.parametrize("planar", [False, True])
def test_rounding_errors_of_the_load_do_not_close_a_contact(planar):
    mbs = new_model()
    node = planar_body(mbs, 1.0, 1.0, [0.0] * 3, [1.0, 0.0, 0.0]) if planar else rotor(mbs, 1.0, 1.0)
    law = {"contact_radius": 0.1, "friction_coefficient": 0.3}
    loads = [(0.1, 1.0), (0.2, 0.0), (0.3, 1e-14), (0.4, 1e-3)]  # ends in s, N

    def load(time):
        return next(size for end, size in loads if time < end)

    add_ring_friction(mbs, None, node, normal_load=load, **law)
    changes = changes_of(mbs, 0.399, 1e-3)
    assert [(pytest.approx(time, abs=1e-9), *modes) for time, _, *modes in changes] == [
        (0.1, 1, 2),
        (0.3, 2, 1),
    ]


def overrun():
    """Return when (s) a driven rotor starts to overrun its driver, and when the one-way clutch engages again.

    8·sin 5t N m drive a rotor of 1 kg m². The clutch drives another of 0.5 kg m² under a drag of 1 N m.
    """
    start = (math.pi + math.asin(1.0 / 0.5 / 8.0)) / 5.0  # no moment between them: 8·sin 5t/1 = -1/0.5

    def slip(t):
        return -(t - start) / 0.5 - 8.0 / 5.0 * (math.cos(5.0 * start) - math.cos(5.0 * t))

    return start, brentq(slip, start + 0.3, start + 1.2)


@pytest.mark.parametrize("solver", IMPLICIT)
def test_a_one_way_clutch_overruns_and_engages_at_the_exact_times(solver):
    released, engaged = overrun()
    errors = []
    for step in (2e-3, 1e-3):
        mbs = new_model()
        driver, driven, clutch = one_way_clutch(mbs, 4.0)
        drive(mbs, driver, lambda t: 8.0 * math.sin(5.0 * t))
        drive(mbs, driven, -1.0)
        moment, mode = clutch.add_sensor("transmitted_moment"), clutch.add_sensor("mode")
        changes = solve_dynamic(mbs, settings_of(1.6, round(1.6 / step)), solver)
        assert [(int(change.before), int(change.after)) for change in changes] == [(0, 1), (1, 0)]
        errors.append(max(abs(changes[0].time - released), abs(changes[1].time - engaged)))
        moments, modes = (mbs.GetSensorStoredData(sensor)[:, 1] for sensor in (moment, mode))
        assert (moments[modes == 0] > -1e-9).all()
        assert (moments[modes == 1] == 0.0).all()
    assert errors[1] < 1e-5
    assert errors[0] < 1e-9 or errors[0] / errors[1] > 3.0


def test_a_one_way_clutch_without_a_load_rests():
    """Rounding errors of the moment do not release it."""
    mbs = new_model()
    driver, driven, _ = one_way_clutch(mbs, 3.0)
    assert solve_dynamic(mbs, settings_of(10.0, 1000), TRAPEZOIDAL) == []
    assert rate_of(mbs, driver) == rate_of(mbs, driven) == 3.0


@pytest.mark.parametrize("solver", IMPLICIT)
def test_a_gear_with_an_efficiency_has_the_accelerations_of_the_closed_form(solver):
    """Modelica's LossyGear: bearing friction under the moment of the gear, which closes the contact at rest."""
    ratio, efficiency, drives, brakes = 2.0, 0.8, 3.0, -2.0
    mbs = new_model()
    shafts = [rotor(mbs, 1.0, 0.0), rotor(mbs, 0.5, 0.0)]
    drive(mbs, shafts[0], lambda t: drives if t < 1.0 else brakes)
    ends = [coordinate(mbs, shaft) for shaft in shafts]
    moment = sensed(mbs, mbs.AddObject(items.CoordinateConstraint(markerNumbers=ends, factor1=ratio)))

    def loss(time):
        return moment() * (1.0 / efficiency - 1.0 if time < 1.0 else 1.0 - efficiency)

    add_ring_friction(mbs, None, shafts[0], contact_radius=1.0, friction_coefficient=1.0, normal_load=loss)
    speed = node_sensor(mbs, shafts[0], exu.OutputVariableType.Coordinates_t)
    solve_dynamic(mbs, settings_of(2.0, 200), solver, breaks=[1.0])
    times, speeds = mbs.GetSensorStoredData(speed).T
    far = 0.5 / ratio**2  # inertia of the second shaft at the first
    forward, backward = drives / (1.0 + far / efficiency), brakes / (1.0 + far * efficiency)
    expected = forward * np.minimum(times, 1.0) + backward * np.maximum(times - 1.0, 0.0)
    np.testing.assert_allclose(speeds, expected, atol=1e-7)
