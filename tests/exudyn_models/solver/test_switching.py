"""Contacts that stick exactly: rotors, bodies in space and loops of contacts."""

import itertools
import math

import exudyn as exu
import numpy as np
import pytest
from free_bodies import ball, drive, new_model, rate_of, rotations, rotor, settings_of
from free_bodies import changes_of as run

from exudyn_models import add_energy_balance, add_ring_friction, solve_dynamic
from exudyn_models.solver.items import add_integrals
from reference_model.trajectory import SimulationError

SOLVERS = exu.DynamicSolverType
IMPLICIT = [SOLVERS.TrapezoidalIndex2, SOLVERS.GeneralizedAlpha]
INERTIA, SLIDING, RATIO = 0.5, 24.0, 1.2
BRAKE = {"contact_radius": 0.1, "friction_coefficient": 0.3, "normal_load": 800.0, "static_ratio": RATIO}


def braked(speed, moment):
    """Return a rotor under a moment and a brake, which holds 24 N m while it slides and 28.8 N m at rest."""
    mbs = new_model()
    wheel = rotor(mbs, INERTIA, speed)
    drive(mbs, wheel, moment)
    friction = add_ring_friction(mbs, None, wheel, **BRAKE)
    return mbs, friction


def angle(mbs):
    return mbs.systemData.GetODE2Coordinates()[0]


@pytest.mark.parametrize("solver", IMPLICIT)
@pytest.mark.parametrize(("step", "share"), [(1e-3, 0.5), (1e-2, 0.999)])
def test_a_brake_on_a_slope_stops_at_the_exact_time_and_holds(solver, step, share):
    load = share * RATIO * SLIDING
    for speed in np.linspace(0.3, 5.0, 5):
        mbs, friction = braked(speed, lambda t: -load)
        stops = speed * INERTIA / (SLIDING + load)
        assert run(mbs, 0.3, step, solver) == [(pytest.approx(stops, abs=1e-12), int(friction.item), 1, 0)]
        assert angle(mbs) == pytest.approx(speed * stops / 2.0, abs=1e-9)


@pytest.mark.parametrize("solver", IMPLICIT)
def test_a_growing_load_breaks_the_contact_loose_at_the_static_moment(solver):
    mbs, friction = braked(0.0, lambda t: 20.0 * t)
    release = RATIO * SLIDING / 20.0
    assert run(mbs, 2.0, 1e-2, solver) == [(pytest.approx(release, abs=1e-10), int(friction.item), 0, 1)]
    speed = (10.0 * (4.0 - release**2) - SLIDING * (2.0 - release)) / INERTIA
    assert mbs.systemData.GetODE2Coordinates_t()[0] == pytest.approx(speed, abs=1e-5)


def coupled_clutches(step, solver=SOLVERS.TrapezoidalIndex2):
    """Return the times and modes of Modelica's CoupledClutches, three clutches between four rotors in a row."""
    mbs = new_model()
    rotors = [rotor(mbs, 1.0, speed) for speed in (10.0, 0.0, 0.0, 0.0)]
    drive(mbs, rotors[0], lambda t: 10.0 * math.sin(10.0 * math.pi * t))
    loads = [
        lambda time: 20.0 * max(0.0, math.cos(0.4 * math.pi * time)),
        lambda time: 20.0 if time >= 0.4 else 0.0,
        lambda time: 20.0 if time >= 0.9 else 0.0,
    ]
    law = {"contact_radius": 1.0, "friction_coefficient": 0.5, "static_ratio": 1.1}
    contacts = [
        add_ring_friction(mbs, *pair, normal_load=load, **law)
        for pair, load in zip(itertools.pairwise(rotors), loads, strict=True)
    ]
    places = [int(contact.item) for contact in contacts]
    return [(time, places.index(item), *modes) for time, item, *modes in run(mbs, 1.5, step, solver)]


