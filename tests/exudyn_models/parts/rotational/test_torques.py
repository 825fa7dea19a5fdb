"""Torque converters, engines by table, road loads and shift sequences, against SciPy with events."""

import math

import exudyn as exu
import numpy as np
import pytest
from free_bodies import changes_of, items, new_model, rate_of, rotor
from scipy.integrate import solve_ivp

from exudyn_models import (
    add_energy_balance,
    add_ring_friction,
    add_road_load,
    add_torque,
    add_torque_converter,
    add_tyre,
    linearise,
    shift_sequence,
    torque_table,
)

IMPLICIT = [exu.DynamicSolverType.TrapezoidalIndex2, exu.DynamicSolverType.GeneralizedAlpha]
STEP, TIMES, SPEEDS = 1e-3, 1e-5, 1e-4  # s, s, rad/s
CONVERTER = [[0.0, 14.0, 2.1], [0.5, 14.5, 1.55], [0.85, 17.0, 1.0], [0.95, 27.0, 1.0], [1.0, math.inf, 1.0]]
ENGINE = [
    [0.0, 120.0, 0.0],
    [80.0, 120.0, -15.0],
    [200.0, 190.0, -20.0],
    [400.0, 210.0, -30.0],
    [600.0, 150.0, -45.0],
]


def exact(rates, start, times, event=None):
    """Return the end of a motion between two times, or at the first zero of ``event`` after the start."""
    if event is not None:
        event.terminal = True
    options = {"rtol": 1e-12, "atol": 1e-12, "method": "DOP853"}
    found = solve_ivp(rates, times, start, events=event, **options)
    return found.t[-1], found.y[:, -1]


def converter_torques(pump, turbine):
    ratios, factors, gains = np.array(CONVERTER).T
    if turbine > pump:
        back = np.interp(pump / turbine, ratios, factors**-2.0) * turbine**2
        return back, -back
    lost = np.interp(turbine / pump, ratios, factors**-2.0) * pump**2
    return -lost, lost * np.interp(turbine / pump, ratios, gains)


@pytest.mark.parametrize("solver", IMPLICIT)
def test_a_converter_and_its_lock_up_clutch_move_as_in_scipy(solver):
    """The clutch closes from 1 s on, with 300 N m after 0.5 s, and locks."""
    inertias, torque, drag = np.array([0.2, 2.0]), 150.0, 0.2

    def clutch(t):
        return 300.0 * min(1.0, max(0.0, (t - 1.0) / 0.5))

    def rates(t, speeds):
        pump, turbine = converter_torques(*speeds)
        moment = clutch(t)  # until the slip ends
        return np.array([torque + pump - moment, turbine - drag * speeds[1] + moment]) / inertias

    start = exact(rates, [100.0, 10.0], (0.0, 1.0))[1]
    lock, speeds = exact(rates, start, (1.0, 2.0), lambda t, speeds: speeds[0] - speeds[1])
    rest = torque / drag
    end = rest + (speeds[0] - rest) * math.exp(-drag / inertias.sum() * (2.0 - lock))
    mbs = new_model()
    rotors = [rotor(mbs, *pair) for pair in zip(inertias, (100.0, 10.0), strict=True)]
    engine = add_torque(mbs, rotors[0], lambda time, angle, speed: torque)
    load = add_torque(mbs, rotors[1], lambda time, angle, speed: -drag * speed)
    converter = add_torque_converter(mbs, *rotors, table=CONVERTER)
    law = {"contact_radius": 0.1, "friction_coefficient": 0.1}
    lock_up = add_ring_friction(mbs, *rotors, **law, normal_load=lambda time: 100.0 * clutch(time))
    losses = {"load": load.lost_power, "converter": converter.lost_power, "clutch": lock_up.power}
    balance = add_energy_balance(mbs, gains={"engine": engine.power}, losses=losses)
    changes = changes_of(mbs, 2.0, STEP, solver, breaks=[1.0, 1.5])
    (time,) = [time for time, *_, after in changes if after == 0]
    assert time == pytest.approx(lock, abs=TIMES)
    assert [rate_of(mbs, one) for one in rotors] == pytest.approx([end] * 2, abs=SPEEDS)
    assert np.max(np.abs(balance().residual)) < 2e-5 * balance().turnover


