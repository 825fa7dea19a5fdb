"""Motions of the units by co-simulation: slip and stick against the reference, and what they are built of."""

import ctypes
from dataclasses import asdict, replace

import numpy as np
import pytest

import reference_model
from compare.claims.paper_parameters import FIG5, FIG5_STARTS, FIG11
from fmu_models import DISC, MODELS, PIN
from reference_model.systems import COLUMNS, PARAMETERS, DiscOnDisc, PinOnDisc

SLIPS, STICKS, LEAVES = range(3)
STATES = {kind: [name for name, _ in columns] for kind, columns in COLUMNS.items()}
MODEL = {PinOnDisc: "pin", DiscOnDisc: "disc"}
SIX = replace(FIG11, contact_points=6)
RESTING = DiscOnDisc(
    mass=1.0, polar_inertia=0.02, stiffness=1.0, damping=0.1, friction_force=0.4, disc_speed=1.2, offset=0.1,
    contact_radius=0.12, shaft_damping=0.005, shaft_speed=0.0,
)  # fmt: skip


def started(instance, system, start, **more):
    """Return the unit of a system from where it starts."""
    parameters = {name: value for name, value in asdict(system).items() if value is not None}
    states = dict(zip(STATES[type(system)], start, strict=True))
    return instance(MODEL[type(system)], **parameters, **states, **more).started()


def test_parameters_and_states_are_those_of_the_systems():
    for kind, model in ((PinOnDisc, PIN), (DiscOnDisc, DISC)):
        names = [one.name for one in model.variables]
        assert [one.name for one in model.states] == STATES[kind]
        assert {name for name, _, _ in PARAMETERS[kind]} <= set(names)
        assert len(set(names)) == len(names)


@pytest.mark.parametrize(
    ("system", "start"),
    [
        (FIG5, (0.9, 0.0, 0.0, 0.9)),
        (FIG11, (0.02, 0.0, 0.0, 0.0, 0.0, 1.3)),
        (SIX, (0.02, 0.0, 0.0, 0.0, 0.0, 1.3)),
    ],
    ids=["pin", "ring", "six points"],
)
def test_what_slips_for_long_has_eight_digits(instance, system, start):
    unit = started(instance, system, start)
    unit.to(100.0)
    reference = reference_model.simulate(system, start, [0.0, 100.0], tolerance=1e-13)
    assert [phase.kind for phase in reference.phases] == ["slip"]
    np.testing.assert_allclose(unit.state, reference.states[-1], rtol=0.0, atol=1e-8)


def test_the_pin_of_fig_5_sticks_and_is_let_go_when_the_reference_says(instance):
    start = FIG5_STARTS["whirl"]
    reference = reference_model.simulate(FIG5, start, [0.0, 100.0], tolerance=1e-13)
    unit = started(instance, FIG5, start)
    unit.to(100.0)
    times, modes = unit.changes
    expected = [phase.start for phase in reference.phases[1:]]
    assert len(expected) == 18
    np.testing.assert_allclose(times[modes != SLIPS], expected, rtol=0.0, atol=1e-7)
    np.testing.assert_allclose(unit.state, reference.states[-1], rtol=0.0, atol=1e-8)


def test_a_disc_that_rests_as_a_whole_turns_with_the_one_below(instance):
    start = (0.1, 0.0, 0.0, 0.0, 0.0, 0.0)
    reference = reference_model.simulate(RESTING, start, [0.0, 12.0], tolerance=1e-12)
    unit = started(instance, RESTING, start)
    unit.to(12.0)
    times, modes = unit.changes
    expected = [phase.start for phase in reference.phases[1:]]
    assert expected
    np.testing.assert_allclose(times[modes != SLIPS], expected, rtol=0.0, atol=1e-7)
    np.testing.assert_allclose(unit.state, reference.states[-1], rtol=0.0, atol=1e-7)


def test_errors_of_creep_are_of_first_order_in_epsilon(instance):
    start, errors = FIG5_STARTS["whirl"], []
    reference = reference_model.simulate(FIG5, start, [0.0, 15.0], tolerance=1e-12).states[-1]
    for epsilon in (4e-5, 2e-5, 1e-5):
        unit = started(instance, FIG5, start, exact=0.0, regularisation=epsilon, tolerance=1e-9)
        unit.to(15.0)
        errors.append(np.max(np.abs(unit.state - reference)))
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    assert np.all(np.abs(orders - 1.0) < 0.25), (errors, orders)


def test_errors_of_a_point_that_rests_are_of_first_order_in_its_creep(instance):
    start, errors = (0.0389, 0.0, 0.0, 0.0, 0.0389, 1.38664), []
    reference = reference_model.simulate(SIX, start, [0.0, 40.0], tolerance=1e-12)
    assert [phase.kind for phase in reference.phases] == ["slip", "pivot", "slip", "pivot", "slip"]
    for epsilon in (
        1e-7,
        1e-8,
    ):  # steps that are right for the mean slip alone miss the direction of a slow point
        unit = started(instance, SIX, start, regularisation=epsilon, tolerance=1e-9)
        unit.to(40.0)
        errors.append(np.max(np.abs(unit.state - reference.states[-1])))
    assert abs(np.log10(errors[0] / errors[1]) - 1.0) < 0.1, errors


def test_a_point_comes_to_rest_and_is_let_go_where_it_slips_with_epsilon_exactly(instance):
    unit = started(instance, SIX, (0.0389, 0.0, 0.0, 0.0, 0.0389, 1.38664), regularisation=1e-6)
    for until, resting, count in ((33.0, 0, 0), (33.15, 1, 1), (34.0, 0, 2)):
        unit.to(until)
        assert (unit["resting_points"], unit["rest_count"]) == (resting, count)
        if count:
            x, y, angle, vx, vy, spin = unit.values(*(f"rest_{name}" for name, _ in COLUMNS[DiscOnDisc]))
            arms = SIX.contact_radius * np.exp(1j * (angle + np.pi / 3.0 * np.arange(6)))
            slips = complex(vx, vy) + 1j * spin * arms - 1j * SIX.disc_speed * (complex(x, y) + arms)
            assert abs(np.min(np.abs(slips)) / 1e-6 - 1.0) < 1e-6