def test_switching_times_of_coupled_clutches_converge_with_the_second_order():
    exact = coupled_clutches(2e-4)
    assert [change[1:] for change in exact] == [
        (1, 2, -1), (1, -1, 0), (0, -1, 0), (0, 0, -1), (2, 2, -1), (0, -1, 0), (0, 0, -1), (2, -1, 0), (0, -1, 2),
    ]  # fmt: skip
    for solver in IMPLICIT:
        errors = []
        for step in (2e-3, 1e-3):
            changes = coupled_clutches(step, solver)
            assert [change[1:] for change in changes] == [change[1:] for change in exact]
            errors.append(max(abs(one[0] - other[0]) for one, other in zip(changes, exact, strict=True)))
        assert errors[1] <= 1.5e-5
        assert 3.5 <= errors[0] / errors[1] <= 4.5


@pytest.mark.parametrize("load", [5.0, -17.9])
def test_two_brakes_on_one_rotor_hold_together(load):
    """The shares of the load are undetermined, but their sum is known."""
    mbs = new_model()
    wheel = rotor(mbs, INERTIA, 3.0)
    drive(mbs, wheel, lambda t: load + 40.0 * max(0.0, t - 1.0))
    law = {"contact_radius": 1.0, "friction_coefficient": 1.0}
    brakes = [add_ring_friction(mbs, None, wheel, normal_load=held, **law) for held in (10.0, 8.0)]
    moments, modes = ([one.add_sensor(name) for one in brakes] for name in ("transmitted_moment", "mode"))
    stops, breaks_loose = 3.0 * INERTIA / (18.0 - load), 1.0 + (18.0 - load) / 40.0
    changes = run(mbs, 2.0, 1e-3)
    expected = np.repeat([stops, breaks_loose], 2)
    assert [time for time, *_ in changes] == pytest.approx(expected, abs=1e-9)
    times = mbs.GetSensorStoredData(moments[0])[:, 0]
    rest = (times > stops) & (times < 1.0)
    total = sum(mbs.GetSensorStoredData(sensor)[:, 1] for sensor in moments)
    assert total[rest] == pytest.approx(-load, abs=1e-9)
    assert all((mbs.GetSensorStoredData(mode)[rest, 1] == 0.0).all() for mode in modes)


@pytest.mark.filterwarnings("ignore:the energy balance is off")  # the test asserts how far
def test_a_random_train_obeys_coulombs_law_and_the_balance_of_energy():
    """Five rotors and the ground form loops of contacts with static friction, under alternating moments."""
    rng, mbs = np.random.default_rng(0), new_model()
    rotors = [
        rotor(mbs, *pair) for pair in zip(rng.uniform(0.5, 2.0, 5), rng.normal(0.0, 3.0, 5), strict=True)
    ]
    gains = {}
    for i, (node, size, rate) in enumerate(
        zip(rotors, rng.uniform(2.0, 10.0, 5), rng.uniform(2.0, 9.0, 5), strict=True)
    ):

        def moment(t, size=size, rate=rate):
            return size * math.sin(rate * t)

        drive(mbs, node, moment)
        gains[f"moment {i}"] = lambda mbs, t, node=node, moment=moment: moment(t) * rate_of(mbs, node)
    pairs = [(0, 1), (1, 2), (2, 3), (3, 4), (4, 0), (None, 2), (None, 0)]
    capacities = rng.uniform(1.0, 6.0, len(pairs))
    law = {"contact_radius": 1.0, "friction_coefficient": 1.0, "static_ratio": RATIO}
    contacts = []
    for pair, capacity in zip(pairs, capacities, strict=True):
        ends = [None if place is None else rotors[place] for place in pair]
        contacts.append(add_ring_friction(mbs, *ends, normal_load=capacity, **law))
    losses = {f"contact {i}": contact.power for i, contact in enumerate(contacts)}
    balance = add_energy_balance(mbs, gains=gains, losses=losses)
    names = "mode", "transmitted_moment", "relative_spin"
    sensors = [[contact.add_sensor(name) for contact in contacts] for name in names]
    assert len(run(mbs, 2.0, 1e-3)) > 10
    modes, transmitted, spins = (
        np.array([mbs.GetSensorStoredData(sensor)[:, 1] for sensor in of_all]) for of_all in sensors
    )
    locked = modes == 0.0
    assert locked.any()
    assert not locked.all()
    assert np.abs(spins[locked]).max() <= 1e-12
    assert (np.abs(transmitted) <= RATIO * capacities[:, None] * (1.0 + 1e-9)).all()
    sliding = -np.sign(spins) * capacities[:, None]
    moving = ~locked & (np.abs(spins) > 1e-9)
    assert transmitted[moving] == pytest.approx(sliding[moving], rel=1e-12)
    energy = balance()
    turnover = sum(values[-1] for values in energy.losses.values())
    assert np.abs(energy.residual).max() <= 1e-4 * turnover