def test_a_turbine_that_overruns_drives_the_impeller():
    mbs = new_model()
    rotors = [rotor(mbs, *pair) for pair in ((0.2, 50.0), (2.0, 150.0))]
    converter = add_torque_converter(mbs, *rotors, table=CONVERTER)
    torques = converter.add_sensor("torque")
    changes_of(mbs, 0.5, STEP)
    _, end = exact(lambda t, v: np.array(converter_torques(*v)) / [0.2, 2.0], [50.0, 150.0], (0.0, 0.5))
    assert [rate_of(mbs, one) for one in rotors] == pytest.approx(end, abs=SPEEDS)
    assert sum(mbs.GetSensorValues(torques)) == pytest.approx(0.0, abs=1e-12)


def test_the_linearisation_contains_the_slopes_of_torques():
    mbs = new_model()
    shaft = rotor(mbs, 0.5, 300.0)
    add_torque(mbs, shaft, torque_table(ENGINE))
    assert linearise(mbs).damping == pytest.approx(np.array([[-20.0 / 200.0]]), abs=1e-9)


@pytest.mark.parametrize("solver", IMPLICIT)
def test_an_engine_drives_a_car_whose_tyre_slips_and_the_car_stays_on_a_slope(solver):
    """The engine drives for 1 s, the tyre slips and grips again. Without throttle, the car rolls out and stays."""
    mass, radius, slope, inertia = 300.0, 0.3, 0.02, 1.5
    grip, rolling, drag, weight = 0.4 * 2500.0, 0.04 * 300.0 * 9.81, 0.3, 300.0 * 9.81

    def resistance(v):
        return drag * v * abs(v) + weight * math.sin(slope) + rolling * math.cos(slope)

    def torque(t, speed):
        full, idle = (np.interp(speed, np.array(ENGINE)[:, 0], np.array(ENGINE)[:, k]) for k in (1, 2))
        return 4.0 * (full if t < 1.0 else idle)

    def sliding(t, y):
        return np.array([(torque(t, y[0]) - radius * grip) / inertia, (grip - resistance(y[1])) / mass])

    def rolling_on(t, y):
        joint = (torque(t, y[0]) - radius * resistance(y[1])) / (inertia + mass * radius**2)
        return np.array([joint, radius * joint])

    _, state = exact(sliding, [20.0, 5.0], (0.0, 1.0))
    gripped, state = exact(sliding, state, (1.0, 9.0), lambda t, y: radius * y[0] - y[1])
    stopped, _ = exact(rolling_on, state, (gripped, 40.0), lambda t, y: y[1])
    mbs = new_model()
    wheel = rotor(mbs, inertia, 20.0)
    node = mbs.AddNode(items.Node1D(initialVelocities=[5.0]))
    car = mbs.AddObject(items.ObjectMass1D(nodeNumber=node, mass=mass))
    table = np.array(ENGINE) * [1.0, 4.0, 4.0]
    engine = add_torque(mbs, wheel, torque_table(table, lambda time: 1.0 if time < 1.0 else 0.0))
    tyre = add_tyre(mbs, wheel, car, radius=radius, friction_coefficient=0.4, normal_load=2500.0)
    road = add_road_load(mbs, car, mass=mass, rolling=0.04, drag_area=0.5, slope=slope)
    losses = {"tyre": tyre.power, "road": road.power}
    balance = add_energy_balance(mbs, gains={"engine": engine.power}, losses=losses)
    changes = changes_of(mbs, 1.0 + math.ceil(stopped), STEP, solver, breaks=[1.0])
    found = {item: time for time, item, _, after in changes if after == 0}
    assert found[int(tyre.item)] == pytest.approx(gripped, abs=TIMES)
    assert found[int(road.rolling.item)] == pytest.approx(stopped, abs=TIMES)
    assert np.max(np.abs(balance().residual)) < 2e-5 * balance().turnover