def test_a_pin_on_a_plane_stops_in_time_even_at_a_coarse_tolerance(instance):
    unit = instance(
        "pin", vx=0.3, x=0.0, vy=0.0, disc_speed=0.0, stiffness=0.0, damping=0.0, offset=0.0, friction_force=0.1,
        tolerance=1e-6,
    ).started()  # fmt: skip
    unit.to(4.0)
    assert abs(unit["stick_time"] - 3.0) < 1e-8
    assert abs(unit["x"] - 0.45) < 1e-12


def test_a_step_can_be_taken_back(instance):
    unit = started(instance, FIG5, FIG5_STARTS["whirl"])
    unit.to(4.0)
    kept, found = ctypes.c_void_p(unit.kept()), []
    for _ in range(2):
        unit.to(7.0)
        found.append(unit.state)
        unit.roll_back(kept)
    np.testing.assert_array_equal(*found)


def test_communication_steps_change_nothing_that_counts(instance):
    whole, often = (started(instance, FIG5, FIG5_STARTS["whirl"]) for _ in range(2))
    whole.to(8.0)
    for time in np.linspace(0.0, 8.0, 161)[1:]:
        often.to(time)
    np.testing.assert_allclose(often.state, whole.state, rtol=0.0, atol=1e-9)


def test_parameters_are_fixed_after_initialisation(instance):
    unit = started(instance, FIG5, FIG5_STARTS["whirl"])
    assert unit.set(mass=2.0) == [1]
    assert unit.sentence == "mass cannot be set after initialisation"


@pytest.mark.parametrize("until", [np.nan, np.inf, -1.0])
def test_a_step_that_leads_nowhere_is_refused(instance, until):
    unit = started(instance, FIG5, FIG5_STARTS["whirl"])
    assert unit.advance(ctypes.c_double(until)) == 1
    assert unit.sentence == f"step from t = 0 s to {until:g} s: it must be finite and must not go back"


def inside(unit, mode):
    """Bring the pin of Fig. 5 into a mode that it has soon after 5.3 s."""
    for time in 5.3 + 1e-4 * np.arange(60):
        unit.to(time)
        if unit.mode() == mode:
            return unit
    raise AssertionError(f"it is never in mode {mode}")


@pytest.mark.parametrize(
    "case",
    [
        "pin slips",
        "pin sticks",
        "pin leaves",
        "disc slips",
        "points slip",
        "points creep",
        "clutch slips",
        "clutch creeps",
        "clutch points",
    ],
)
def test_directional_derivatives_are_derivatives(instance, case):
    name, how = case.split()
    if name == "pin":
        unit = started(
            instance, replace(FIG5, hardening=3.0 if how == "slips" else 0.0), FIG5_STARTS["whirl"]
        )
        if how != "slips":
            inside(unit, {"sticks": STICKS, "leaves": LEAVES}[how])
    elif name == "points":
        name, slow = "disc", {"vx": 0.0302, "vy": 0.075, "spin": 1.51}
        moves = {"vx": 0.03, "spin": 1.6} if how == "slip" else slow
        # of the slow one two points slip, and three are below regularisation
        unit = instance(
            "disc", x=0.05, y=-0.02, angle=0.3, contact_points=5.0, regularisation=1.2e-3, **moves
        ).started()  # fmt: skip
    elif name == "disc":
        unit = instance("disc", x=0.05, y=-0.02, spin=1.6, stop_gap=0.01, stop_stiffness=5.0).started()
    else:
        speed = {"slips": 30.0, "creeps": 20.01, "points": 21.5}[how]
        shape = {"contact_points": 5.0, "angle_b": 0.3} if how == "points" else {"inner_radius": 0.07}
        unit = instance(
            "clutch", speed_a=20.0, speed_b=speed, x=1e-3, y=-2e-3, vx=0.05, vy=0.03, stiffness=100.0,
            engagement=0.9, regularisation=0.1, static_ratio=1.2, plates=3.0, **shape,
        ).started()  # fmt: skip
    model = MODELS[name]
    knowns = [one.name for one in model.having("state", "input") if one.name != "heat"]
    unknowns = [one.name for one in model.having("derivative", "output") if one.type == "real"]
    at, slip = unit.values(*knowns), unit["slip_speed"]
    for i, known in enumerate(knowns):
        step = 1e-3 * slip if how == "leaves" else 1e-6 * max(abs(at[i]), 1e-2)
        found, sides = unit.along(**{known: 1.0}), []
        for sign in (1.0, -1.0):
            moved = at + sign * step * np.eye(len(at))[i]
            put(unit, model, dict(zip(knowns, moved, strict=True)))
            sides.append(unit.values(*unknowns))
        put(unit, model, dict(zip(knowns, at, strict=True)))
        expected = (sides[0] - sides[1]) / (2.0 * step)
        scale = np.maximum(
            np.maximum(np.abs(sides[0]), 1.0) / step * 2e-15, 1e-5 * np.maximum(np.abs(expected), 1e-2)
        )
        difference = np.abs([found[one] for one in unknowns] - expected)
        assert np.all(difference <= scale), (known, expected, difference)


def put(unit, model, values):
    states = {one.name for one in model.states}
    unit.set(**{name: value for name, value in values.items() if name not in states})
    unit.state = [values.get(one.name, 0.0) for one in model.states]