def two_discs(kind, solver, step):
    """Return the delay of stick of a disc on one with three times its inertia, and both final spins."""
    mbs = new_model()
    ground = mbs.CreateGround()
    bodies = []
    for scale, speed in ((3.0, 0.0), (1.0, 4.0)):
        place, turned = [0.3, -0.2, 0.1 * scale], rotations.RotationMatrixZ(0.7)
        kind_of_node = getattr(exu.NodeType, kind)
        body = ball(mbs, kind_of_node, 2.0 * scale, scale, place, [0.0] * 3, [0.0, 0.0, speed], turned)
        mbs.CreateRevoluteJoint(itemNumbers=[ground, body], position=place, axis=[0, 0, 1])
        bodies.append(body)
    law = {"contact_radius": 0.5, "friction_coefficient": 0.4, "normal_load": 50.0}
    add_ring_friction(mbs, *bodies, **law)
    ((time, _, *modes),) = run(mbs, 0.32, step, solver)
    assert modes == [1, 0]
    spins = [mbs.GetObjectOutputBody(body, exu.OutputVariableType.AngularVelocity)[2] for body in bodies]
    return time - 0.3, spins


@pytest.mark.parametrize("solver", IMPLICIT)
@pytest.mark.parametrize("kind", ["RotationRotationVector", "RotationRxyz", "RotationEulerParameters"])
def test_bodies_in_space_that_joints_hold_on_one_axis_stick_exactly(kind, solver):
    late, spins = two_discs(kind, solver, 1e-3)
    if kind == "RotationEulerParameters":  # their coordinates are curved under a constant deceleration
        assert 3.8 <= two_discs(kind, solver, 2e-3)[0] / late <= 4.2
    else:
        assert late == pytest.approx(0.0, abs=1e-10)
    assert spins == pytest.approx([1.0, 1.0], abs=10.0 * abs(late) + 1e-10)
    assert abs(spins[1] - spins[0]) <= 1e-12


def test_sensors_and_the_solution_file_show_the_kink_and_keep_their_times(tmp_path):
    mbs, friction = braked(2.0, lambda t: -SLIDING)
    names = ("mode", "capacity_share", "transmitted_moment", "power", "heat", "radial_force", "rim_slip")
    sensors = {name: friction.add_sensor(name) for name in names}
    settings = settings_of(0.1, 100)
    settings.solution.sensors.writePeriod = settings.solution.file.writePeriod = 0.02
    settings.solution.file.write, settings.solution.file.name = True, str(tmp_path / "solution")
    solve_dynamic(mbs, settings, SOLVERS.TrapezoidalIndex2)
    times = mbs.GetSensorStoredData(sensors["mode"])[:, 0]
    stops = 2.0 * INERTIA / (2.0 * SLIDING)
    assert times == pytest.approx([0.0, 0.02, stops, 0.04, 0.06, 0.08, 0.1], abs=1e-12)
    values = {name: mbs.GetSensorStoredData(sensor)[:, 1:] for name, sensor in sensors.items()}
    heat = SLIDING * (2.0 * times - 2.0 * SLIDING / INERTIA * times**2 / 2.0)[:2]
    expected = {
        "mode": [1.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0],
        "capacity_share": [1.0, 1.0, *[1.0 / RATIO] * 5],
        "transmitted_moment": [-SLIDING, -SLIDING, *[SLIDING] * 5],
        "power": [SLIDING * 2.0, SLIDING * (2.0 - 0.02 * 2.0 * SLIDING / INERTIA), *[0.0] * 5],
        "heat": [*heat, *[SLIDING * stops] * 5],
        "rim_slip": [0.2, 0.1 * (2.0 - 0.02 * 2.0 * SLIDING / INERTIA), *[0.0] * 5],
    }
    for name, exact in expected.items():
        assert values[name][:, 0] == pytest.approx(np.array(exact), abs=1e-10), name
    assert not values["radial_force"].any()
    assert settings.solution.sensors.writePeriod == 0.02
    written = np.loadtxt(tmp_path / "solution.txt", delimiter=",", comments="#")[:, 0]
    assert (np.diff(written) > 0.0).all()
    assert np.abs(written - stops).min() <= 1e-9