def test_a_torque_that_is_not_finite_is_named():
    mbs = new_model()
    add_torque(mbs, rotor(mbs, 1.0, 2.0), lambda time, angle, speed: math.nan)
    with pytest.raises(exu.ExudynError, match=r"torque\(0, 0, 2\) = nan: it must be finite"):
        changes_of(mbs, 0.1, 1e-2)


def test_a_shift_sequence_hands_over_between_elements():
    shifts = shift_sequence(
        {"brake": 10.0, "clutch": 5.0, "both": 2.0},
        {"1": ["brake", "both"], "2": ["clutch", "both"], "N": []},
        start="1",
        shifts=[(1.0, "2"), (2.0, "N")],
        duration=0.5,
    )
    assert shifts.breaks == [1.0, 1.5, 2.0, 2.5]
    found = {
        name: [load(time) for time in (0.0, 1.25, 1.6, 2.25, 3.0)] for name, load in shifts.loads.items()
    }
    assert found["brake"] == [10.0, 5.0, 0.0, 0.0, 0.0]
    assert found["clutch"] == [0.0, 2.5, 5.0, 2.5, 0.0]
    assert found["both"] == [2.0, 2.0, 2.0, 1.0, 0.0]


def test_wrong_tables_rotors_and_shifts_are_refused():
    mbs = new_model()
    one, other = rotor(mbs, 1.0, 0.0), rotor(mbs, 1.0, 0.0)
    with pytest.raises(ValueError, match=r"table = .*: it must have at least two rows of 2 or 3 numbers"):
        torque_table([[0.0, 1.0]])
    with pytest.raises(ValueError, match="throttle = 2: it must be from 0 to 1"):
        torque_table([[0.0, 1.0], [1.0, 1.0]], 2.0)
    with pytest.raises(ValueError, match="impeller = turbine = None: at least one must be a rotor"):
        add_torque_converter(mbs, None, None, table=[[0.0, 1.0, 1.0], [1.0, 1.0, 1.0]])
    with pytest.raises(ValueError, match="its first column must increase"):
        add_torque_converter(mbs, one, other, table=[[0.0, 1.0, 1.0], [0.0, 1.0, 1.0]])
    with pytest.raises(ValueError, match="speed ratios must be from 0 to 1"):
        add_torque_converter(mbs, one, other, table=[[0.0, 1.0, 1.0], [2.0, 1.0, 1.0]])
    with pytest.raises(ValueError, match="rotor = None: a torque must act on a rotor"):
        add_torque(mbs, None, lambda time, angle, speed: 0.0)
    for more, words in (
        ({"drag_area": -1.0, "air_density": -1.0}, "drag_area = -1 m²"),
        ({"mass": 1e308}, "mass = 1e\\+308 kg: its size must be between"),
        ({"rolling": -0.1}, r"rolling = -0\.1: it must be >= 0"),
        ({"slope": 2.0}, "slope = 2 rad: it must lie between"),
    ):
        with pytest.raises(ValueError, match=words):
            add_road_load(mbs, one, **{"mass": 1.0} | more)
    with pytest.raises(ValueError, match="mbs = True: it must be a MainSystem"):
        add_road_load(True, one, mass=1.0)
    gears = {"1": ["a"], "2": ["b"]}
    for more, words in (
        ({"start": "3"}, "start = '3': it must be one of 1, 2"),
        ({"start": "1", "gears": ["1"]}, r"gears = \['1'\]: it must be a Mapping"),
        ({"start": "1", "gears": {"1": ["c"]}}, r"gears\['1'\] = 'c': it must be one of a, b"),
        ({"start": "1", "full_loads": {"a": -1.0, "b": 1.0}}, r"full_loads\['a'\] = -1 N: it must be >= 0"),
        ({"start": "1", "shifts": [1.0]}, r"shifts = \[1.0\]: it must be a list of"),
        ({"start": "1", "shifts": [(0.0, "2"), (0.1, "1")]}, "each must begin at least 0.5 s after"),
    ):
        usual = {"full_loads": {"a": 1.0, "b": 1.0}, "gears": gears, "shifts": [], "duration": 0.5}
        with pytest.raises(ValueError, match=words):
            shift_sequence(**usual | more)