def test_runs_can_go_on_and_loads_can_change_between_them():
    mbs, friction = braked(2.0, lambda t: 10.0)
    mbs.Assemble()

    def run_from(start, goes_on=True):
        return solve_dynamic(mbs, settings_of(start + 1.0, 100, start), SOLVERS.TrapezoidalIndex2, goes_on)

    assert len(run_from(0.0)) == 1
    assert run_from(1.0) == []
    friction.change(normal_load=200.0)
    assert run_from(2.0) == []
    speed = mbs.systemData.GetODE2Coordinates_t()[0]
    assert speed == pytest.approx((10.0 - SLIDING / 4.0) / INERTIA, rel=1e-12)
    run_from(3.0, False)
    with pytest.raises(exu.ExudynError, match=r"needs exudyn_models\.solve_dynamic"):
        mbs.SolveDynamic(settings_of(4.0, 100, 3.0), SOLVERS.TrapezoidalIndex2)
    assert mbs.systemData.GetODE2Coordinates_t(exu.ConfigurationType.Initial)[0] == speed


def test_changes_at_a_break_are_among_the_changes():
    """The brake's load jumps at 0.2 s, at a break, and stops the wheel."""
    mbs = new_model()
    wheel = rotor(mbs, INERTIA, 2.0)
    law = BRAKE | {"normal_load": lambda time: 800.0 if time > 0.2 else 0.0}
    item = int(add_ring_friction(mbs, None, wheel, **law).item)
    assert run(mbs, 0.5, 1e-2, breaks=[0.2]) == [
        (pytest.approx(0.2, abs=1e-9), item, 2, 1),
        (pytest.approx(0.2 + 2.0 * INERTIA / SLIDING, abs=1e-9), item, 1, 0),
    ]


@pytest.mark.parametrize("pulse", [(0.038, 0.042), (0.033, 0.047), (0.035, 0.06)])
def test_a_brake_at_rest_whose_load_vanishes_for_a_while_opens_and_closes_then(pulse):
    """A moment of 5 N m accelerates the wheel; a brake of 10 N m then stops it in the same time."""
    start, end = pulse
    mbs = new_model()
    wheel = rotor(mbs, 1.0, 0.0)
    drive(mbs, wheel, lambda t: 5.0)
    law = {"contact_radius": 1.0, "friction_coefficient": 1.0}
    add_ring_friction(mbs, None, wheel, normal_load=lambda time: 0.0 if start <= time < end else 10.0, **law)
    changes = run(mbs, 0.1, 0.01, SOLVERS.TrapezoidalIndex2)
    assert [change[2:] for change in changes] == [(0, 2), (2, 1), (1, 0)]
    assert [time for time, *_ in changes] == pytest.approx([start, end, 2.0 * end - start], abs=1e-9)


def refused_steps(mbs, longest, recommended=0.0):
    """Let Newton's method fail in long steps before 0.03 s; return ends (s) of accepted and of refused steps."""
    start = exu.ConfigurationType.StartOfStep
    ends, refused = [], []

    def refuse(mbs, t):
        if t < 0.03 and t - mbs.systemData.GetTime(start) > longest:
            refused.append(t)
            return [math.inf, recommended]
        return [0.0, -1.0]

    def note(mbs, t):
        ends.append(t)
        return True

    mbs.SetPostNewtonUserFunction(refuse)
    mbs.SetPostStepUserFunction(note)
    return ends, refused


@pytest.mark.parametrize(("longest", "recommended"), [(2e-4, 2e-4), (1e-4 / 3.0, 3e-5), (6e-4, 5e-4)])
def test_steps_that_fail_are_shorter_for_a_while_and_a_change_between_them_is_exact(longest, recommended):
    mbs, friction = braked(1.0, lambda t: 0.0)
    ends, refused = refused_steps(mbs, longest, recommended)
    stops = 1.0 * INERTIA / SLIDING
    assert run(mbs, 0.05, 1e-3) == [(pytest.approx(stops, abs=1e-12), int(friction.item), 1, 0)]
    sizes = np.diff(ends)
    assert (sizes > 0.0).all()
    assert sizes[np.array(ends[1:]) < 0.03].max() <= longest + 1e-12
    assert len(refused) <= 0.15 * len(ends)
    assert sizes[-3:] == pytest.approx(np.full(3, 1e-3), abs=1e-12)
    assert ends[-1] == 0.05


def test_a_step_that_may_not_be_shorter_ends_the_run():
    mbs, _ = braked(1.0, lambda t: 0.0)
    refused_steps(mbs, 2e-4, 2e-4)
    settings = settings_of(0.05, 50)
    settings.timeIntegration.adaptiveStep = False
    with pytest.raises(SimulationError, match="TrapezoidalIndex2 failed 0 s after the start"):
        solve_dynamic(mbs, settings, SOLVERS.TrapezoidalIndex2)


def test_a_change_of_mode_takes_few_steps():
    """One step passes it, two find it and one returns to the grid; the solver starts once."""
    mbs, _ = braked(0.0, lambda t: 40.0 * math.sin(20.0 * t))
    changes = run(mbs, 2.0, 1e-2)
    assert len(changes) > 20
    assert 200 < mbs.sys["dynamicSolver"].it.currentStepIndex <= 200 + 5 * len(changes)


def test_first_order_coordinates_start_again_from_the_start_of_a_step_that_is_taken_back():
    """Both integrators use the trapezoidal rule, so the integral of the speed is the angle."""
    mbs, _ = braked(0.0, lambda t: 40.0 * math.sin(20.0 * t))
    node = add_integrals(
        mbs, lambda mbs, t, item, q: mbs.systemData.GetODE2Coordinates_t().tolist()[:1], [0.0]
    )
    assert len(run(mbs, 2.0, 1e-2)) > 20
    assert mbs.GetNodeOutput(node, exu.OutputVariableType.Coordinates) == pytest.approx(angle(mbs), abs=1e-12)


@pytest.mark.parametrize("end", [1e-9, 1e-12])
def test_runs_shorter_than_the_time_that_exudyn_resolves_end_at_their_end(end):
    mbs, _ = braked(2.0, lambda t: 0.0)
    ends, _ = refused_steps(mbs, math.inf)
    run(mbs, end, end / 10.0)
    assert ends == pytest.approx(np.linspace(0.0, end, 11), rel=1e-9)
    assert mbs.systemData.GetTime() == end


def test_a_contact_opens_at_any_time_where_its_load_jumps_to_zero():
    """Rounding errors of the time of a step must not leave it before the jump."""
    for jumps in [0.01, *np.random.default_rng(0).uniform(0.0, 0.02, 20)]:
        mbs = new_model()
        law = BRAKE | {"normal_load": lambda time, jumps=jumps: 0.0 if time > jumps else 800.0}
        add_ring_friction(mbs, None, rotor(mbs, INERTIA, 2.0), **law)
        assert [change[2:] for change in run(mbs, 0.03, 1e-3)] == [(1, 2)]
